#pragma once

#include "eigengrain/base/vec.hpp"
#include "eigengrain/model/surroundings.hpp"

#include <array>
#include <cstdint>
#include <span>

namespace eigengrain::generate {

/// Where balls are made: a box. Along a periodic axis its two faces are one, and centres may lie anywhere
/// between them; along the others balls lie wholly inside.
struct Region {
  Vec3 lower = Vec3::Zero();  ///< m
  Vec3 upper = Vec3::Zero();  ///< m
  std::array<bool, 3> periodic{};

  Vec3 edges() const { return upper - lower; }
  double volume() const { return edges().prod(); }
  /// The cell that repeats as the region does.
  model::PeriodicCell cell() const { return model::PeriodicCell::box(lower, edges(), periodic); }
};

/// Σ 4/3 π r³ over the volume of the region; what balls share where they overlap counts for each of them.
double solid_fraction(std::span<const double> radii, const Region& region);

/// Lengths that differ by less than this part of them count as equal: users write ten digits.
constexpr double negligible = 1e-9;

/// Throws InputError where a ball of that radius does not lie between two faces of the region.
void require_room(double radius, const Region& region);

/// Throws InputError where a ball of that radius would overlap its own periodic image.
void require_room_for_image(double radius, const Region& region);

}  // namespace eigengrain::generate
