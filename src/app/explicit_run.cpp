#include "explicit_run.hpp"

#include "eigengrain/base/error.hpp"
#include "eigengrain/base/timer.hpp"
#include "eigengrain/cycle/policy.hpp"
#include "eigengrain/measures/ledger.hpp"

#include "interrupt.hpp"
#include "text.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <exception>
#include <iterator>
#include <string>
#include <utility>

namespace eigengrain::app {
namespace {

using assembly::State;

/// Steps between looks at the state: for a blow-up, and at the conditions for an end. A look costs about two
/// steps.
constexpr std::int64_t steps_between_looks = 100;

/// A ledger is kept while a table asks for it. One that a state brings along goes on.
void attend_ledger(State& state) {
  const auto& tables = state.settings.histories;
  const bool wanted =
      std::any_of(tables.begin(), tables.end(), [](const model::History& table) { return table.ledger; });
  if (!wanted)
    state.ledger.reset();
  else if (!state.ledger)
    measures::begin_ledger(state);
}

/// Ends a run that has gone wrong, with all that helps to find out why.
[[noreturn]] void give_up(const cycle::Trouble& trouble, const State& state, const RunOutputs& outputs,
                          const StepVerdict& verdict) {
  std::string names;
  for (const std::int64_t body : trouble.bodies)
    names += fmt::format("{}{}", names.empty() ? "" : ", ", body);
  const std::string cause =
      verdict.safe
          ? std::string(
                "the step is within the limit of the contacts as they were: look for bodies that are pressed "
                "into each other, or for loads far beyond their stiffness")
          : fmt::format(
                "the step of {:.3e} s is {:.3f} times {} of {:.3e} s; take timestep: {{policy: bound}}",
                verdict.dt, verdict.dt / verdict.limit,
                verdict.exact ? "the true limit" : "what is proven stable,", verdict.limit);
  throw SolverError(fmt::format(
      "the run blew up before step {}: {} (balls {})\nlikely cause: {}\nlast good state: step {} in {}",
      state.step, trouble.what, names, cause, outputs.saved_step(), outputs.state_file().string()));
}

}  // namespace

cycle::Cycle ExplicitRun::started(State state, std::shared_ptr<Choosing> choosing) {
  attend_ledger(state);
  cycle::TimestepPolicy policy = cycle::policy_of(state.settings);  // before the state is moved
  if (policy.prepare)
    policy.prepare = [prepare = policy.prepare, choosing](State& s) {
      const Stopwatch watch;
      prepare(s);
      choosing->seconds += watch.seconds();
    };
  policy.dt = [dt = policy.dt, choosing](const State& s) {
    const Stopwatch watch;
    const double chosen = dt(s);
    choosing->seconds += watch.seconds();
    ++choosing->asked;
    return chosen;
  };
  cycle::Cycle cycle(std::move(state), std::move(policy));
  *choosing = {};  // the first one is not of the cycle's seconds
  return cycle;
}

ExplicitRun::ExplicitRun(Input input)
    : goal_(input.state),
      outputs_(input),
      cycle_(started(std::move(input.state), choosing_)),
      watch_(cycle_.state()),
      verdict_(judge_step(state(), state().next_dt)),
      input_(std::move(input)),
      first_step_(state().step) {}

Input ExplicitRun::take_input() {
  input_.state = cycle_.release();
  return std::move(input_);
}

void ExplicitRun::go() {
  if (const std::string warning = warning_of(verdict_); !warning.empty()) fmt::print(stderr, "{}\n", warning);
  note_interrupts();
  outputs_.write_breaks(take_breaks());
  outputs_.write_due(state());
  outputs_.save(state());
  if (goal_.has_condition() && state().step % steps_between_looks == 0) goal_.look(state());
  while (!goal_.reached(state()) && interrupted() == 0) {
    const std::int64_t next_look = (state().step / steps_between_looks + 1) * steps_between_looks;
    step_to(std::min({next_look, outputs_.next(state().step), goal_.last_step()}));
    outputs_.write_breaks(take_breaks());
    attend();
  }
  look();
  outputs_.save(state());
  progress_.finish();
}

std::vector<assembly::BondBreak> ExplicitRun::take_breaks() {
  std::vector<assembly::BondBreak> breaks = cycle_.take_breaks();
  broken_ += std::ssize(breaks);
  return breaks;
}

void ExplicitRun::look() {
  if (const auto trouble = watch_.look(state())) {
    progress_.finish();
    give_up(*trouble, state(), outputs_, verdict_now());
  }
}

/// The contacts of a blow-up may not have been there at the start.
StepVerdict ExplicitRun::verdict_now() const {
  if (!verdict_.safe) return verdict_;
  try {
    const StepVerdict now = judge_step(state(), state().dt);
    return now.safe ? judge_first_contacts(state(), state().dt) : now;
  } catch (const std::exception&) {  // a state that cannot be judged any more
    return verdict_;
  }
}

/// Steps up to the target. A state that is lost makes other mistakes than its own; the watch knows better.
void ExplicitRun::step_to(std::int64_t target) {
  const Stopwatch watch;
  try {
    while (state().step < target && !goal_.reached(state()) && interrupted() == 0) cycle_.step();
  } catch (const InputError&) {
    look();
    throw;
  }
  seconds_ += watch.seconds();
}

/// What is due at the step that was reached. States are only saved after a look.
void ExplicitRun::attend() {
  const std::int64_t step = state().step;
  const bool save = outputs_.checkpoint_due(step);
  if (step % steps_between_looks == 0 || save) {
    look();
    if (goal_.has_condition() && step % steps_between_looks == 0) goal_.look(state());
    progress_.show(goal_.fraction(state()),
                   fmt::format("step {}, t = {:.6g} s", grouped(step), state().time));
  }
  outputs_.write_due(state());
  if (save) outputs_.save(state());
}

}  // namespace eigengrain::app
