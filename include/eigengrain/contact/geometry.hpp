#pragma once

#include "eigengrain/base/vec.hpp"
#include "eigengrain/model/surroundings.hpp"

namespace eigengrain::contact {

/// The part of the overlap that the lever of a ball is shorter than its radius: to the contact point.
inline constexpr double to_contact_point = 0.5;
/// The lever of other codes (LAMMPS, LIGGGHTS), which ends at the surface of the ball.
inline constexpr double to_surface = 0;

/// Where two sides touch (PFC3D eqs. 1.5-1.8).
struct ContactGeometry {
  Vec3 normal;                    ///< n, unit, from the first side to the second
  double overlap;                 ///< U, m; positive when the surfaces interpenetrate
  Vec3 lever_a;                   ///< R_a = x_C - x_a, m
  Vec3 lever_b;                   ///< R_b = x_C - x_b, m; from a wall's centre where the second side is one
  double reduced_radius;          ///< R*, 1/R* = Σ 1/R, m; a wall is flat
  double cut = to_contact_point;  ///< of the overlap, from the levers

  /// From the centre of the first side to that of the second, m.
  Vec3 branch() const { return lever_a - lever_b - (1 - 2 * cut) * overlap * normal; }
};

/// Two balls: n = (x_b - x_a)/d, U = r_a + r_b - d, x_C = x_a + (r_a - U/2) n.
/// x_b is the centre of the image that touches. Centres must differ.
inline ContactGeometry ball_ball(const Vec3& x_a, double r_a, const Vec3& x_b, double r_b,
                                 double cut = to_contact_point) {
  const Vec3 branch = x_b - x_a;
  const double distance = branch.norm();
  const Vec3 n = branch / distance;
  const double overlap = r_a + r_b - distance;
  return {n, overlap, (r_a - cut * overlap) * n, -(r_b - cut * overlap) * n, r_a * r_b / (r_a + r_b), cut};
}

/// A ball and a one-sided plane: n = -(normal of the plane), d the signed distance of the centre from it,
/// U = r - d, x_C = x + (r - U/2) n. A centre behind the plane keeps its contact (d < 0). R_b is taken from
/// the plane's centre, about which it may turn.
inline ContactGeometry ball_plane(const Vec3& x, double r, const model::Plane& plane,
                                  double cut = to_contact_point) {
  const Vec3 n = -plane.normal;
  const double overlap = r - (x - plane.point).dot(plane.normal);
  const Vec3 lever = (r - cut * overlap) * n;
  return {n, overlap, lever, x + lever - plane.centre, r, cut};
}

}  // namespace eigengrain::contact
