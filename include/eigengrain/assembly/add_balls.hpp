#pragma once

#include "eigengrain/assembly/state.hpp"
#include "eigengrain/model/bodies.hpp"

#include <cstdint>

namespace eigengrain::assembly {

/// What became of balls that were to be added.
struct Added {
  std::int64_t balls = 0;
  std::int64_t left_out = 0;  ///< as they would overlap balls or walls that are there
};

/// Adds balls to a state, numbered behind those that are there; without those that would overlap them or a
/// wall. Contacts among them form in the next step.
Added add_balls(State& state, const model::Bodies& balls);

}  // namespace eigengrain::assembly
