#pragma once

#include "eigengrain/generate/balls.hpp"
#include "eigengrain/generate/random.hpp"
#include "eigengrain/generate/region.hpp"

#include <span>

namespace eigengrain::generate {

/// Random sequential addition: balls one after the other, the largest first, each at the first random place
/// where it overlaps none before it. Equal balls can fill a fraction of about 0.38 so, in infinite time; 0.3
/// is cheap.
///
/// radii    [n] m, in any order; the balls come back in that order
/// attempts places tried for one ball before giving up
///
/// Cost O(n) at a given fraction and spread of sizes: one grid a size class. Throws InputError where a ball
/// finds no place, with the fraction reached, and where one is too large for the region.
Balls fill_at_random(std::span<const double> radii, const Region& region, Random& random,
                     int attempts = 20'000);

}  // namespace eigengrain::generate
