#pragma once

#include "eigengrain/base/vec.hpp"
#include "eigengrain/contact/shear_transport.hpp"

namespace eigengrain::contact {

/// The orientation q after a turn by the rotation vector theta (rad, in space): exp(θ) q, exact for a spin
/// that does not change over the turn.
///
/// The result is unit to rounding: each product errs by some 1e-16 in length, which would add up over a run
/// and scale whatever q turns. One Newton step for 1/|q| takes it away, to all digits so near to one, and
/// costs no root.
inline Quat turned(const Quat& q, const Vec3& theta) {
  const double half_angle = 0.5 * theta.norm();
  const Turn half(half_angle);
  const Vec3 axis = (half_angle > 0 ? 0.5 * half.sine / half_angle : 0.5) * theta;
  Quat result = Quat(half.cosine, axis.x(), axis.y(), axis.z()) * q;
  result.coeffs() *= 1.5 - 0.5 * result.squaredNorm();
  return result;
}

}  // namespace eigengrain::contact
