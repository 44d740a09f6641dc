#include "eigengrain/timestep/step_study.hpp"

#include "eigengrain/assembly/contact_list.hpp"
#include "eigengrain/assembly/forces.hpp"
#include "eigengrain/base/error.hpp"

#include "course.hpp"
#include "impacts.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <numeric>
#include <random>
#include <string_view>

namespace eigengrain::timestep {
namespace {

/// A sample has some twenty steps even at the limit, so that rounding their number up changes little.
constexpr double limits_per_sample = 20;
/// What all samples of a run may hold; three runs are kept.
constexpr std::int64_t most_places = 6'000'000;
constexpr double largest_fraction = 2;
/// Errors below this many uncertainties of the reference say nothing of an order.
constexpr double clear_of_reference = 5;
constexpr double shift_of_twin = 1e-10;  // of the mean radius

void require(bool holds, std::string_view message) {
  if (!holds) throw InputError(std::string(message));
}

void check(const assembly::State& start, const StepStudyOptions& options) {
  require(!start.settings.mass_scaling,
          "compare steps: with scaled masses time is not that of the scene, and nothing on the way to rest "
          "means anything; remove mass_scaling");
  require(!options.fractions.empty(),
          "compare steps: no fractions of the limit to run with; give at least one");
  for (const double fraction : options.fractions)
    require(fraction > 0 && fraction <= largest_fraction,
            fmt::format("compare steps: a step of {:g} of the limit; give fractions above 0 and up to {:g}",
                        fraction, largest_fraction));
  require(std::isfinite(options.limit) && options.limit > 0,
          "compare steps: nothing resists a motion in this scene, so there is no critical step to take "
          "fractions of");
  require(
      options.time >= options.limit,
      fmt::format("compare steps: a time of {:g} s is less than one critical step ({:g} s); run longer, e.g. "
                  "--time {:.1g}",
                  options.time, options.limit, 100 * options.limit));
  require(options.samples >= 1, "compare steps: no samples; give at least one");
}

std::int64_t samples_of(const assembly::State& start, const StepStudyOptions& options) {
  const double room = std::floor(options.time / (limits_per_sample * options.limit));
  const std::int64_t memory = most_places / std::max(1, start.model.bodies.size());
  return std::max<std::int64_t>(
      1, std::min({options.samples, memory, static_cast<std::int64_t>(std::min(room, 1e9))}));
}

/// The fewest equal steps that fill a sample and are no longer than wished.
CoursePlan plan_for(double wished_dt, double sample_time, std::int64_t samples) {
  const auto steps = static_cast<std::int64_t>(std::ceil(sample_time / wished_dt * (1 - 1e-12)));
  const std::int64_t some = std::max<std::int64_t>(1, steps);
  return {.dt = sample_time / static_cast<double>(some), .steps_per_sample = some, .samples = samples};
}

CoursePlan finer(const CoursePlan& plan, int times) {
  return {.dt = plan.dt / times, .steps_per_sample = plan.steps_per_sample * times, .samples = plan.samples};
}

/// Steps of all runs, the smallest first, without those that come out alike.
std::vector<CoursePlan> plans_for(const StepStudyOptions& options, std::int64_t samples) {
  std::vector<double> fractions = options.fractions;
  std::sort(fractions.begin(), fractions.end());
  std::vector<CoursePlan> plans;
  for (const double fraction : fractions) {
    const CoursePlan plan =
        plan_for(fraction * options.limit, options.time / static_cast<double>(samples), samples);
    if (plans.empty() || plans.back().steps_per_sample != plan.steps_per_sample) plans.push_back(plan);
  }
  return plans;
}

/// The same state with all balls and clumps that are free to move shifted at random.
assembly::State shifted(const assembly::State& start, double by) {
  assembly::State state = start;
  model::Bodies& bodies = state.model.bodies;
  std::mt19937_64 random(1);
  std::normal_distribution<double> normal;
  const auto shift = [&](model::FixedComponents fixed) {
    const Vec3 direction(normal(random), normal(random), normal(random));
    return model::free_part(by * direction.normalized(), fixed.translation());
  };
  for (std::int32_t row = 0; row < bodies.size(); ++row)
    if (bodies.clumps.of(row) == model::Clumps::none)
      bodies.position[static_cast<std::size_t>(row)] += shift(bodies.fixed[static_cast<std::size_t>(row)]);
  for (std::int32_t c = 0; c < bodies.clumps.size(); ++c)
    bodies.clumps.position[static_cast<std::size_t>(c)] +=
        shift(bodies.fixed[static_cast<std::size_t>(bodies.clumps.holder(c))]);
  model::place_members(bodies);
  assembly::renew_forces(state);
  return state;
}

Statistics difference(const Statistics& x, const Statistics& y) {
  return {.kinetic = std::abs(x.kinetic - y.kinetic),
          .elastic = std::abs(x.elastic - y.elastic),
          .contact_force = std::abs(x.contact_force - y.contact_force),
          .contacts = std::abs(x.contacts - y.contacts),
          .height = std::abs(x.height - y.height)};
}

double mean_of(const std::vector<double>& values, std::size_t count) {
  if (count == 0) return not_there;
  return std::accumulate(values.begin(), values.begin() + static_cast<std::ptrdiff_t>(count), 0.0) /
         static_cast<double>(count);
}

double order_of(double coarse, double fine, double ratio) {
  return std::log(coarse / fine) / std::log(ratio);
}

/// What all runs of a study share.
class Study {
 public:
  Study(const assembly::State& start, const StepStudyOptions& options)
      : start_(start),
        cell_(start.model.cell),
        with_ledger_(!cell_.deforms()),
        with_impacts_(has_clear_impacts(start)) {
    check(start, options);
    result_.limit = options.limit;
    result_.time = options.time;
    result_.samples = samples_of(start, options);
    const std::vector<double>& radius = start.model.bodies.radius;
    result_.mean_radius = mean_of(radius, radius.size());
    plans_ = plans_for(options, result_.samples);
  }

  StepStudy run() {
    const Course first = recorded(plans_.front());
    make_reference(first);
    compare_with_twin(first);
    for (std::size_t k = 0; k < plans_.size(); ++k)
      result_.runs.push_back(run_of(plans_[k], k == 0 ? first : recorded(plans_[k])));
    for (std::size_t k = 1; k < result_.runs.size(); ++k) find_orders(half_of(k), result_.runs[k]);
    return result_;
  }

 private:
  Course recorded(const CoursePlan& plan) const { return record(start_, plan, with_ledger_, with_impacts_); }

  void make_reference(const Course& first) {
    const Course middle = recorded(finer(plans_.front(), 2));
    reference_ = recorded(finer(plans_.front(), 4));
    for (const Course* course : std::array<const Course*, 3>{&first, &middle, &reference_})
      require(course->trouble.empty(),
              fmt::format("compare steps: even the smallest steps blow up ({}); run the scene with timestep: "
                          "{{policy: bound}} first",
                          course->trouble));
    StepReference& about = result_.reference;
    about.dt = plans_.front().dt / 4;
    about.statistics = reference_.statistics;
    about.mean_restitution = mean_of(reference_.restitution, reference_.restitution.size());
    result_.energy = reference_.energy;
    result_.impacts = static_cast<std::int64_t>(reference_.restitution.size());
    const double fine = distance(middle, reference_, cell_);
    const double coarse = distance(first, middle, cell_);
    about.uncertainty = fine;
    if (!(fine > 0)) return;
    about.order = order_of(coarse, fine, 2);
    const int nearest = static_cast<int>(std::lround(about.order));
    if (nearest < 1 || nearest > 2 || std::abs(about.order - nearest) > 0.1) return;
    about.extrapolated_order = nearest;
    const Course better = extrapolated(reference_, middle, nearest, cell_);
    // The next term of the expansion is of at least one order more.
    about.uncertainty =
        distance(better, extrapolated(middle, first, nearest, cell_), cell_) / (std::exp2(nearest + 1) - 1);
    reference_ = better;
  }

  void compare_with_twin(const Course& first) {
    const double shift = shift_of_twin * result_.mean_radius;
    const Course twin = record(shifted(start_, shift), plans_.front(), with_ledger_, false);
    if (!twin.trouble.empty()) return;
    for (std::size_t s = 0; s < twin.places.size(); ++s) {
      Course one;
      Course other;
      one.places = {first.places[s]};
      other.places = {twin.places[s]};
      result_.sensitivity.growth = std::max(result_.sensitivity.growth, distance(one, other, cell_) / shift);
    }
    result_.sensitivity.departure = difference(first.statistics, twin.statistics);
  }

  StepRun run_of(const CoursePlan& plan, const Course& course) const {
    StepRun run{.dt = plan.dt,
                .fraction = plan.dt / result_.limit,
                .steps = plan.steps(),
                .statistics = course.statistics,
                .trouble = course.trouble};
    if (!course.trouble.empty()) {
      run.statistics = {};
      return run;
    }
    run.seconds = seconds_of(start_, plan);
    run.trajectory = distance(course, reference_, cell_);
    run.final_state = distance(course, reference_, cell_, course.places.size() - 1);
    run.energy = course.imbalance;
    const std::size_t common = std::min(course.restitution.size(), reference_.restitution.size());
    if (common == 0) return run;
    run.mean_restitution = mean_of(course.restitution, common);
    double sum = 0;
    for (std::size_t k = 0; k < common; ++k)
      sum += std::pow(course.restitution[k] - reference_.restitution[k], 2);
    run.restitution = std::sqrt(sum / static_cast<double>(common));
    return run;
  }

  /// The run whose step is nearest to half of that of run k > 0: neighbours are too near for an order.
  const StepRun& half_of(std::size_t k) const {
    const auto off = [&](const StepRun& run) { return std::abs(std::log(2 * run.dt / result_.runs[k].dt)); };
    return *std::min_element(result_.runs.begin(), result_.runs.begin() + static_cast<std::ptrdiff_t>(k),
                             [&](const StepRun& a, const StepRun& b) { return off(a) < off(b); });
  }

  void find_orders(const StepRun& before, StepRun& run) const {
    const double ratio = run.dt / before.dt;
    if (!result_.sensitivity.chaotic() &&
        before.trajectory > clear_of_reference * result_.reference.uncertainty)
      run.trajectory_order = checked_order(run.trajectory, before.trajectory, ratio);
    constexpr double rounding = 1e-12;
    if (before.energy > rounding * result_.energy)
      run.energy_order = checked_order(run.energy, before.energy, ratio);
    if (before.restitution > rounding)
      run.restitution_order = checked_order(run.restitution, before.restitution, ratio);
  }

  static std::optional<double> checked_order(double coarse, double fine, double ratio) {
    const double order = order_of(coarse, fine, ratio);
    return std::isfinite(order) ? std::optional(order) : std::nullopt;
  }

  const assembly::State& start_;
  model::PeriodicCell cell_;
  bool with_ledger_;
  bool with_impacts_;
  std::vector<CoursePlan> plans_;
  Course reference_;
  StepStudy result_;
};

}  // namespace

double steps_of(const StepStudyOptions& options) {
  double runs = 0;
  double smallest = std::numeric_limits<double>::infinity();
  for (const double fraction : options.fractions) {
    runs += 2 / fraction;
    smallest = std::min(smallest, fraction);
  }
  return options.time / options.limit * (runs + (1 + 2 + 4) / smallest);
}

StepStudy study_steps(const assembly::State& start, const StepStudyOptions& options) {
  return Study(start, options).run();
}

}  // namespace eigengrain::timestep
