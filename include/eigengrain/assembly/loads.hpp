#pragma once

#include "eigengrain/assembly/model.hpp"

#include <cstddef>

/// What acts on bodies beside their contacts: gravity, and the forces and moments that a scene applies to
/// them. Of a clump in the row of its holder; other balls of clumps have no more than their row says, so ask
/// for holders and balls of their own.
namespace eigengrain::assembly {

/// Gravity and the applied force, N.
inline Vec3 load_on(const Model& model, std::size_t row) {
  const model::Bodies& bodies = model.bodies;
  const Vec3 weight = bodies.mass[row] * model.gravity;  // of the true mass
  return bodies.applied_force.empty() ? weight : Vec3(weight + bodies.applied_force[row]);
}

/// The applied moment about the centre of mass, N m.
inline Vec3 moment_on(const Model& model, std::size_t row) {
  const model::Bodies& bodies = model.bodies;
  return bodies.applied_moment.empty() ? Vec3(Vec3::Zero()) : bodies.applied_moment[row];
}

/// Whether any force or moment is applied.
inline bool has_loads(const model::Bodies& bodies) {
  return !bodies.applied_force.empty() || !bodies.applied_moment.empty();
}

}  // namespace eigengrain::assembly
