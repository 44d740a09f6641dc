#pragma once

#include "eigengrain/assembly/bond_break.hpp"
#include "eigengrain/cycle/cycle.hpp"
#include "eigengrain/cycle/goal.hpp"
#include "eigengrain/cycle/watch.hpp"

#include "input.hpp"
#include "progress.hpp"
#include "run_outputs.hpp"
#include "step_check.hpp"

#include <cstdint>
#include <memory>
#include <vector>

namespace eigengrain::app {

/// What the cycle did in a call of the program.
struct CycleWork {
  std::int64_t steps = 0;
  double seconds = 0;       ///< of the cycle alone
  std::int64_t broken = 0;  ///< bonds
  /// How often the policy was asked for a step, and how much of `seconds` that took.
  std::int64_t steps_chosen = 0;
  double choosing_seconds = 0;

  CycleWork& operator+=(const CycleWork& other) {
    steps += other.steps;
    seconds += other.seconds;
    broken += other.broken;
    steps_chosen += other.steps_chosen;
    choosing_seconds += other.choosing_seconds;
    return *this;
  }
};

/// One run of the explicit cycle, from an input to its goal, with all that it writes on the way.
class ExplicitRun {
 public:
  explicit ExplicitRun(Input input);

  /// Warns of a step that is not safe. Ends at the goal or at an interrupt; throws SolverError where the run
  /// blows up.
  void go();

  const assembly::State& state() const { return cycle_.state(); }
  /// The input for what follows, moved out; the run is over.
  Input take_input();
  const cycle::Goal& goal() const { return goal_; }
  const RunOutputs& outputs() const { return outputs_; }
  CycleWork work() const {
    return {state().step - first_step_, seconds_, broken_, choosing_->asked, choosing_->seconds};
  }

 private:
  /// What was asked of the policy while the cycle ran.
  struct Choosing {
    std::int64_t asked = 0;
    double seconds = 0;
  };
  /// A cycle whose policy is timed.
  static cycle::Cycle started(assembly::State state, std::shared_ptr<Choosing> choosing);

  std::vector<assembly::BondBreak> take_breaks();
  void look();
  StepVerdict verdict_now() const;
  void step_to(std::int64_t target);
  void attend();

  cycle::Goal goal_;
  RunOutputs outputs_;
  std::shared_ptr<Choosing> choosing_ = std::make_shared<Choosing>();
  cycle::Cycle cycle_;
  cycle::Watch watch_;
  StepVerdict verdict_;
  Progress progress_;
  Input input_;  ///< but for its state
  std::int64_t first_step_;
  double seconds_ = 0;
  std::int64_t broken_ = 0;
};

}  // namespace eigengrain::app
