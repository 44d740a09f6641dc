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

/// Shear force after the contact plane moved from n_old to n and turned by the rotation vector `spin` (of
/// which only the part along n counts). Keeps |shear| and its tangency to rounding.
inline Vec3 carry_shear(const Vec3& shear, const Vec3& n_old, const Vec3& n, const Vec3& spin) {
  const Vec3 tilted = rotate_onto(shear, n_old, n);
  const double angle = spin.dot(n);
  return std::cos(angle) * tilted + std::sin(angle) * n.cross(tilted);
}

/// The same by PFC3D's small-angle forms (eqs. 1.11-1.12): per step of angle θ, |shear| grows by up to ½θ²
/// and tangency errs by up to ½θ³.
inline Vec3 carry_shear_small_angle(const Vec3& shear, const Vec3& n_old, const Vec3& n, const Vec3& spin) {
  const Vec3 tilted = shear - shear.cross(n_old.cross(n));
  return tilted - tilted.cross(spin.dot(n) * n);
}

}  // namespace eigengrain::contact
