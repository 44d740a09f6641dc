#include "eigengrain/cycle/free_rotation.hpp"

#include "eigengrain/contact/orientation.hpp"
#include "eigengrain/contact/shear_transport.hpp"

#include <cmath>

namespace eigengrain::cycle {
namespace {

/// The axes of the splitting.
struct Axes {
  int a;
  int b;
  int c;  ///< of the symmetric top
};

Axes axes_for(const Vec3& inverse) {
  const double xy = std::abs(inverse.x() - inverse.y());
  const double yz = std::abs(inverse.y() - inverse.z());
  const double zx = std::abs(inverse.z() - inverse.x());
  if (xy <= yz && xy <= zx) return {0, 1, 2};
  return yz <= zx ? Axes{1, 2, 0} : Axes{2, 0, 1};
}

/// The rotation by an angle about an axis of the body.
Quat about(int axis, double angle) {
  const contact::Turn half(0.5 * angle);
  Quat q(half.cosine, 0, 0, 0);
  q.vec()[axis] = half.sine;
  return q;
}

}  // namespace

Vec3 rotation_vector(const Quat& turn) {
  const double sine = turn.vec().norm();
  if (sine == 0) return Vec3::Zero();
  const double sign = turn.w() < 0 ? -1 : 1;  // q and -q are one rotation; the shorter way
  return sign * 2 * std::atan2(sine, std::abs(turn.w())) / sine * turn.vec();
}

FreeRotation rotate_freely(const Quat& orientation, const Vec3& angular_momentum, const Vec3& inertia,
                           double dt) {
  const Vec3 inverse = inertia.cwiseInverse();
  const auto [a, b, c] = axes_for(inverse);
  const Vec3 space = dt * inverse[b] * angular_momentum;
  if (inverse[a] == inverse[b] && inverse[c] == inverse[b])
    return {contact::turned(orientation, space), contact::turned(Quat::Identity(), space), space};
  // The momentum in the body turns the other way.
  Vec3 momentum = orientation.conjugate() * angular_momentum;
  const Quat first = about(a, 0.5 * dt * momentum[a] * (inverse[a] - inverse[b]));
  momentum = first.conjugate() * momentum;
  const Quat top = about(c, dt * momentum[c] * (inverse[c] - inverse[b]));
  momentum = top.conjugate() * momentum;
  const Quat last = about(a, 0.5 * dt * momentum[a] * (inverse[a] - inverse[b]));
  const Quat in_body = first * top * last;
  Quat in_space;
  in_space.w() = in_body.w();
  in_space.vec() = orientation * Vec3(in_body.vec());
  const Quat turn = contact::turned(in_space, space);
  Quat result = turn * orientation;
  result.coeffs() *= 1.5 - 0.5 * result.squaredNorm();  // as contact::turned does, and why
  return {result, turn, rotation_vector(turn)};
}

}  // namespace eigengrain::cycle
