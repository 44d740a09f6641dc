#include "eigengrain/cycle/policy.hpp"

#include "eigengrain/assembly/linear_system.hpp"
#include "eigengrain/cycle/bounds.hpp"
#include "eigengrain/cycle/mass_scaling.hpp"

#include "first_contact.hpp"
#include "proven_step.hpp"
#include "tracked_step.hpp"

#include <algorithm>
#include <memory>

namespace eigengrain::cycle {
namespace {

constexpr std::int64_t steps_between_estimates = 100;
/// Where stiffnesses follow the overlap. An impact takes some twenty steps.
constexpr std::int64_t steps_between_varying = 5;

double estimate(const assembly::State& state) {
  const assembly::LinearSystem system(state.model);
  return std::min(diagonal_estimate(system),
                  first_contact(state, system.unknowns.set_aside(), fastest_approach(state)).estimate);
}

/// Between lists a bound holds, but where stiffnesses follow the overlap, or balls come to touch other
/// triangles.
std::int64_t between_bounds(const model::Scene& settings, bool varies) {
  if (varies) return steps_between_varying;
  return settings.surfaces.empty() && settings.deformables.empty() ? 0 : steps_between_estimates;
}

}  // namespace

TimestepPolicy policy_of(const model::Scene& settings) {
  const model::TimestepChoice choice = settings.timestep;
  const bool varies = stiffness_varies(settings);
  // Elsewhere no guard can be had (tracked_step.hpp).
  const bool tracks = choice.policy == model::TimestepPolicy::tracked && settings.surfaces.empty() &&
                      settings.deformables.empty() && !settings.cell.deforms();
  const std::int64_t between_proofs = choice.every > 0 ? choice.every : steps_between_proofs;
  if (tracks && settings.mass_scaling && settings.mass_scaling->form == model::MassScaling::Form::selective)
    return {.dt = [dt = settings.mass_scaling->dt](const assembly::State&) { return dt; },
            .every = between_proofs,
            .prepare = [tracker = std::make_shared<StepTracker>(between_proofs)](
                           assembly::State& state) { track_masses(state, *tracker); },
            .keeps_guard = true};
  if (settings.mass_scaling)
    return {.dt = [dt = settings.mass_scaling->dt](const assembly::State&) { return dt; },
            .every = between_bounds(settings, varies),
            .prepare = scale_masses};
  switch (choice.policy) {
    case model::TimestepPolicy::fixed:
      return {[dt = choice.dt.value_or(0)](const assembly::State&) { return dt; }, 0};
    case model::TimestepPolicy::bound:
      return {[choice, varies](const assembly::State& state) {
                return choice.safety * proven_step(state, varies);
              },
              choice.every > 0 ? choice.every : between_bounds(settings, varies)};
    case model::TimestepPolicy::tracked: {
      const std::int64_t every =
          tracks || choice.every > 0 ? between_proofs : between_bounds(settings, varies);
      return {.dt =
                  [choice, varies](const assembly::State& state) {
                    if (state.guard) return choice.safety * state.guard->dt;
                    const auto guard = StepTracker().prove(state);
                    return choice.safety * (guard ? guard->dt : proven_step(state, varies));
                  },
              .every = every,
              .prepare = [tracker = std::make_shared<StepTracker>(between_proofs)](
                             assembly::State& state) { tracker->renew(state); },
              .worth_a_change = 1.0,
              .keeps_guard = true};
    }
    case model::TimestepPolicy::estimate:
      break;
  }
  return {[choice](const assembly::State& state) { return choice.safety * estimate(state); },
          choice.every > 0 ? choice.every
          : varies         ? steps_between_varying
                           : steps_between_estimates};
}

}  // namespace eigengrain::cycle
