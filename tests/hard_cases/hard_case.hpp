#pragma once

#include "eigengrain/assembly/linear_system.hpp"
#include "eigengrain/assembly/local_damping.hpp"
#include "eigengrain/assembly/state.hpp"
#include "eigengrain/cycle/cycle.hpp"
#include "eigengrain/cycle/mass_scaling.hpp"
#include "eigengrain/io/scene_reader.hpp"
#include "eigengrain/timestep/comparison.hpp"
#include "eigengrain/timestep/empirical_limit.hpp"

#include "support/dense.hpp"

#include <fmt/format.h>

#include <filesystem>
#include <span>
#include <string>
#include <string_view>
#include <vector>

/// The scenes of examples/scenes/hard_cases, as a run of them would start.
namespace eigengrain::test {

inline std::filesystem::path hard_case_folder() {
  return std::filesystem::path(EIGENGRAIN_EXAMPLES) / "scenes" / "hard_cases";
}

inline assembly::State start_of(std::string_view name, std::span<const std::string> overrides = {}) {
  assembly::State state =
      cycle::start(io::read_scene(hard_case_folder() / fmt::format("{}.yaml", name), overrides));
  if (state.settings.mass_scaling) cycle::scale_masses(state);
  return state;
}

}  // namespace eigengrain::test
