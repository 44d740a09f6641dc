#pragma once

#include "eigengrain/assembly/model.hpp"
#include "eigengrain/assembly/unknowns.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <vector>

namespace eigengrain::assembly {

/// The force of local damping on one component: -α|F| sign(v) (PFC3D eq. 1.47), F the resultant with gravity,
/// N or N m.
inline double local_damping_force(double force, double velocity, double alpha) {
  // Without a branch on the sign, which nobody can predict.
  const double against = std::copysign(alpha * force, velocity);
  return velocity == 0 ? 0.0 : -against;
}

/// The same of a moment on a clump (N m, along the axes of space), which acts along the principal axes; where
/// all axes are principal, along those of space, as that of a ball does.
///
/// axes      from the principal axes to space
/// inertia   principal moments, kg m²
/// momentum  angular momentum: the sign of its components is that of the damping, kg m²/s
inline Vec3 local_damping_moment(const Vec3& moment, const Quat& axes, const Vec3& inertia,
                                 const Vec3& momentum, double alpha) {
  if (alpha == 0) return Vec3::Zero();
  const bool round = inertia[0] == inertia[1] && inertia[1] == inertia[2];
  const Quat orientation = round ? Quat(Quat::Identity()) : axes;
  const Vec3 own = orientation.conjugate() * moment;
  const Vec3 turning = orientation.conjugate() * momentum;
  Vec3 resistance;
  for (int k = 0; k < 3; ++k) resistance[k] = local_damping_force(own[k], turning[k], alpha);
  return orientation * resistance;
}

/// α of a body: its own, or that of the scene.
inline double damping_of(const Model& model, std::size_t row) {
  const std::vector<double>& own = model.bodies.damping;
  return own.empty() || own[row] == model::Bodies::scene_damping ? model.local_damping : own[row];
}

/// The largest α of any body: what bounds of the timestep count with for all (docs/theory.md).
inline double largest_damping(const Model& model) {
  if (model.bodies.damping.empty()) return model.local_damping;
  double largest = 0;
  for (std::size_t i = 0; i < model.bodies.damping.size(); ++i)
    largest = std::max(largest, damping_of(model, i));
  return largest;
}

/// [unknowns.size()] α of the body that each component belongs to: what a scaling of M by 1/(1 + α) asks for.
inline std::vector<double> damping_of_unknowns(const Model& model, const Unknowns& unknowns) {
  std::vector<double> alpha;
  alpha.reserve(static_cast<std::size_t>(unknowns.size()));
  for (std::int32_t block = 0; block < unknowns.blocks(); ++block)
    alpha.insert(alpha.end(), Unknowns::block_size,
                 damping_of(model, static_cast<std::size_t>(unknowns.body(block))));
  return alpha;
}

}  // namespace eigengrain::assembly
