#pragma once

#include "eigengrain/assembly/forces.hpp"
#include "eigengrain/assembly/state.hpp"

#include "support/scenes.hpp"

#include <random>
#include <utility>

/// States of a few bodies for tests of what is written of them.
namespace eigengrain::test {

/// The state of a scene at a step: velocities of the scene (zeros where it has none), forces of the contacts.
inline assembly::State state_of(const SceneBuilder& builder, std::int64_t step, double time) {
  assembly::State state{.settings = {}, .model = builder.build(), .force = {}, .moment = {}, .list = {}};
  state.model.bodies.velocity.resize(state.model.bodies.position.size(), Vec3::Zero());
  state.force = assembly::contact_forces(state.model).force;
  state.step = step;
  state.time = time;
  return state;
}

/// Ten balls in a cluster with random velocities; the rows of the state are not in the order of identity.
inline SceneBuilder moving_cluster(std::mt19937_64& random, bool turning) {
  SceneBuilder builder = random_cluster(random, 10, {.kn = 1e5, .tension = false});
  for (int ball = 0; ball < builder.scene().bodies.size(); ++ball) {
    builder.scene().bodies.velocity.push_back(random_vector(random));
    if (turning) builder.scene().bodies.spin.push_back(random_vector(random));
  }
  return builder;
}

}  // namespace eigengrain::test
