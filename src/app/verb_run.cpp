#include "eigengrain/assembly/balance.hpp"
#include "eigengrain/assembly/bonds.hpp"
#include "eigengrain/base/error.hpp"
#include "eigengrain/base/timer.hpp"
#include "eigengrain/cycle/cycle.hpp"
#include "eigengrain/cycle/policy.hpp"
#include "eigengrain/cycle/watch.hpp"
#include "eigengrain/measures/ledger.hpp"

#include "input.hpp"
#include "interrupt.hpp"
#include "progress.hpp"
#include "run_outputs.hpp"
#include "state_report.hpp"
#include "step_check.hpp"
#include "text.hpp"
#include "verbs.hpp"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <exception>
#include <iterator>
#include <limits>
#include <string>
#include <vector>

namespace eigengrain::app {
namespace {

using assembly::State;

/// Steps between looks at the state: for a blow-up, and at the unbalanced ratio. A look costs about two
/// steps.
constexpr std::int64_t steps_between_looks = 100;

/// When a run is over.
class Goal {
 public:
  explicit Goal(const model::RunChoice& run) : run_(run) {
    if (!run.steps && !run.time && !run.unbalanced)
      throw InputError(
          "the scene does not say how far to run; add run: {steps: 10000} to it, or --set run.steps=10000");
  }
  bool reached(const State& state) const {
    return (run_.steps && state.step >= *run_.steps) || (run_.time && state.time >= *run_.time) || balanced_;
  }
  bool wants_balance() const { return run_.unbalanced.has_value(); }
  void look(const assembly::Balance& balance) {
    balanced_ = balance.unsupported == 0 && balance.bodies > 0 && balance.mean < *run_.unbalanced;
  }
  /// Steps up to the one that ends the run; it may end sooner.
  std::int64_t last_step() const { return run_.steps.value_or(std::numeric_limits<std::int64_t>::max()); }
  /// Whether an end by steps or time left a wish for balance open.
  bool missed() const { return run_.unbalanced && !balanced_; }
  double fraction(const State& state) const {
    double done = -1;
    if (run_.steps) done = static_cast<double>(state.step) / static_cast<double>(*run_.steps);
    if (run_.time) done = std::max(done, state.time / *run_.time);
    return done;
  }

 private:
  model::RunChoice run_;
  bool balanced_ = false;
};

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

cycle::Cycle started(assembly::State state) {
  cycle::TimestepPolicy policy = cycle::policy_of(state.settings);  // before the state is moved
  return {std::move(state), std::move(policy)};
}

/// One run, from an input to its goal.
class Run {
 public:
  explicit Run(Input input)
      : goal_(input.state.settings.run),
        outputs_(input),
        cycle_(started(std::move(input.state))),
        watch_(cycle_.state()),
        verdict_(judge_step(state(), state().next_dt)),
        first_step_(state().step) {}

  void go() {
    note_interrupts();
    outputs_.write_breaks(take_breaks());
    outputs_.write_due(state());
    outputs_.save(state());
    if (goal_.wants_balance() && state().step % steps_between_looks == 0)
      goal_.look(assembly::balance_of(state()));
    while (!goal_.reached(state()) && interrupted() == 0) {
      const std::int64_t target = std::min({next_look(), outputs_.next(state().step), goal_.last_step()});
      step_to(target);
      outputs_.write_breaks(take_breaks());
      attend();
    }
    look();
    outputs_.save(state());
    progress_.finish();
  }

  const State& state() const { return cycle_.state(); }
  const StepVerdict& verdict() const { return verdict_; }
  const Goal& goal() const { return goal_; }
  const RunOutputs& outputs() const { return outputs_; }
  std::int64_t steps() const { return state().step - first_step_; }
  double seconds() const { return seconds_; }
  std::int64_t broken() const { return broken_; }

 private:
  std::vector<assembly::BondBreak> take_breaks() {
    std::vector<assembly::BondBreak> breaks = cycle_.take_breaks();
    broken_ += std::ssize(breaks);
    return breaks;
  }

  std::int64_t next_look() const { return (state().step / steps_between_looks + 1) * steps_between_looks; }

  void look() {
    if (const auto trouble = watch_.look(state())) {
      progress_.finish();
      give_up(*trouble, state(), outputs_, verdict_now());
    }
  }

  /// The contacts of a blow-up may not have been there at the start.
  StepVerdict verdict_now() const {
    if (!verdict_.safe) return verdict_;
    try {
      const StepVerdict now = judge_step(state(), state().dt);
      return now.safe ? judge_first_contacts(state(), state().dt) : now;
    } catch (const std::exception&) {  // a state that cannot be judged any more
      return verdict_;
    }
  }

  /// Steps up to the target. A state that is lost makes other mistakes than its own; the watch knows better.
  void step_to(std::int64_t target) {
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
  void attend() {
    const std::int64_t step = state().step;
    const bool save = outputs_.checkpoint_due(step);
    if (step % steps_between_looks == 0 || save) {
      look();
      if (goal_.wants_balance() && step % steps_between_looks == 0) goal_.look(assembly::balance_of(state()));
      progress_.show(goal_.fraction(state()),
                     fmt::format("step {}, t = {:.6g} s", grouped(step), state().time));
    }
    outputs_.write_due(state());
    if (save) outputs_.save(state());
  }

  Goal goal_;
  RunOutputs outputs_;
  cycle::Cycle cycle_;
  cycle::Watch watch_;
  StepVerdict verdict_;
  Progress progress_;
  std::int64_t first_step_;
  double seconds_ = 0;       ///< of the cycle alone
  std::int64_t broken_ = 0;  ///< bonds, in this call
};

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

}  // namespace

void run(const Options& options) {
  Input input = read_input(options);
  print_notes(input.state.settings);
  attend_ledger(input.state);
  Run run(std::move(input));
  if (const std::string warning = warning_of(run.verdict()); !warning.empty())
    fmt::print(stderr, "{}\n", warning);
  run.go();

  const State& state = run.state();
  const assembly::Balance balance = assembly::balance_of(state);
  const double rate = run.seconds() > 0 ? static_cast<double>(run.steps()) *
                                              static_cast<double>(state.model.bodies.size()) / run.seconds()
                                        : 0.0;
  nlohmann::ordered_json report{{"steps", run.steps()},        {"step", state.step},
                                {"time", state.time},          {"dt", state.dt},
                                {"seconds", run.seconds()},    {"particle_steps_per_second", rate},
                                {"lists", state.list.rebuilds}};
  add_balance(report, balance);
  add_energies(report, state);
  if (state.ledger) add_ledger(report, state);
  const std::int64_t bonds = assembly::count_bonds(state.model);
  if (bonds > 0 || run.broken() > 0) report["bonds"] = {{"intact", bonds}, {"broken", run.broken()}};
  report["state"] = run.outputs().state_file().string();
  write_json(options.json, report);

  fmt::print("{}: {} in {}, t = {:.6g} s", state.settings.name, counted(run.steps(), "step", "steps"),
             duration_text(run.seconds()), state.time);
  if (rate > 0) fmt::print(", {:.3g} million ball steps a second", 1e-6 * rate);
  if (bonds > 0 || run.broken() > 0)
    fmt::print("\nbonds: {} intact, {} broken", grouped(bonds), grouped(run.broken()));
  fmt::print("\n{}\nstate: {}\n", balance_text(balance), run.outputs().state_file().string());
  if (interrupted() != 0) {
    fmt::print(stderr, "interrupted; continue with: eigengrain run {}\n",
               run.outputs().state_file().string());
    throw Interrupted{interrupted()};
  }
  if (run.goal().missed())
    fmt::print("the unbalanced ratio wished for ({:g}) was not reached in that time\n",
               *state.settings.run.unbalanced);
}

}  // namespace eigengrain::app
