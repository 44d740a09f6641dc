#pragma once

#include "eigengrain/assembly/model.hpp"
#include "eigengrain/timestep/limiting_modes.hpp"
#include "eigengrain/timestep/selective_lift.hpp"

#include <nlohmann/json_fwd.hpp>

#include <string>

/// What `timestep` says of `--modes` and `--lift`.
namespace eigengrain::app {

nlohmann::ordered_json to_json(const timestep::LimitingModes& limits, const assembly::Model& model);
void print(const timestep::LimitingModes& limits, const assembly::Model& model);

nlohmann::ordered_json to_json(const timestep::SelectiveLift& lift, const assembly::Model& model);
void print(const timestep::SelectiveLift& lift);

/// The shapes of the modes, for ParaView. Throws InputError where the file cannot be written.
void write_modes(const std::string& file, const timestep::LimitingModes& limits,
                 const assembly::Model& model);

}  // namespace eigengrain::app
