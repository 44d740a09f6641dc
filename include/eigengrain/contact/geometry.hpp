#pragma once

#include "eigengrain/base/vec.hpp"
#include "eigengrain/model/surroundings.hpp"

namespace eigengrain::contact {

/// Where two sides touch (PFC3D eqs. 1.5-1.8).
struct ContactGeometry {
  Vec3 normal;            ///< n, unit, from the first side to the second
  double overlap;         ///< U, m; positive when the surfaces interpenetrate
  Vec3 lever_a;           ///< R_a = x_C - x_a, m
  Vec3 lever_b;           ///< R_b = x_C - x_b, m; from a wall's centre where the second side is one
  double reduced_radius;  ///< R*, 1/R* = Σ 1/R, m; a wall is flat
};

/// Two balls: n = (x_b - x_a)/d, U = r_a + r_b - d, x_C = x_a + (r_a - U/2) n.
/// x_b is the centre of the image that touches. Centres must differ.
inline ContactGeometry ball_ball(const Vec3& x_a, double r_a, const Vec3& x_b, double r_b) {
  const Vec3 branch = x_b - x_a;
  const double distance = branch.norm();
  const Vec3 n = branch / distance;
  const double overlap = r_a + r_b - distance;
  return {n, overlap, (r_a - 0.5 * overlap) * n, -(r_b - 0.5 * overlap) * n, r_a * r_b / (r_a + r_b)};
}

/// A ball and a one-sided plane: n = -(normal of the plane), d the signed distance of the centre from it,
/// U = r - d, x_C = x + (r - U/2) n. A centre behind the plane keeps its contact (d < 0). R_b is taken from
/// the plane's centre, about which it may turn.
inline ContactGeometry ball_plane(const Vec3& x, double r, const model::Plane& plane) {
  const Vec3 n = -plane.normal;
  const double overlap = r - (x - plane.point).dot(plane.normal);
  const Vec3 lever = (r - 0.5 * overlap) * n;
  return {n, overlap, lever, x + lever - plane.centre, r};
}

}  // namespace eigengrain::contact
