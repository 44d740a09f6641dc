#include "eigengrain/base/adjacency.hpp"

#include "eigengrain/base/assert.hpp"

namespace eigengrain {

Adjacency group_by_row(std::int32_t rows, std::span<const std::int32_t> row_of) {
  Adjacency result;
  result.offsets.assign(static_cast<std::size_t>(rows) + 1, 0);
  for (const std::int32_t row : row_of) {
    EIGENGRAIN_ASSERT(row < rows, row, rows);
    if (row >= 0) ++result.offsets[static_cast<std::size_t>(row) + 1];
  }
  for (std::size_t r = 0; r < static_cast<std::size_t>(rows); ++r) result.offsets[r + 1] += result.offsets[r];
  result.targets.resize(static_cast<std::size_t>(result.offsets.back()));
  std::vector<std::int64_t> next(result.offsets.begin(), result.offsets.end() - 1);
  for (std::size_t k = 0; k < row_of.size(); ++k) {
    if (row_of[k] < 0) continue;
    std::int64_t& slot = next[static_cast<std::size_t>(row_of[k])];
    result.targets[slot++] = static_cast<std::int32_t>(k);
  }
  return result;
}

}  // namespace eigengrain
