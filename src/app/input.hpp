#pragma once

#include "eigengrain/assembly/state.hpp"

#include "verbs.hpp"

#include <filesystem>
#include <set>
#include <span>
#include <string>

namespace eigengrain::app {

/// What a verb is asked about: a scene, or a state that an earlier run saved.
struct Input {
  assembly::State state;
  bool continued = false;  ///< from a state file
  /// Names of the results that were opened since the input was read: later stages go on with these, and begin
  /// others anew, if the input was a scene.
  std::set<std::string> opened{};
  std::string stem;              ///< of the names of results
  std::filesystem::path folder;  ///< of results
};

/// Reads a scene (and starts it) or a state. Results go to --output, else to where a state lies, else to the
/// current folder.
Input read_input(const Options& options);

/// What other settings mean for a state that goes on with them: its next step, and its ledger, begin anew
/// where they rest on what has changed.
void adapt_to(std::span<const std::string> overrides, assembly::State& state);

/// The model that a verb asks a question about, as it stands, and what was said beside its bodies.
struct Question {
  model::Scene settings;
  assembly::Model model;
};

/// Reads a scene, without starting it, or a state.
Question read_question(const Options& options);

}  // namespace eigengrain::app
