#pragma once

#include "eigengrain/assembly/state.hpp"

#include <string>

namespace eigengrain::app {

/// What is known of a timestep in a state as it stands.
struct StepVerdict {
  double dt = 0;
  double limit = 0;  ///< of the damped cycle, s: the true one where `exact`, else a proven bound below it
  bool exact = false;
  bool safe = false;  ///< dt does not exceed the limit
};

/// Judges the step that the cycle will take next: by the proven bound, which is cheap and asks nothing of
/// PETSc, and only where that does not suffice by the true critical timestep (if the program has it).
StepVerdict judge_step(const assembly::State& state, double dt);

/// The same for the contacts that balls may form which touch nothing: by the proven bound alone.
StepVerdict judge_first_contacts(const assembly::State& state, double dt);

/// A sentence of warning, or nothing where the step is safe.
std::string warning_of(const StepVerdict& verdict);

}  // namespace eigengrain::app
