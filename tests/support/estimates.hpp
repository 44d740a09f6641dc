#pragma once

#include "eigengrain/timestep/estimates.hpp"

#include "support/dense.hpp"
#include "support/scenes.hpp"

#include <stdexcept>
#include <string>
#include <string_view>

/// Estimates of the timestep by name.
namespace eigengrain::test {

inline timestep::Answer answer_of(const timestep::Estimator& estimator, const System& system,
                                  std::span<const model::Material> materials = {}) {
  return estimator.find({system.model, system, materials});
}

/// An estimate by its name, s.
inline double estimate(std::string_view name, const System& system,
                       std::span<const model::Material> materials = {}) {
  const timestep::Estimator* estimator = timestep::find_estimator(name);
  if (estimator == nullptr) throw std::invalid_argument("no estimate " + std::string(name));
  const timestep::Answer answer = answer_of(*estimator, system, materials);
  if (!answer.left_out.empty()) throw std::invalid_argument(std::string(name) + ": " + answer.left_out);
  return answer.dt;
}

inline double ratio(std::string_view name, const System& system) {
  return estimate(name, system) / dense_truth(system);
}

/// Two equal spheres (R = m = 1) that touch along n.
inline SceneBuilder pair_along(const Vec3& n, const Springs& springs) {
  SceneBuilder builder(springs);
  return builder.ball(Vec3::Zero()).ball(2 * (1 - 1e-12) * n.normalized());
}

}  // namespace eigengrain::test
