#include "step_check.hpp"

#include "eigengrain/assembly/linear_system.hpp"
#include "eigengrain/assembly/local_damping.hpp"
#include "eigengrain/cycle/policy.hpp"
#include "eigengrain/cycle/step_prover.hpp"
#ifdef EIGENGRAIN_PETSC
#include "eigengrain/timestep/truth.hpp"
#endif

#include <fmt/format.h>

namespace eigengrain::app {

StepVerdict judge_step(const assembly::State& state, double dt) {
  const assembly::LinearSystem system(state.model);
  const double damping = assembly::largest_damping(state.model);
  cycle::StepProver prover(
      system, damping > 0 ? std::vector<double>(static_cast<std::size_t>(system.unknowns.bodies()), damping)
                          : std::vector<double>());
  StepVerdict verdict{.dt = dt, .limit = prover.bound()};
  verdict.safe = dt <= verdict.limit || prover.prove(dt);
  if (verdict.safe) return verdict;
#ifdef EIGENGRAIN_PETSC
  verdict.limit =
      timestep::critical_timestep(system, assembly::damping_of_unknowns(state.model, system.unknowns),
                                  {.certify = timestep::Certify::never})
          .limit;
  verdict.exact = true;
  verdict.safe = dt <= verdict.limit;
#endif
  return verdict;
}

StepVerdict judge_first_contacts(const assembly::State& state, double dt) {
  model::Scene settings = state.settings;
  settings.timestep = {model::TimestepPolicy::bound, 1.0, {}};
  settings.mass_scaling.reset();  // of the masses as they are
  StepVerdict verdict{.dt = dt, .limit = cycle::policy_of(settings).dt(state)};
  verdict.safe = dt <= verdict.limit;
  return verdict;
}

std::string warning_of(const StepVerdict& verdict) {
  if (verdict.safe) return {};
  if (!verdict.exact)
    return fmt::format(
        "WARNING: the step of {:.6e} s is {:.3f} times what is proven to be stable here ({:.6e} s); take "
        "timestep: {{policy: bound}}",
        verdict.dt, verdict.dt / verdict.limit, verdict.limit);
  return fmt::format(
      "WARNING: the step of {:.6e} s is {:.3f} times the true limit of this scene ({:.6e} s): the cycle will "
      "blow "
      "up. Take a smaller one, or timestep: {{policy: bound}}",
      verdict.dt, verdict.dt / verdict.limit, verdict.limit);
}

}  // namespace eigengrain::app
