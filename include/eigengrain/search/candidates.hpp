#pragma once

#include "eigengrain/base/vec.hpp"
#include "eigengrain/model/surroundings.hpp"

#include <cstdint>
#include <span>
#include <vector>

namespace eigengrain::search {

/// Two spheres that may touch: a, and the copy of b in the given periodic image. Every unordered pair
/// (with its image) stands once: a < b, or a == b and the first nonzero component of image positive.
struct CandidatePair {
  std::int32_t a = 0;
  std::int32_t b = 0;
  model::Image image{};

  friend bool operator==(const CandidatePair&, const CandidatePair&) = default;
};

/// All pairs whose surfaces are no more than `reach` apart: |x_b + shift - x_a| <= r_a + r_b + reach. Edges
/// of the cell need not stand at right angles; the cost grows as they slant (reduce() keeps them from it).
///
/// centres  [n] positions, m (need not lie in the cell)
/// radii    [n] m, positive
/// cell     which axes repeat, and with which edges; a cell smaller than the spheres is fine
///
/// Sorted by a, then b, then image. Cost O(n + pairs) for any spread of sizes and any gaps between bodies;
/// independent of the number of threads to the bit.
std::vector<CandidatePair> candidate_pairs(std::span<const Vec3> centres, std::span<const double> radii,
                                           const model::PeriodicCell& cell, double reach = 0.0);

}  // namespace eigengrain::search
