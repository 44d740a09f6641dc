#pragma once

#include "eigengrain/generate/random.hpp"
#include "eigengrain/generate/region.hpp"

namespace eigengrain::generate {

/// A centre, uniform over those where a ball of that radius lies in the region.
inline Vec3 random_place(const Region& region, double radius, Random& random) {
  Vec3 x;
  for (int k = 0; k < 3; ++k) {
    const double margin = region.periodic[k] ? 0 : radius;
    const double width = region.upper[k] - region.lower[k] - 2 * margin;
    x[k] = region.lower[k] + margin + random.uniform() * width;
  }
  return x;
}

}  // namespace eigengrain::generate
