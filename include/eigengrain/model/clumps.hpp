#pragma once

#include "eigengrain/base/vec.hpp"

#include <cstdint>
#include <span>
#include <vector>

namespace eigengrain::model {

/// Several balls as one rigid body. The balls are rows of the bodies like any other, and contacts are theirs;
/// a clump says how they move together. Empty where a scene has none.
///
/// A clump's mass and fixed components stand in the rows of its balls too, for those who ask a ball: the mass
/// for dashpots, the least principal inertia, and per step the exact displacement and rotation over dt as
/// velocity and spin.
struct Clumps {
  static constexpr std::int32_t none = -1;

  std::vector<std::int64_t> identity;   ///< the place in the scene, from 0
  std::vector<double> mass;             ///< kg
  std::vector<double> volume;           ///< of the union of the balls, m³
  std::vector<double> radius;           ///< of the sphere about the centre that holds all balls, m
  std::vector<Vec3> inertia;            ///< principal moments about the centre, kg m²
  std::vector<Vec3> position;           ///< centre of mass, m
  std::vector<Quat> orientation;        ///< from the principal axes to space, unit
  std::vector<Vec3> velocity;           ///< of the centre, m/s
  std::vector<Vec3> angular_momentum;   ///< about the centre, along the axes of space, kg m²/s
  std::vector<Vec3> spin;               ///< rotation of the last step over dt; at the start as given, rad/s
  std::vector<std::int32_t> starts{0};  ///< [clumps + 1] where the balls of a clump begin in `member`
  std::vector<std::int32_t> member;     ///< rows of the bodies, in the order of the scene
  std::vector<Vec3> place;  ///< [member] centre of the ball from that of the clump, principal axes, m
  std::vector<std::int32_t> of_row;  ///< [bodies, or fewer: none beyond] the clump of a ball, or none

  bool empty() const { return position.empty(); }
  std::int32_t size() const { return static_cast<std::int32_t>(position.size()); }

  /// The clump of a row of the bodies, or none.
  std::int32_t of(std::int32_t row) const {
    return row < static_cast<std::int32_t>(of_row.size()) ? of_row[static_cast<std::size_t>(row)] : none;
  }
  std::span<const std::int32_t> members(std::int32_t clump) const {
    const auto c = static_cast<std::size_t>(clump);
    return std::span(member).subspan(static_cast<std::size_t>(starts[c]),
                                     static_cast<std::size_t>(starts[c + 1] - starts[c]));
  }
  /// The row in whose name a clump has its unknowns, forces and equations: that of its first ball.
  std::int32_t holder(std::int32_t clump) const { return member[static_cast<std::size_t>(starts[clump])]; }
  /// The row that has the unknowns of a row: its own, or the holder of its clump.
  std::int32_t owner(std::int32_t row) const {
    const std::int32_t clump = of(row);
    return clump == none ? row : holder(clump);
  }
  /// Whether two rows are balls of one clump.
  bool same(std::int32_t a, std::int32_t b) const { return of(a) != none && of(a) == of(b); }
};

/// (R - 1) v, what a rotation by the unit quaternion q adds to v, to rounding of its own size even where the
/// rotation is small.
inline Vec3 turned_by(const Quat& q, const Vec3& v) {
  const Vec3 twice = 2 * q.vec().cross(v);
  return q.w() * twice + q.vec().cross(twice);
}

}  // namespace eigengrain::model
