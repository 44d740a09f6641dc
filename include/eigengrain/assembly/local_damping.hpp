#pragma once

#include "eigengrain/assembly/model.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>

namespace eigengrain::assembly {

/// The force of local damping on one component: -α|F| sign(v) (PFC3D eq. 1.47), F the resultant with gravity,
/// N or N m.
inline double local_damping_force(double force, double velocity, double alpha) {
  if (velocity > 0) return -alpha * std::abs(force);
  if (velocity < 0) return alpha * std::abs(force);
  return 0.0;
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

}  // namespace eigengrain::assembly
