#pragma once

#include "cell_grid.hpp"
#include "wrapped_bodies.hpp"

#include <cstdint>
#include <span>
#include <vector>

namespace eigengrain::search {

/// Bodies of similar size (within a factor of two) and the grid that suits them.
struct SizeLevel {
  double largest = 0;  ///< size in this level, m
  CellGrid grid;
};

/// One grid for each size class that occurs, the largest bodies first. A body looks for partners in its own
/// level and in those of larger bodies, never in those of smaller ones: so it meets a bounded number of
/// cells.
///
/// The size of a body is its radius and half the reach: two bodies pair if they are no farther apart than
/// the sum of their sizes.
class SizeLevels {
 public:
  SizeLevels(const WrappedBodies& bodies, std::span<const double> radii, double reach);

  /// The levels to search for partners of a body; the last is its own.
  std::span<const SizeLevel> for_body(std::int32_t body) const {
    return std::span(levels_).first(static_cast<std::size_t>(own_[body]) + 1);
  }

 private:
  std::vector<SizeLevel> levels_;
  std::vector<std::int32_t> own_;  ///< [n] index of each body's level
};

}  // namespace eigengrain::search
