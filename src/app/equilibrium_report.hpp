#pragma once

#include "eigengrain/assembly/state.hpp"

#include <nlohmann/json_fwd.hpp>

#include <cstdint>
#include <string>

/// What `relax` says of an equilibrium beside its balance.
namespace eigengrain::app {

/// How the contacts of a state stand, and which bodies they do not hold.
struct ContactStatuses {
  std::int64_t sticking = 0;  ///< and those without friction
  std::int64_t slipping = 0;  ///< at the limit of friction
  std::int64_t bonded = 0;    ///< bonds that hold
  std::int64_t open = 0;      ///< near, but not acting
  std::int64_t rattlers = 0;  ///< bodies with fewer contacts than can hold one (measures::rattlers)
};
ContactStatuses statuses_of(const assembly::State& state);

nlohmann::ordered_json to_json(const ContactStatuses& statuses);
std::string text_of(const ContactStatuses& statuses);

/// [walls] name, and force (N) and moment (N m) of the bodies on it.
nlohmann::ordered_json reactions_of(const assembly::State& state);

}  // namespace eigengrain::app
