#pragma once

#include "eigengrain/assembly/state.hpp"
#include "eigengrain/relaxation/relax.hpp"

#include <cstdint>
#include <filesystem>
#include <string>

namespace eigengrain::app {

/// Relaxes a state, with its reports on the error stream, until it is done or interrupted. Bonds that break
/// on the way have the step and the time of the state.
relaxation::RelaxResult relax_with_reports(assembly::State& state, double tolerance, std::int64_t max_steps,
                                           relaxation::Method method = relaxation::Method::hybrid);

/// The same; what a solver that gives up leaves is saved before it is told.
relaxation::RelaxResult relax_or_save(assembly::State& state, double tolerance, std::int64_t max_steps,
                                      relaxation::Method method, const std::filesystem::path& file);

/// The state, and beside it the bonds that broke on the way to it: NAME.h5 and NAME-breaks.csv.
void save_equilibrium(const assembly::State& state, const std::filesystem::path& file);

/// Why there is no equilibrium within the tolerance, as far as is known: groups that fall, servo walls that
/// miss their force, the floor of rounding. To be put behind "no equilibrium was found"; may be empty.
std::string why_not(const relaxation::RelaxResult& result, double tolerance);

/// The larger mean ratio, of forces or moments.
double mean_of(const relaxation::RelaxResult& result);

}  // namespace eigengrain::app
