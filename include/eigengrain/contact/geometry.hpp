#pragma once

#include "eigengrain/base/vec.hpp"
#include "eigengrain/model/surroundings.hpp"

#include <cmath>

namespace eigengrain::contact {

/// The part of the overlap that the lever of a ball is shorter than its radius: to the contact point.
inline constexpr double to_contact_point = 0.5;
/// To the nearest point of the other side, as a contact with a deformable surface needs it (skin.hpp).
inline constexpr double to_nearest_point = 1;
/// The lever of other codes (LAMMPS, LIGGGHTS), which ends at the surface of the ball.
inline constexpr double to_surface = 0;

/// Where two sides touch (PFC3D eqs. 1.5-1.8).
template <class Real>
struct GeometryOf {
  Vec3Of<Real> normal;            ///< n, unit, from the first side to the second
  Real overlap;                   ///< U, m; positive when the surfaces interpenetrate
  Vec3Of<Real> lever_a;           ///< R_a = x_C - x_a, m
  Vec3Of<Real> lever_b;           ///< R_b = x_C - x_b, m; from a wall's centre where the second side is one
  Real reduced_radius;            ///< R*, 1/R* = Σ 1/R, m; a wall is flat
  double cut = to_contact_point;  ///< of the overlap, from the levers

  /// From the centre of the first side to that of the second, m.
  Vec3Of<Real> branch() const { return lever_a - lever_b - (1 - 2 * cut) * overlap * normal; }
};
using ContactGeometry = GeometryOf<double>;

/// Two balls whose centres are `branch` = x_b - x_a apart: n = branch/d, U = r_a + r_b - d, x_C = x_a + (r_a
/// - U/2) n. x_b is the centre of the image that touches. Centres must differ.
template <class Real>
GeometryOf<Real> balls_apart(const Vec3Of<Real>& branch, const Real& r_a, const Real& r_b, double cut) {
  using std::sqrt;
  const Real distance = sqrt(branch.squaredNorm());
  const Vec3Of<Real> n = (1 / distance) * branch;
  const Real overlap = r_a + r_b - distance;
  return {n, overlap, (r_a - cut * overlap) * n, -(r_b - cut * overlap) * n, r_a * r_b / (r_a + r_b), cut};
}

/// The same by where their centres are.
inline ContactGeometry ball_ball(const Vec3& x_a, double r_a, const Vec3& x_b, double r_b,
                                 double cut = to_contact_point) {
  return balls_apart<double>(x_b - x_a, r_a, r_b, cut);
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
