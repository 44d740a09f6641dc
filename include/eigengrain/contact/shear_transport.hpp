#pragma once

#include "eigengrain/base/pack.hpp"
#include "eigengrain/base/vec.hpp"

#include <type_traits>

/// The shear force of a contact lies in the contact plane and is carried with it: first from the old plane
/// to the new one, then about the new normal with the mean spin of the two sides.
namespace eigengrain::contact {

/// A parameter that the type of numbers is not deduced from, so that expressions may be passed.
template <class T>
using Same = std::type_identity_t<T>;

/// Exact rotation that takes the unit vector n_old onto n the shortest way, applied to v.
template <class Real = double>
Vec3Of<Real> rotate_onto(const Same<Vec3Of<Real>>& v, const Same<Vec3Of<Real>>& n_old,
                         const Same<Vec3Of<Real>>& n) {
  const Real cosine = n_old.dot(n);
  const Vec3Of<Real> axis = n_old.cross(n);
  const Vec3Of<Real> turned = cosine * v + axis.cross(v) + axis * (axis.dot(v) / (1.0 + cosine));
  // Opposite normals have no shortest way; turning about v itself leaves v in both planes.
  return select<Real>(cosine < -1.0 + 1e-12, v, turned);
}

/// Cosine and sine of an angle by a fraction N/D for the tangent of its half (the 7th convergent of Lambert's
/// continued fraction), without a branch: cos = (D² - N²)/(D² + N²), sin = 2ND/(D² + N²). Their squares add
/// up to one for any angle, so that no length changes; the angle is right to rounding up to a radian, and to
/// 1e-8 up to three: steps turn by far less.
template <class Real>
struct Turn {
  explicit Turn(const Real& angle) {
    const Real half = 0.5 * angle;
    const Real square = half * half;
    const Real n = half * (135135.0 - square * (17325.0 - square * (378.0 - square)));
    const Real d = 135135.0 - square * (62370.0 - square * (3150.0 - 28.0 * square));
    const Real scale = 1.0 / (d * d + n * n);
    cosine = (d * d - n * n) * scale;
    sine = 2.0 * n * d * scale;
  }
  Real cosine;
  Real sine;
};

/// Shear force after the contact plane moved from n_old to n and turned about n by the angle `spin`. Keeps
/// |shear| and its tangency to rounding.
template <class Real = double>
Vec3Of<Real> carry_shear(const Same<Vec3Of<Real>>& shear, const Same<Vec3Of<Real>>& n_old,
                         const Same<Vec3Of<Real>>& n, const Same<Real>& spin) {
  const Vec3Of<Real> tilted = rotate_onto<Real>(shear, n_old, n);
  const Turn<Real> turn(spin);
  return turn.cosine * tilted + turn.sine * n.cross(tilted);
}

/// Any vector carried with the contact frame: its part along n_old goes with the normal, the rest as a shear
/// force does.
template <class Real = double>
Vec3Of<Real> carry_vector(const Same<Vec3Of<Real>>& v, const Same<Vec3Of<Real>>& n_old,
                          const Same<Vec3Of<Real>>& n, const Same<Real>& spin) {
  const Vec3Of<Real> tilted = rotate_onto<Real>(v, n_old, n);
  const Turn<Real> turn(spin);
  return turn.cosine * tilted + turn.sine * n.cross(tilted) + (1.0 - turn.cosine) * n.dot(tilted) * n;
}

/// Shear force projected onto the new contact plane, which shortens it by up to ½θ² a step of angle θ and
/// knows no spin about n.
template <class Real = double>
Vec3Of<Real> project_shear(const Same<Vec3Of<Real>>& shear, const Same<Vec3Of<Real>>& n) {
  return shear - shear.dot(n) * n;
}

/// carry_shear by PFC3D's small-angle forms (eqs. 1.11-1.12): per step of angle θ, |shear| grows by up to ½θ²
/// and tangency errs by up to ½θ³.
template <class Real = double>
Vec3Of<Real> carry_shear_small_angle(const Same<Vec3Of<Real>>& shear, const Same<Vec3Of<Real>>& n_old,
                                     const Same<Vec3Of<Real>>& n, const Same<Real>& spin) {
  const Vec3Of<Real> tilted = shear - shear.cross(n_old.cross(n));
  return tilted - tilted.cross(spin * n);
}

}  // namespace eigengrain::contact
