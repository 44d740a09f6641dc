#include "eigengrain/relaxation/relax.hpp"

#include "eigengrain/assembly/cell_motion.hpp"
#include "eigengrain/assembly/contact_list.hpp"
#include "eigengrain/base/text.hpp"
#include "eigengrain/base/timer.hpp"
#include "eigengrain/cycle/cycle.hpp"
#include "eigengrain/cycle/policy.hpp"

#include "newton.hpp"
#include "part.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <utility>
#include <vector>

namespace eigengrain::relaxation {
namespace {

using assembly::Balance;
using assembly::State;

constexpr double explicit_damping = 0.7;
constexpr double first_hand_over = 1e-5;  // ratio at which Newton is tried first
constexpr double explicit_safety = 0.95;  // of a proven bound
constexpr std::int64_t steps_between_looks = 100;
constexpr std::int64_t steps_between_reports = 1000;
/// Reach of Newton's list over the skin of the cycle's.
constexpr double newton_reach = 4;
/// Lists of contacts that Newton may use up before explicit cycles go on.
constexpr int most_lists = 20;
/// Newton is asked for this part of what is wished, so that the commit's rounding does not undo it.
constexpr double newton_margin = 0.3;
/// Over the rounding floor; less cannot be asked of positions in doubles.
constexpr double floor_margin = 1.5;

/// What the commit of a step may add to the least ratio.
constexpr double rounding_margin = 2;

/// Largest over mean ratio where bodies still fall or roll: there Newton is asked in vain.
constexpr double settled_max = 100;
/// Over the mean ratio, from where on a body counts as moving while others rest, and how many of all may do
/// so for them to be cycled by themselves.
constexpr double moving = 10;
constexpr double few = 0.005;
constexpr std::int64_t most_part_steps = 200000;  // at a time, before the whole is looked at

bool at_rest_within(const Balance& balance, double ratio) {
  return balance.unsupported == 0 && std::max(balance.mean, balance.moment_mean) <= ratio;
}

bool settled_within(const Balance& balance, double ratio) {
  return at_rest_within(balance, ratio) && std::max(balance.max, balance.moment_max) <= settled_max * ratio;
}

/// Everything stands still at a moment of its own, and dashpots do nothing.
void halt(State& state) {
  for (Vec3& v : state.model.bodies.velocity) v.setZero();
  for (Vec3& w : state.model.bodies.spin) w.setZero();
  model::Clumps& clumps = state.model.bodies.clumps;
  for (Vec3& v : clumps.velocity) v.setZero();
  for (Vec3& w : clumps.spin) w.setZero();
  for (Vec3& l : clumps.angular_momentum) l.setZero();
  state.model.cell.rate.setZero();  // bodies have nothing of its flow any more
  state.dt = 0;
  assembly::forget_step(state);
  assembly::renew_forces(state);
}

class Relaxation {
 public:
  Relaxation(State& state, const RelaxOptions& options) : state_(state), options_(options) {}

  RelaxResult run() {
    const Stopwatch watch;
    const Clock clock(state_);
    const GivenVelocities given(state_);
    const double damping = std::exchange(state_.model.local_damping, explicit_damping);
    // What bodies have of their own to move by counts afterwards again: α, masses that are scaled, ramps of
    // radii.
    auto own_damping = std::exchange(state_.model.bodies.damping, {});
    auto mass_factor = std::exchange(state_.model.bodies.mass_factor, {});
    auto ramp = std::exchange(state_.model.bodies.ramp, {});
    // Walls and cell rest while an equilibrium is sought, and move on afterwards.
    const Mat3 gradient = std::exchange(state_.model.cell.velocity_gradient, Mat3::Zero());
    auto motions = std::exchange(state_.model.wall_motions, {});
    auto poses = std::exchange(state_.model.wall_poses, {});
    halt(state_);
    result_.start = result_.end = assembly::balance_of(state_);
    double hand_over = first_hand_over;
    bool newton_failed = false;
    while (!at_rest_within(result_.end, options_.tolerance) && !given_up()) {
      const double least = std::max(options_.tolerance, floor_margin * result_.end.floor);
      const double ratio = std::max(hand_over, least);
      if (newton_failed || !settled_within(result_.end, ratio)) approach(ratio);
      if (at_rest_within(result_.end, options_.tolerance) || given_up()) break;
      if (!settled_within(result_.end, ratio)) {
        settle_movers(ratio);
        continue;
      }
      // What is found is all that rounding allows, even if it is not enough; but over meshes a committed
      // state may touch other triangles than Newton's method knew.
      if (finish() && at_rest_within(result_.end, rounding_margin * least)) break;
      newton_failed = true;
      if (hand_over <= least) break;
      hand_over /= 10;
    }
    halt(state_);
    given.restore(state_);
    clock.restore(state_);
    state_.model.local_damping = damping;
    state_.model.bodies.damping = std::move(own_damping);
    state_.model.bodies.mass_factor = std::move(mass_factor);
    state_.model.bodies.ramp = std::move(ramp);
    state_.model.cell.velocity_gradient = gradient;
    state_.model.wall_motions = std::move(motions);
    state_.model.wall_poses = std::move(poses);
    result_.converged = at_rest_within(result_.end, options_.tolerance);
    result_.seconds = watch.seconds();
    return std::move(result_);
  }

 private:
  struct Clock {
    explicit Clock(const State& state) : time(state.time), step(state.step) {}
    void restore(State& state) const {
      state.time = time;
      state.step = step;
    }
    double time;
    std::int64_t step;
  };

  /// Velocities that fixed components keep: they rest while an equilibrium is sought, and move on afterwards.
  struct GivenVelocities {
    explicit GivenVelocities(const State& state)
        : velocity(state.model.bodies.velocity),
          spin(state.model.bodies.spin),
          of_clumps(state.model.bodies.clumps.velocity),
          clump_spin(state.model.bodies.clumps.spin) {
      // The flow of the cell comes back with its first step.
      const assembly::Fluctuation fluctuation(state.model.cell);
      for (std::size_t i = 0; i < velocity.size(); ++i)
        velocity[i] = fluctuation.of(velocity[i], state.model.bodies.position[i]);
      for (std::size_t c = 0; c < of_clumps.size(); ++c)
        of_clumps[c] = fluctuation.of(of_clumps[c], state.model.bodies.clumps.position[c]);
    }
    void restore(State& state) const {
      model::Bodies& bodies = state.model.bodies;
      for (std::size_t i = 0; i < velocity.size(); ++i) {
        const model::FixedComponents fixed = bodies.fixed[i];
        bodies.velocity[i] = velocity[i] - model::free_part(velocity[i], fixed.translation());
        if (!spin.empty()) bodies.spin[i] = spin[i] - model::free_part(spin[i], fixed.rotation());
      }
      model::Clumps& clumps = bodies.clumps;
      for (std::int32_t c = 0; c < clumps.size(); ++c) {
        const auto k = static_cast<std::size_t>(c);
        const model::FixedComponents fixed = bodies.fixed[static_cast<std::size_t>(clumps.holder(c))];
        clumps.velocity[k] = of_clumps[k] - model::free_part(of_clumps[k], fixed.translation());
        if (fixed.rotation() != 7) continue;
        clumps.spin[k] = clump_spin[k];
        clumps.angular_momentum[k] = model::angular_momentum(clumps, c, clump_spin[k]);
      }
    }
    std::vector<Vec3> velocity;
    std::vector<Vec3> spin;
    std::vector<Vec3> of_clumps;
    std::vector<Vec3> clump_spin;
  };

  bool given_up() const {
    return interrupted_ || result_.explicit_steps + result_.part_steps >= options_.max_steps;
  }

  void report(const std::string& stage) const {
    if (options_.report)
      options_.report(fmt::format(
          "{}: {} explicit steps, unbalanced mean {:.2e}, max {:.2e}{}", stage,
          grouped(result_.explicit_steps), result_.end.mean, result_.end.max,
          result_.end.unsupported > 0 ? fmt::format(", {} unsupported", result_.end.unsupported) : ""));
  }

  cycle::TimestepPolicy policy() const {
    model::Scene settings = state_.settings;
    settings.timestep = {model::TimestepPolicy::bound, explicit_safety, {}};
    settings.mass_scaling.reset();
    return cycle::policy_of(settings);
  }

  /// Explicit cycles down to the ratio, or until only a few bodies are left above it.
  void approach(double ratio) {
    const Stopwatch watch;
    const cycle::TimestepPolicy chosen = policy();
    cycle::Cycle cycle(std::move(state_), chosen);
    do {
      cycle.run(steps_between_looks);
      result_.explicit_steps += steps_between_looks;
      result_.end = assembly::balance_of(cycle.state());
      if (result_.explicit_steps % steps_between_reports == 0) report("explicit");
      interrupted_ = options_.interrupted && options_.interrupted();
    } while (!settled_within(result_.end, ratio) && !few_move(cycle.state(), ratio) && !given_up());
    state_ = cycle.release();
    halt(state_);
    result_.end = assembly::balance_of(state_);
    note_method("explicit");
    result_.explicit_seconds += watch.seconds();
  }

  /// The force above which a body counts as moving at this ratio, N.
  double moving_force(double ratio) const { return moving * ratio * result_.end.mean_contact_force; }

  bool are_few(const Movers& movers) const {
    return !movers.bodies.empty() &&
           static_cast<double>(movers.bodies.size()) <= few * static_cast<double>(result_.end.bodies);
  }

  /// Whether a few bodies are all that keeps the state from the ratio. A part (part.hpp) knows no clumps:
  /// where there are some, the whole is cycled until it has settled.
  bool few_move(const State& state, double ratio) const {
    if (!state.model.bodies.clumps.empty()) return false;
    const Movers movers = movers_of(state, moving_force(ratio));
    return are_few(movers) &&
           movers.rest <= ratio * static_cast<double>(result_.end.bodies) * result_.end.mean_contact_force;
  }

  /// Cycles of the bodies that move, and of them alone, until they rest too.
  void settle_movers(double ratio) {
    if (!state_.model.bodies.clumps.empty()) return;  // see few_move
    const Stopwatch watch;
    const double force = moving_force(ratio);
    const std::int64_t end = result_.part_steps + most_part_steps;
    const auto go_on = [&] { return result_.part_steps < end && !given_up(); };
    for (Movers movers = movers_of(state_, force); are_few(movers) && go_on();
         movers = movers_of(state_, force)) {
      Part part(state_, movers.bodies);
      cycle::Cycle cycle(std::move(part.state()), policy());
      do {
        for (int k = 0; k < steps_between_looks && part.has_room(cycle.state()); ++k) {
          cycle.step();
          ++result_.part_steps;
        }
        interrupted_ = options_.interrupted && options_.interrupted();
      } while (!movers_of(cycle.state(), force).bodies.empty() && part.has_room(cycle.state()) && go_on());
      part.put_back(cycle.state(), state_);
    }
    halt(state_);
    result_.end = assembly::balance_of(state_);
    report(fmt::format("{} steps of a few that moved", grouped(result_.part_steps)));
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
      const NewtonResult found = newton(state_, wanted);
      ++result_.attempts;
      result_.newton_iterations += found.iterations;
      result_.linear_iterations += found.linear_iterations;
      result_.end = assembly::balance_of(state_);
      report(
          fmt::format("newton, {} iterations ({} linear){}", found.iterations, found.linear_iterations,
                      found.converged ? "" : fmt::format(", ended at {:.1e}: {}", found.ratio, found.why)));
      if (found.converged) note_method("newton");
      interrupted_ = options_.interrupted && options_.interrupted();
      if (found.converged || !found.unfinished || interrupted_) return found.converged;
    }
    return false;
  }

  void note_method(const std::string& name) {
    if (result_.method.find(name) == std::string::npos)
      result_.method += (result_.method.empty() ? "" : "+") + name;
  }

  State& state_;
  const RelaxOptions& options_;
  RelaxResult result_;
  bool interrupted_ = false;
};

}  // namespace

RelaxResult relax(State& state, const RelaxOptions& options) {
  state.ledger.reset();  // the way to an equilibrium is not one in time
  return Relaxation(state, options).run();
}

}  // namespace eigengrain::relaxation
