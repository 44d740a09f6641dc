#pragma once

#include "eigengrain/assembly/balance.hpp"
#include "eigengrain/assembly/state.hpp"

#include <nlohmann/json_fwd.hpp>

#include <string>

/// What `run` and `relax` both say of a state.
namespace eigengrain::app {

void add_balance(nlohmann::ordered_json& report, const assembly::Balance& balance);
void add_energies(nlohmann::ordered_json& report, const assembly::State& state);
/// Of a state that keeps one.
void add_ledger(nlohmann::ordered_json& report, const assembly::State& state);
std::string balance_text(const assembly::Balance& balance);

}  // namespace eigengrain::app
