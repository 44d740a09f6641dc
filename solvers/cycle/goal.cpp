#include "eigengrain/cycle/goal.hpp"

#include "eigengrain/assembly/balance.hpp"
#include "eigengrain/assembly/energies.hpp"
#include "eigengrain/assembly/forces.hpp"
#include "eigengrain/assembly/surroundings.hpp"
#include "eigengrain/base/error.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <limits>

namespace eigengrain::cycle {
namespace {

/// What the scene says, of the stage in hand where it has stages.
const model::RunChoice& choice_of(const assembly::State& state) {
  const model::Scene& settings = state.settings;
  const model::RunChoice& run = settings.stages.empty()
                                    ? settings.run
                                    : settings.stages[static_cast<std::size_t>(state.progress.stage)].run;
  if (!run.any())
    throw InputError(
        "the scene does not say how far to run; add run: {steps: 10000} to it, or --set run.steps=10000");
  return run;
}

}  // namespace

Goal::Goal(const assembly::State& state)
    : Goal(choice_of(state), state.settings.stages.empty() ? 0 : state.progress.first_step,
           state.settings.stages.empty() ? 0 : state.progress.first_time, state) {}

Goal::Goal(const model::RunChoice& run, const assembly::State& from)
    : Goal(run, from.step, from.time, from) {}

Goal::Goal(const model::RunChoice& run, std::int64_t first_step, double start, const assembly::State& state)
    : run_(run), first_step_(first_step), start_(start) {
  if (run_.steps) last_step_ = first_step_ + *run_.steps;
  if (run_.time) end_ = start_ + *run_.time;
  if (run_.wall_force)
    wall_ = static_cast<std::size_t>(assembly::find_wall(state.model, run_.wall_force->wall, "until"));
}

void Goal::look(const assembly::State& state) {
  met_ = state.step > first_step_;  // at the start of a run everything may be about to move
  if (met_ && run_.unbalanced) {
    const assembly::Balance balance = assembly::balance_of(state);
    met_ = balance.unsupported == 0 && balance.bodies > 0 && balance.mean < *run_.unbalanced;
  }
  if (met_ && run_.kinetic) met_ = assembly::energies_of(state).kinetic < *run_.kinetic;
  if (met_ && run_.wall_force)
    met_ = assembly::wall_loads(state.model)[wall_].force.norm() >= run_.wall_force->at_least;
}

std::int64_t Goal::last_step() const {
  return last_step_.value_or(std::numeric_limits<std::int64_t>::max());
}

std::string Goal::text_of_missed() const {
  if (run_.unbalanced && !run_.kinetic && !run_.wall_force)
    return fmt::format("the unbalanced ratio wished for ({:g}) was not reached", *run_.unbalanced);
  return "the conditions of `until` did not hold together";
}

double Goal::fraction(const assembly::State& state) const {
  double done = -1;
  if (run_.steps) done = static_cast<double>(state.step - first_step_) / static_cast<double>(*run_.steps);
  if (run_.time) done = std::max(done, (state.time - start_) / *run_.time);
  return done;
}

}  // namespace eigengrain::cycle
