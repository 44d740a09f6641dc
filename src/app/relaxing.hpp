#pragma once

#include "eigengrain/assembly/state.hpp"
#include "eigengrain/relaxation/relax.hpp"

#include <cstdint>

namespace eigengrain::app {

/// Relaxes a state, with its reports on the error stream, until it is done or interrupted. Bonds that break
/// on the way have the step and the time of the state.
relaxation::RelaxResult relax_with_reports(assembly::State& state, double tolerance, std::int64_t max_steps,
                                           relaxation::Method method = relaxation::Method::hybrid);

}  // namespace eigengrain::app
