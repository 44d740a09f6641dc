#pragma once

#include "eigengrain/generate/balls.hpp"
#include "eigengrain/generate/random.hpp"
#include "eigengrain/generate/region.hpp"

#include <cstdint>

namespace eigengrain::generate {

/// Balls in a box that repeats along all axes.
struct PeriodicBalls {
  Balls balls;
  Region region;
};

/// A stand-in for a dense packing whose cost is linear in the number of balls, for studies of cost: a
/// face-centred lattice with spacing 2 m whose centres are shifted by up to 0.05 m along each axis, and whose
/// radii are between 0.9 and 1.1 m. Half of the 12 neighbours touch, as in a settled packing, and no two
/// places are alike; it is no equilibrium.
///
/// balls  about how many: a whole number of cells of 4, the box twice as long along z as along x and y where
/// that
///        comes closer. Throws InputError for less than one.
PeriodicBalls jittered_lattice(std::int64_t balls, Random& random);

}  // namespace eigengrain::generate
