#pragma once

#include <cstdint>
#include <span>
#include <vector>

namespace eigengrain {

/// The one connectivity type (compressed rows): row i is linked to links(i).
/// offsets has rows()+1 entries and starts at 0; targets holds the links row after row.
struct Adjacency {
  std::vector<std::int64_t> offsets{0};
  std::vector<std::int32_t> targets;

  std::int32_t rows() const { return static_cast<std::int32_t>(offsets.size()) - 1; }
  std::span<const std::int32_t> links(std::int32_t row) const {
    const auto r = static_cast<std::size_t>(row);
    return std::span(targets).subspan(static_cast<std::size_t>(offsets[r]),
                                      static_cast<std::size_t>(offsets[r + 1] - offsets[r]));
  }
};

/// Counting sort: row r links to every k with row_of[k] == r, in increasing k. A negative row is left out.
/// Cost O(rows + row_of.size()).
Adjacency group_by_row(std::int32_t rows, std::span<const std::int32_t> row_of);

}  // namespace eigengrain
