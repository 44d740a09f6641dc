#pragma once

#include "eigengrain/assembly/eigen_matrix.hpp"
#include "eigengrain/assembly/linear_system.hpp"
#include "eigengrain/assembly/local_damping.hpp"
#include "eigengrain/assembly/state.hpp"
#include "eigengrain/cycle/cycle.hpp"
#include "eigengrain/cycle/mass_scaling.hpp"
#include "eigengrain/io/scene_reader.hpp"
#include "eigengrain/timestep/comparison.hpp"
#include "eigengrain/timestep/empirical_limit.hpp"

#include <Eigen/Eigenvalues>
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
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

/// 2/√λ_max by a dense eigensolver, s.
inline double dense_critical_timestep(const assembly::State& state) {
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> solver(
      assembly::dense_scaled_stiffness(assembly::LinearSystem(state.model)), Eigen::EigenvaluesOnly);
  return 2 / std::sqrt(solver.eigenvalues().tail<1>()[0]);
}

inline const timestep::Estimate& estimate_named(const timestep::Comparison& comparison,
                                                std::string_view name) {
  return *std::find_if(comparison.estimates.begin(), comparison.estimates.end(),
                       [&](const timestep::Estimate& e) { return e.name == name; });
}

/// sqrt(1 + β²) - β: by how much dashpots shorten the limit of one mode.
inline double shortened_by(double beta) {
  return std::sqrt(1 + beta * beta) - beta;
}

}  // namespace eigengrain::test
