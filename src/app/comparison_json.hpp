#pragma once

#include "eigengrain/timestep/comparison.hpp"

#include <nlohmann/json.hpp>

namespace eigengrain::app {

/// JSON has no infinity: a step without limit is null.
nlohmann::ordered_json json_number(double value);

/// A comparison of estimates with the truth, as `timestep` and `compare timesteps` write it.
nlohmann::ordered_json comparison_json(const timestep::Comparison& comparison);

}  // namespace eigengrain::app
