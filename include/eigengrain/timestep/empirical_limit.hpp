#pragma once

#include "eigengrain/assembly/state.hpp"
#include "eigengrain/timestep/truth.hpp"

#include <cstdint>
#include <string>
#include <vector>

namespace eigengrain::timestep {

struct EmpiricalOptions {
  double accuracy = 1e-4;   ///< relative width of the bracket that the search ends with
  double amplitude = 1e-9;  ///< way of the fastest surface in the first step, over the least radius
};

/// The largest stable step of the cycle, found by running it.
struct EmpiricalLimit {
  double dt = 0;       ///< the middle of the bracket, s; infinite where nothing resists
  double stable = 0;   ///< the largest step tried at which the motion did not grow, s
  double growing = 0;  ///< the smallest one at which it grew, s
  /// Why this is an answer about this state and this motion only, and not about K; empty: the scene is
  /// linear.
  std::vector<std::string> reservations;
  std::int64_t runs = 0;
  std::int64_t steps = 0;  ///< of all runs
  double seconds = 0;

  bool linear() const { return reservations.empty(); }
};

/// Runs the cycle from a state, with fixed steps, and bisects on whether a small motion grows.
///
/// The state is brought to rest and into balance: walls, cell and radii stop, and every body gets the
/// constant load that cancels what acts on it. So what moves is the linearised scheme about this state, with
/// its damping, dashpots and whatever its forces add to K. It is started with velocities along the critical
/// mode, at which z = -1 (docs/theory.md), and a thousandth of that in all other modes: in linear scenes the
/// answer is the limit to the accuracy asked for.
///
/// A motion grows where its part that changes from step to step is, in the last quarter of a run, more than
/// twice what it was in the second one, and changes its sign with the step (a state that is unstable by
/// itself, as one that buckles or slides may be, moves away smoothly, which is no matter of the step). A run
/// is 800 steps, with dashpots 8,000: e^0.0089 a step at 1e-5 above the limit without dashpots, about e^0.001
/// at 5e-4 above it with them.
///
/// truth  of the state's model (critical_timestep): the mode, and the limit where the search begins
///
/// Throws SolverError where no step from a hundredth to ten times the limit decides. Cost: some ten runs.
EmpiricalLimit empirical_limit(const assembly::State& state, const Truth& truth,
                               const EmpiricalOptions& options = {});

}  // namespace eigengrain::timestep
