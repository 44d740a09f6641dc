#pragma once

#include "eigengrain/base/vec.hpp"

#include <cmath>

/// The shear force of a contact lies in the contact plane and is carried with it: first from the old plane
/// to the new one, then about the new normal with the mean spin of the two sides.
namespace eigengrain::contact {

/// Exact rotation that takes the unit vector n_old onto n the shortest way, applied to v.
inline Vec3 rotate_onto(const Vec3& v, const Vec3& n_old, const Vec3& n) {
  const double cosine = n_old.dot(n);
  // Opposite normals have no shortest way; turning about v itself leaves v in both planes.
  if (cosine < -1.0 + 1e-12) return v;
  const Vec3 axis = n_old.cross(n);
  return cosine * v + axis.cross(v) + axis * (axis.dot(v) / (1.0 + cosine));
}

/// Cosine and sine of an angle, to rounding. Per step angles are small, and there a few terms of the series
/// are exact and several times cheaper than the library's functions.
struct Turn {
  explicit Turn(double angle) {
    const double square = angle * angle;
    if (square < 1e-4) {  // the first terms left out: angle^8/8!, and angle^7/7! of the sine
      cosine = 1.0 - square * (1.0 / 2 - square * (1.0 / 24 - square * (1.0 / 720)));
      sine = angle * (1.0 - square * (1.0 / 6 - square * (1.0 / 120 - square * (1.0 / 5040))));
    } else {
      cosine = std::cos(angle);
      sine = std::sin(angle);
    }
  }
  double cosine;
  double sine;
};

/// Shear force after the contact plane moved from n_old to n and turned about n by the angle `spin`. Keeps
/// |shear| and its tangency to rounding.
inline Vec3 carry_shear(const Vec3& shear, const Vec3& n_old, const Vec3& n, double spin) {
  const Vec3 tilted = rotate_onto(shear, n_old, n);
  const Turn turn(spin);
  return turn.cosine * tilted + turn.sine * n.cross(tilted);
}

/// Any vector carried with the contact frame: its part along n_old goes with the normal, the rest as a shear
/// force does.
inline Vec3 carry_vector(const Vec3& v, const Vec3& n_old, const Vec3& n, double spin) {
  const Vec3 tilted = rotate_onto(v, n_old, n);
  const Turn turn(spin);
  return turn.cosine * tilted + turn.sine * n.cross(tilted) + (1.0 - turn.cosine) * n.dot(tilted) * n;
}

/// Shear force projected onto the new contact plane, which shortens it by up to ½θ² a step of angle θ and
/// knows no spin about n.
inline Vec3 project_shear(const Vec3& shear, const Vec3& n) {
  return shear - shear.dot(n) * n;
}

/// carry_shear by PFC3D's small-angle forms (eqs. 1.11-1.12): per step of angle θ, |shear| grows by up to ½θ²
/// and tangency errs by up to ½θ³.
inline Vec3 carry_shear_small_angle(const Vec3& shear, const Vec3& n_old, const Vec3& n, double spin) {
  const Vec3 tilted = shear - shear.cross(n_old.cross(n));
  return tilted - tilted.cross(spin * n);
}

}  // namespace eigengrain::contact
