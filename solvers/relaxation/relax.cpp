#include "eigengrain/relaxation/relax.hpp"

#include "eigengrain/assembly/contact_list.hpp"
#include "eigengrain/base/error.hpp"
#include "eigengrain/base/text.hpp"
#include "eigengrain/base/timer.hpp"
#include "eigengrain/cycle/cycle.hpp"
#include "eigengrain/cycle/policy.hpp"

#include "at_rest.hpp"
#include "fire.hpp"
#include "newton.hpp"
#include "part.hpp"
#include "servo_walls.hpp"
#include "settling.hpp"
#include "soundness.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>
#include <vector>

namespace eigengrain::relaxation {
namespace {

using assembly::Balance;
using assembly::State;

/// Ratio below which Newton is tried where contacts have settled, and where it is tried anyway.
constexpr double first_hand_over = 1e-3;
constexpr double sure_hand_over = 1e-5;
constexpr double explicit_safety = 0.95;  // of a proven step
constexpr std::int64_t steps_between_looks = 100;
constexpr std::int64_t steps_between_reports = 1000;
/// Reach of Newton's list over the skin of the cycle's.
constexpr double newton_reach = 4;
/// Lists of contacts that Newton may use up before explicit cycles go on.
constexpr int most_lists = 20;
/// Newton is asked for this part of what is wished, so that the commit's rounding does not undo it.
constexpr double newton_margin = 0.3;
/// Where Newton's method is at the right place, a few iterations bring it to less than this.
constexpr double newton_progress = 0.2;
/// Over the rounding floor; less cannot be asked of positions in doubles.
constexpr double floor_margin = 1.5;

/// What the commit of a step may add to the least ratio.
constexpr double rounding_margin = 2;

/// Over the mean ratio, from where on a body counts as moving while others rest, and how many of all may do
/// so for them to be cycled by themselves.
constexpr double moving = 10;
constexpr double few = 0.01;
/// Ratios of the others from where on it pays to let them wait; above the last one only where the few are
/// what is left to settle for the most part.
constexpr std::array quiet_levels{1e-3, 1e-4, 1e-5};
constexpr std::int64_t most_part_steps = 200000;  // at a time, before the whole is looked at
/// A part costs two lists of the whole: where a few fly out of theirs before they had many steps, and more
/// than once, so many steps of all are the better way.
constexpr int most_short_parts = 3;
constexpr std::int64_t steps_without_parts = 2000;

/// Cycles by a method, of which the settings of the state know from now on.
cycle::Cycle begin_cycle(State& state, Method method) {
  model::Scene& settings = state.settings;
  settings.mass_scaling.reset();
  switch (method) {
    case Method::explicit_cycle:
      settings.timestep = {
          model::TimestepPolicy::estimate, model::default_safety(model::TimestepPolicy::estimate), {}};
      break;
    case Method::scaled:
      settings.timestep = {model::TimestepPolicy::bound, explicit_safety, {}};
      settings.mass_scaling = {.form = model::MassScaling::Form::differential, .dt = 1};
      break;
    default:
      settings.timestep = {model::TimestepPolicy::tracked, explicit_safety, {}};
  }
  const cycle::TimestepPolicy policy = cycle::policy_of(settings);
  return cycle::Cycle(std::move(state), policy);
}

class Relaxation {
 public:
  Relaxation(State& state, const RelaxOptions& options) : state_(state), options_(options) {}

  RelaxResult run() {
    require_numbers(state_);
    require_support(state_);
    SetAside moving_parts(state_);
    try {
      state_.list.growth = 0;  // nothing grows, and no cell is in motion: the list is of what stands
      assembly::renew_list(state_, state_.list.skin);
      halt(state_);
      look(state_);
      result_.start = result_.end;
      note_moment("start", true);
      go();
    } catch (...) {
      if (state_.model.bodies.size() > 0) {  // else no motion could begin, and the state is gone with it
        halt(state_);
        moving_parts.give_back(state_);
      }
      throw;
    }
    halt(state_);
    moving_parts.give_back(state_);
    result_.converged = done();
    if (!result_.converged) result_.floating = floating_groups(state_);
    result_.seconds = watch_.seconds();
    return std::move(result_);
  }

 private:
  void go() {
    if (options_.method == Method::hybrid)
      hybrid();
    else if (options_.method == Method::newton)
      newton_alone();
    else
      descend_alone();
  }

  bool done() const { return at_rest_within(result_.end, options_.tolerance) && walls_are_driven(); }
  void look(const State& state) {
    result_.end = assembly::balance_of(state);
    result_.missing_force = missing_force(state.model);
  }

  /// The least that may be asked for.
  double least() const { return std::max(options_.tolerance, floor_margin * result_.end.floor); }

  void hybrid() {
    double hand_over = first_hand_over;
    bool newton_failed = false;  // the last time: cycles of the whole come first now
    while (!done() && !given_up()) {
      const double ratio = std::max(hand_over, least());
      std::optional<double> few_left;
      if (newton_failed || !may_hand_over(ratio, {})) few_left = approach(ratio);
      if (done() || given_up()) break;
      if (few_left) {
        settle_movers(*few_left);
        continue;
      }
      // What is found is all that rounding allows, even if it is not enough; but over meshes a committed
      // state may touch other triangles than Newton's method knew.
      if (finish() && at_rest_within(result_.end, rounding_margin * least()) && walls_are_driven()) break;
      // What a mover or two have kept it from may go on from here.
      if (const auto level = few_move(state_); level && !newton_failed) {
        newton_failed = true;
        settle_movers(*level);
        continue;
      }
      newton_failed = true;
      if (mean_of(result_.end) <= least() && walls_are_driven()) break;
      hand_over = std::min(ratio, mean_of(result_.end)) / 10;
    }
  }

  void descend_alone() {
    const bool walls_stand = options_.method == Method::fire;
    bool driven = true;
    // Again where the forces of dashpots were part of what looked like rest.
    do {
      descend(options_.method, [&](const State&) {
        return walls_stand ? at_rest_within(result_.end, options_.tolerance) : done();
      });
      if (walls_stand && !given_up() && !walls_are_driven()) driven = drive_walls();
    } while (driven && !done() && !given_up());
  }

  void newton_alone() {
    double before = 0;
    do {
      before = mean_of(result_.end);
      if (finish()) return;
    } while (!given_up() && mean_of(result_.end) < 0.5 * before);
  }

  bool walls_are_driven() const { return result_.missing_force <= options_.tolerance; }

  bool given_up() const {
    return interrupted_ || result_.explicit_steps + result_.part_steps >= options_.max_steps;
  }
  void ask_for_interrupts() {
    interrupted_ = interrupted_ || (options_.interrupted && options_.interrupted());
  }

  void report(const std::string& stage) const {
    if (options_.report)
      options_.report(fmt::format(
          "{}: {} explicit steps, unbalanced mean {:.2e}, max {:.2e}{}", stage,
          grouped(result_.explicit_steps), mean_of(result_.end),
          std::max(result_.end.max, result_.end.moment_max),
          result_.end.unsupported > 0 ? fmt::format(", {} unsupported", result_.end.unsupported) : ""));
  }

  RelaxStage& stage(std::string_view name) {
    if (result_.stages.empty() || result_.stages.back().name != name)
      result_.stages.push_back({.name = name});
    return result_.stages.back();
  }

  /// observed  whether the state is the one that the balance is of
  void note_moment(std::string_view name, bool observed, const State* at = nullptr) {
    const Moment moment{.seconds = watch_.seconds(),
                        .sweeps = sweeps_,
                        .mean = mean_of(result_.end),
                        .max = std::max(result_.end.max, result_.end.moment_max),
                        .stage = name};
    result_.course.push_back(moment);
    if (observed && options_.observe) options_.observe(at != nullptr ? *at : state_, moment);
  }

  /// Whether Newton's method may be tried: soon where contacts have settled since the last look, and in any
  /// case at a low ratio.
  bool may_hand_over(double ratio,
                     const std::optional<std::pair<ContactCounts, ContactCounts>>& looks) const {
    if (settled_within(result_.end, std::min(ratio, sure_hand_over))) return true;
    return looks && settled_within(result_.end, ratio) && stays(looks->first, looks->second);
  }

  /// Steps of a motion until it is over.
  template <class Motion, class Over>
  void move_until(Motion& motion, std::string_view name, const Over& over) {
    RelaxStage& now = stage(name);
    const double before = watch_.seconds();
    const double seconds = now.seconds;
    do {
      motion.run(steps_between_looks);
      result_.explicit_steps += steps_between_looks;
      now.steps += steps_between_looks;
      sweeps_ += steps_between_looks;
      look(motion.state());
      if (!std::isfinite(mean_of(result_.end)))
        throw SolverError(
            fmt::format("the {} method blew up after {} steps: its forces are not numbers any more; take "
                        "--method hybrid, "
                        "whose steps are proven",
                        name, result_.explicit_steps));
      now.mean = mean_of(result_.end);
      now.seconds = seconds + watch_.seconds() - before;
      note_moment(name, true, &motion.state());
      if (result_.explicit_steps % steps_between_reports == 0) report(std::string(name));
      ask_for_interrupts();
    } while (!given_up() && !over(motion.state()));
    result_.explicit_seconds += watch_.seconds() - before;
  }

  /// The same with the state, which comes back whatever happens: where it blows up, as it was before.
  template <class Motion, class Over>
  void move_state(Motion motion, std::string_view name, const State* before, const Over& over) {
    try {
      move_until(motion, name, over);
    } catch (...) {
      state_ = before != nullptr ? *before : motion.release();
      throw;
    }
    state_ = motion.release();
  }

  template <class Over>
  void descend(Method method, const Over& over) {
    const std::string_view name = name_of(method);
    if (done() || given_up()) return;
    if (method == Method::fire) {
      move_state(Fire(std::move(state_)), name, nullptr, over);
    } else {
      const State before = proven(method) ? State{} : state_;
      move_state(begin_cycle(state_, method), name, proven(method) ? nullptr : &before, over);
      state_.model.bodies.mass_factor.clear();
    }
    halt(state_);
    look(state_);
    note_method(name);
  }
  /// Whether its steps cannot blow up.
  static bool proven(Method method) { return method != Method::explicit_cycle; }

  /// Explicit cycles until Newton's method may be tried, or until only a few bodies move: then the ratio that
  /// the others have.
  std::optional<double> approach(double ratio) {
    std::optional<ContactCounts> before;
    std::optional<double> few_left;
    descend(Method::tracked, [&](const State& state) {
      few_left = few_move(state);
      if (done() || few_left) return true;
      if (!settled_within(result_.end, ratio)) {
        before.reset();
        return false;
      }
      const ContactCounts now = count_contacts(state.model);
      std::optional<std::pair<ContactCounts, ContactCounts>> looks;
      if (before) looks.emplace(*before, now);
      before = now;
      return may_hand_over(ratio, looks);
    });
    return few_left;
  }

  /// The force above which a body counts as moving while others have this ratio, N.
  double moving_force(double ratio) const { return moving * ratio * result_.end.mean_contact_force; }

  bool are_few(const Movers& movers) const {
    return !movers.bodies.empty() &&
           static_cast<double>(movers.bodies.size()) <= few * static_cast<double>(result_.end.bodies);
  }

  /// The ratio of all others where a few bodies are what keeps the state from coming to rest.
  std::optional<double> few_move(const State& state) const {
    // A part of a deformable body is none.
    if (result_.explicit_steps < no_parts_before_ || !state.model.solids.empty()) return std::nullopt;
    for (const double level : quiet_levels) {
      const Movers movers = movers_of(state, moving_force(level));
      const bool quiet =
          movers.rest <= level * static_cast<double>(result_.end.bodies) * result_.end.mean_contact_force;
      const bool matter = level == quiet_levels.back() || movers.moving > movers.rest;
      if (quiet && matter && are_few(movers)) return level;
    }
    return std::nullopt;
  }

  /// Cycles of the bodies that move, and of them alone, until they rest too.
  void settle_movers(double ratio) {
    const Stopwatch watch;
    RelaxStage& now = stage("few");
    const double force = moving_force(ratio);
    const std::int64_t end = result_.part_steps + most_part_steps;
    int short_parts = 0;
    const auto go_on = [&] {
      return result_.part_steps < end && short_parts < most_short_parts && !given_up();
    };
    for (Movers movers = movers_of(state_, force); are_few(movers) && go_on();
         movers = movers_of(state_, force)) {
      Part part(state_, movers.bodies);
      cycle::Cycle cycle = begin_cycle(part.state(), Method::tracked);
      const std::int64_t first = result_.part_steps;
      do {
        for (int k = 0; k < steps_between_looks && part.has_room(cycle.state()); ++k) {
          cycle.step();
          ++result_.part_steps;
          ++now.steps;
        }
        ask_for_interrupts();
      } while (!movers_of(cycle.state(), force).bodies.empty() && part.has_room(cycle.state()) && go_on());
      short_parts = result_.part_steps - first < steps_between_looks ? short_parts + 1 : 0;
      part.put_back(cycle.state(), state_);
    }
    if (short_parts == most_short_parts) no_parts_before_ = result_.explicit_steps + steps_without_parts;
    halt(state_);
    look(state_);
    report(fmt::format("{} steps of a few that moved", grouped(result_.part_steps)));
    now.seconds += watch.seconds();
    now.mean = mean_of(result_.end);
    note_moment(now.name, true);
    result_.explicit_seconds += watch.seconds();
  }

  /// Newton's method, with new lists while bodies go farther than one knows; whether it found the
  /// equilibrium.
  bool finish() {
    for (int list = 0; list < most_lists; ++list) {
      const double reach = newton_reach * state_.list.skin;
      assembly::renew_list(state_, reach);
      NewtonOptions wanted;
      wanted.target = std::max(newton_margin * options_.tolerance, floor_margin * result_.end.floor);
      wanted.reach = reach;
      wanted.interrupted = options_.interrupted;
      if (options_.method == Method::hybrid) wanted.progress = newton_progress;
      const Stopwatch watch;
      const double until_now = watch_.seconds();
      const NewtonResult found = newton(state_, wanted);
      note(found, until_now, watch.seconds());
      if (interrupted_ || (!found.converged && !found.unfinished)) return false;
      if (!found.converged) continue;
      if (walls_are_driven()) return true;
      if (mean_of(result_.end) > rounding_margin * wanted.target) return true;  // see hybrid
      if (!drive_walls()) return false;
    }
    return false;
  }

  /// Servo walls to where they push as they are asked to; whether they are nearer to it. One that touches
  /// nothing is for the explicit cycle.
  bool drive_walls() {
    const double before = result_.missing_force;
    const double reach = newton_reach * state_.list.skin;
    assembly::renew_list(state_, reach);
    try {
      drive_servo_walls(state_, reach, options_.interrupted);
    } catch (const SolverError& error) {  // nothing has moved yet
      ask_for_interrupts();
      if (!interrupted_) result_.linear_failures.emplace_back(error.what());
      return false;
    }
    look(state_);
    return result_.missing_force < before;
  }

  void note(const NewtonResult& found, double until_now, double seconds) {
    ++result_.attempts;
    result_.newton_iterations += found.iterations;
    result_.linear_iterations += found.linear_iterations;
    look(state_);
    result_.linear_failures.insert(result_.linear_failures.end(), found.linear_failures.begin(),
                                   found.linear_failures.end());
    if (!found.linear_method.empty()) result_.linear_method = found.linear_method;
    RelaxStage& now = stage("newton");
    now.iterations += found.iterations;
    now.linear_iterations += found.linear_iterations;
    now.seconds += seconds;
    now.mean = mean_of(result_.end);
    for (const NewtonMoment& moment : found.course)
      result_.course.push_back({.seconds = until_now + moment.seconds,
                                .sweeps = sweeps_ + moment.sweeps,
                                .mean = moment.ratio,
                                .stage = "newton"});
    if (!found.course.empty()) sweeps_ += found.course.back().sweeps;
    note_moment("newton", true);
    report(fmt::format("newton, {} iterations ({} linear{}){}", found.iterations, found.linear_iterations,
                       found.linear_method.empty() ? "" : ", " + found.linear_method,
                       found.converged ? "" : fmt::format(", ended at {:.1e}: {}", found.ratio, found.why)));
    for (const std::string& failure : found.linear_failures)
      if (options_.report) options_.report(fmt::format("  another linear solver took over from {}", failure));
    if (found.converged) note_method("newton");
    ask_for_interrupts();
  }

  void note_method(std::string_view name) {
    if (result_.method.find(name) == std::string::npos)
      result_.method.append(result_.method.empty() ? "" : "+").append(name);
  }

  State& state_;
  const RelaxOptions& options_;
  RelaxResult result_;
  Stopwatch watch_;
  std::int64_t sweeps_ = 0;
  std::int64_t no_parts_before_ = 0;  ///< explicit step
  bool interrupted_ = false;
};

}  // namespace

std::optional<Method> find_method(std::string_view name) {
  for (const NamedMethod& known : methods)
    if (known.name == name) return known.method;
  return std::nullopt;
}

RelaxResult relax(State& state, const RelaxOptions& options) {
  state.ledger.reset();  // the way to an equilibrium is not one in time
  return Relaxation(state, options).run();
}

}  // namespace eigengrain::relaxation
