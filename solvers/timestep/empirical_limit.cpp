#include "eigengrain/timestep/empirical_limit.hpp"

#include "eigengrain/assembly/linear_system.hpp"
#include "eigengrain/base/error.hpp"
#include "eigengrain/base/timer.hpp"
#include "eigengrain/cycle/cycle.hpp"

#include "probe.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <functional>
#include <limits>
#include <numeric>
#include <random>
#include <utility>

namespace eigengrain::timestep {
namespace {

/// At the limit a motion grows linearly; above it, it has grown beyond doubt when it has grown by this.
constexpr double beyond_doubt = 1e4;
/// From the second to the last quarter of a run. What only beats comes back to the same within a quarter.
constexpr double growth_in_half_a_run = 2;
constexpr std::int64_t steps_undamped = 800;
/// With dashpots the growth is of first order in what the step is above the limit, not of order one half.
constexpr std::int64_t steps_with_dashpots = 8000;

/// Of the motion at the start all modes share this at random, so that one that K puts below its critical
/// mode, or forbids to move at all, is not missed. A few hundred steps make up for it.
constexpr double at_random = 1e-3;
constexpr std::uint64_t seed = 1;

/// The search begins this far on both sides of the expected limit, and looks no farther than the others.
constexpr double first_guess = 1e-3;
constexpr double least_part = 0.01;
constexpr double largest_part = 10;

/// The experiment: the same start with one step after the other.
class Experiment {
 public:
  Experiment(const assembly::State& state, const Truth& truth, const EmpiricalOptions& options)
      : rest_(in_balance(state)),
        system_(rest_.model),
        motion_(system_),
        start_(start(system_, truth)),
        steps_(!system_.has_dashpots() ? steps_undamped : steps_with_dashpots) {
    const std::vector<double>& radius = rest_.model.bodies.radius;
    way_ = options.amplitude * *std::min_element(radius.begin(), radius.end());
    limit_.reservations = reservations_about(rest_);
  }

  /// Whether the motion grows because of the step: from one to the next with the other sign.
  bool grows(double dt) {
    assembly::State moving = rest_;
    motion_.set(moving, start_, way_ / dt / motion_.fastest_surface(rest_, start_));
    std::vector<double> before(start_.size());
    std::vector<double> now(start_.size());
    motion_.get(moving, before);
    std::vector<double> older(before.size());
    std::transform(before.begin(), before.end(), older.begin(), std::negate());  // as if it had alternated
    const double initial = std::sqrt(product(before, before));
    cycle::Cycle cycle(std::move(moving), {[dt](const assembly::State&) { return dt; }, 0});
    double second_quarter = 0;
    double last_quarter = 0;
    bool grown = false;
    bool smooth = false;
    ++limit_.runs;
    for (std::int64_t n = 0; n < steps_ && !grown; ++n) {
      cycle.step();
      ++limit_.steps;
      motion_.get(cycle.state(), now);
      const double alternating = alternating_part(now, before, older);
      grown = !(alternating <= beyond_doubt * initial);  // also if it is no number
      smooth = product(now, before) > 0;
      const std::int64_t quarter = 4 * n / steps_;
      if (quarter == 1) second_quarter = std::max(second_quarter, alternating);
      if (quarter == 3) last_quarter = std::max(last_quarter, alternating);
      std::swap(older, before);
      std::swap(before, now);
    }
    add_changes(rest_, cycle.state(), limit_.reservations);
    grown = grown || last_quarter > growth_in_half_a_run * second_quarter;
    if (grown && smooth)
      add_once(limit_.reservations,
               "the state is unstable by itself: it moves away from it smoothly, at any step");
    return grown && !smooth;
  }

  EmpiricalLimit take() { return std::move(limit_); }

 private:
  /// Velocities along the critical mode, x·M'x = 1, and a little of all others.
  static std::vector<double> start(const assembly::LinearSystem& system, const Truth& truth) {
    std::vector<double> v = truth.limit_mode;
    const std::vector<double> scale = system.inverse_sqrt_mass();
    std::mt19937_64 random(seed);
    std::normal_distribution<double> gaussian;
    const double part = at_random / std::sqrt(static_cast<double>(v.size()));
    for (std::size_t k = 0; k < v.size(); ++k) v[k] += part * scale[k] * gaussian(random);
    return v;
  }
  static double product(const std::vector<double>& a, const std::vector<double>& b) {
    return std::inner_product(a.begin(), a.end(), b.begin(), 0.0);
  }
  /// |¼ (now - 2 before + older)|: what changes its sign with every step counts in full, slow and rigid
  /// motions cancel, and what grows smoothly counts by the square of its rate only.
  static double alternating_part(const std::vector<double>& now, const std::vector<double>& before,
                                 const std::vector<double>& older) {
    double sum = 0;
    for (std::size_t k = 0; k < now.size(); ++k) {
      const double part = 0.25 * (now[k] - 2 * before[k] + older[k]);
      sum += part * part;
    }
    return std::sqrt(sum);
  }

  assembly::State rest_;
  assembly::LinearSystem system_;
  Motion motion_;
  std::vector<double> start_;
  std::int64_t steps_;
  double way_ = 0;
  EmpiricalLimit limit_;
};

struct Bracket {
  double stable = 0;
  double growing = 0;
};

/// Steps on both sides of the limit: the nearest first, then ever farther from what was expected.
Bracket bracket_around(double expected, Experiment& experiment) {
  Bracket bracket;
  for (double aside = first_guess; bracket.growing == 0 && aside < largest_part; aside *= 4) {
    const double dt = expected * (1 + aside);
    (experiment.grows(dt) ? bracket.growing : bracket.stable) = dt;
  }
  for (double aside = first_guess; bracket.stable == 0 && bracket.growing > 0; aside *= 4) {
    const double part = std::max(1 / (1 + aside), least_part);
    (experiment.grows(expected * part) ? bracket.growing : bracket.stable) = expected * part;
    if (part == least_part) break;
  }
  if (bracket.stable == 0 || bracket.growing == 0)
    throw SolverError(fmt::format(
        "runs find no limit of the step: from {:.3e} to {:.3e} s motions {} at all of them",
        least_part * expected, largest_part * expected, bracket.stable == 0 ? "grow" : "do not grow"));
  return bracket;
}

}  // namespace

EmpiricalLimit empirical_limit(const assembly::State& state, const Truth& truth,
                               const EmpiricalOptions& options) {
  constexpr double infinity = std::numeric_limits<double>::infinity();
  if (truth.limit_mode.empty())
    return {.dt = infinity, .stable = infinity, .growing = infinity, .reservations = {}};
  const Stopwatch watch;
  Experiment experiment(state, truth, options);
  Bracket bracket = bracket_around(truth.limit, experiment);
  while (bracket.growing - bracket.stable > options.accuracy * bracket.stable) {
    const double dt = 0.5 * (bracket.stable + bracket.growing);
    (experiment.grows(dt) ? bracket.growing : bracket.stable) = dt;
  }
  EmpiricalLimit result = experiment.take();
  result.dt = 0.5 * (bracket.stable + bracket.growing);
  result.stable = bracket.stable;
  result.growing = bracket.growing;
  result.seconds = watch.seconds();
  return result;
}

}  // namespace eigengrain::timestep
