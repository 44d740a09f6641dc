#pragma once

#include "eigengrain/base/vec.hpp"

#include <array>
#include <cstdint>
#include <string>
#include <vector>

/// What surrounds the bodies: walls and the periodic cell.
namespace eigengrain::model {

/// An infinite one-sided plane; bodies live on the side that the normal points to (the active side).
/// A centre that has crossed the plane is still in contact from the active side.
struct Plane {
  Vec3 point;   ///< any point of the plane, m
  Vec3 normal;  ///< unit vector into the active side
  std::int32_t material = 0;
  std::string name;  ///< for messages, e.g. "wall 2 (-x)"
  /// Where it turns about if it moves, and where moments on it are taken about, m.
  Vec3 centre = Vec3::Zero();
};

/// Which copy of the periodic cell, in cell lengths along x, y, z.
using Image = std::array<std::int8_t, 3>;

/// An orthogonal box that repeats along some of its axes.
struct PeriodicCell {
  Vec3 origin = Vec3::Zero();   ///< lower corner, m
  Vec3 lengths = Vec3::Zero();  ///< m; meaningless along an axis that does not repeat
  std::array<bool, 3> periodic{};

  bool any() const { return periodic[0] || periodic[1] || periodic[2]; }
  /// Translation from the cell to its image, m.
  Vec3 shift(const Image& image) const {
    return {image[0] * lengths[0], image[1] * lengths[1], image[2] * lengths[2]};
  }
  /// The copy of x that lies in the cell, origin <= x < origin + lengths.
  Vec3 wrapped(const Vec3& x) const;
};

}  // namespace eigengrain::model
