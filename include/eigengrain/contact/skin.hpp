#pragma once

#include "eigengrain/base/vec.hpp"
#include "eigengrain/contact/element.hpp"
#include "eigengrain/contact/kinematics.hpp"

#include <array>
#include <cstdint>
#include <span>
#include <type_traits>

/// Contacts with the skin of a deformable body: a triangle whose corners are bodies.
namespace eigengrain::contact {

/// How the point P of a triangle that a ball touches moves with the corners:
///
///     u_P = Σ N_i u_i,      θ_P = Σ C_i u_i
///
/// N are barycentric. θ is the rotation of the triangle: of its normal n by n × dn, and about n by half the
/// curl of the displacement in its plane. With g_i = ∇N_i in the plane and t_i = n × g_i:  C_i = ½ n t_iᵀ -
/// t_i nᵀ. A rigid motion of the corners gives that motion of P, so forces and moments on P handed to the
/// corners by the transpose,
///
///     f_i = N_i F + C_iᵀ M,
///
/// keep momentum and angular momentum - if P is the point where the force acts: a ball's lever to a
/// deformable surface ends at P, not half an overlap before it.
struct SkinPoint {
  std::array<std::int32_t, 3> body{};  ///< rows of the corners
  std::array<double, 3> weight{};      ///< N, not negative, sum 1
  std::array<Mat3, 3> turn{};          ///< C, 1/m

  /// The motion of P when corner i moves by `factor` velocity[body[i]].
  SideMotion motion(std::span<const Vec3> velocity, double factor) const {
    SideMotion side;
    for (std::size_t i = 0; i < 3; ++i) {
      const Vec3 u = factor * velocity[static_cast<std::size_t>(body[i])];
      side.translation += weight[i] * u;
      side.rotation += turn[i] * u;
    }
    return side;
  }
  /// The force on corner i of a force and moment on P.
  Vec3 share(std::size_t i, const Vec3& force, const Vec3& moment) const {
    return weight[i] * force + turn[i].transpose() * moment;
  }
};

/// Whether side b of a pair is the skin of a deformable body.
template <class Kinematics>
bool on_skin(const Placement& placement, const Pair& pair) {
  if constexpr (std::is_same_v<Kinematics, BallFacet>)
    return BallFacet::deforms(placement, pair);
  else
    return false;
}

/// The point of facet pair.b that is nearest to ball pair.a. The facet is of a deformable surface.
SkinPoint skin_point(const Placement& placement, const Pair& pair);

/// All that K needs of a contact with a skin: the element between the ball and P, whose lever_b is zero and
/// whose b is no body, and how P moves with the corners. K = TᵀBᵀDBT, T = (u_a, θ_a, u_1, u_2, u_3) → (u_a,
/// θ_a, u_P, θ_P).
struct SkinElement {
  ContactElement element;
  SkinPoint point;
};

}  // namespace eigengrain::contact
