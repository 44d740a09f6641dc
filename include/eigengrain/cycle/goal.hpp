#pragma once

#include "eigengrain/assembly/state.hpp"

#include <cstdint>
#include <optional>
#include <string>

namespace eigengrain::cycle {

/// When a run is over.
class Goal {
 public:
  /// Of the state's stage, if it is in one, else of its settings. Throws InputError where these do not say
  /// how far to run, or name a wall that does not exist.
  explicit Goal(const assembly::State& state);
  /// Of its own, from where the state is.
  Goal(const model::RunChoice& run, const assembly::State& from);

  bool reached(const assembly::State& state) const {
    return (last_step_ && state.step >= *last_step_) || (end_ && state.time >= *end_) || met_;
  }
  bool has_condition() const { return run_.has_condition(); }
  /// Looks whether the conditions hold. Cost: about two steps.
  void look(const assembly::State& state);
  /// Steps up to the one that ends the run; it may end sooner.
  std::int64_t last_step() const;
  /// Whether an end by steps or time left the conditions open.
  bool missed() const { return run_.has_condition() && !met_; }
  /// Of the run that is done, in [0, 1]; negative where nobody can know.
  double fraction(const assembly::State& state) const;
  /// "the unbalanced ratio wished for (1e-05) was not reached", or that not all conditions held together.
  std::string text_of_missed() const;

 private:
  Goal(const model::RunChoice& run, std::int64_t first_step, double start, const assembly::State& state);

  model::RunChoice run_;
  std::int64_t first_step_ = 0;
  double start_ = 0;  ///< s
  std::optional<std::int64_t> last_step_;
  std::optional<double> end_;  ///< s
  std::size_t wall_ = 0;       ///< of the condition
  bool met_ = false;
};

}  // namespace eigengrain::cycle
