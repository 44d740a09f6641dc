#pragma once

#include "eigengrain/assembly/state.hpp"
#include "eigengrain/model/bodies.hpp"
#include "eigengrain/model/stage.hpp"

#include <cstdint>
#include <string>

/// Changes of a state between two moments: what a stage does before it runs.
namespace eigengrain::assembly {

/// Changes bodies; a velocity that is given is that of the moment, so the leapfrog's, half a step earlier,
/// differs by half a step of the present force. The next step is chosen anew, and a ledger begins anew: the
/// energy is another one. Throws InputError, beginning with `where`, where a selection means nothing, and
/// where the radius of a clump is to change.
void change_bodies(State& state, const model::BodyChange& change, const std::string& where);

/// What became of balls that were to be added.
struct Added {
  std::int64_t balls = 0;
  std::int64_t left_out = 0;  ///< as they would overlap balls or walls that are there
};

/// Adds balls to a state, numbered behind those that are there; without those that would overlap them or a
/// wall. Contacts among them form in the next step.
Added add_balls(State& state, const model::Bodies& balls);

}  // namespace eigengrain::assembly
