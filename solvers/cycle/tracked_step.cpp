#include "tracked_step.hpp"

#include "eigengrain/assembly/linear_system.hpp"
#include "eigengrain/assembly/local_damping.hpp"
#include "eigengrain/cycle/step_prover.hpp"

#include "proven_step.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numeric>
#include <vector>

namespace eigengrain::cycle {
namespace {

using assembly::State;
using assembly::StepGuard;

/// Room of a body at rest over the mean radius: at first, and the least. It is doubled where a proof does not
/// last, and reduced where it does.
constexpr double first_reach = 3e-4;
constexpr double least_reach = 1e-4;
constexpr double reduction = 0.7;
constexpr std::int64_t too_short = 20;    // steps
constexpr std::int64_t long_enough = 60;  // steps
/// A body that moves has the room for so many steps at twice its speed on top.
constexpr double steps_of_room = 200;

/// When the contacts have become others the step is proven again, or, failing that, less of it.
constexpr std::array fewer{0.995, 0.985, 0.97, 0.95, 0.92, 0.88};
constexpr double more = 1.01;
constexpr int most_at_once = 4;
/// Every so many proofs a larger step is tried, but after tries that failed four times as rarely each time.
constexpr std::int64_t proofs_between_tries = 4;
constexpr std::int64_t longest_pause = 16;
/// Where the block bound has risen by more than this, so that a proof from scratch should give more.
constexpr double worth_a_new_proof = 1.02;
/// A proof from scratch is content when steps larger by this can no more be proven.
constexpr double content = 1.015;

double reach_of(const State& state) {
  const std::vector<double>& radius = state.model.bodies.radius;
  const double mean = std::accumulate(radius.begin(), radius.end(), 0.0) / static_cast<double>(radius.size());
  if (!state.guard) return first_reach * mean;
  const std::int64_t lasted = state.step - state.guard->step;
  double reach = state.guard->reach;
  if (lasted < too_short) reach *= 2;
  if (lasted >= long_enough) reach *= reduction;
  return std::clamp(reach, least_reach * mean, std::max(0.5 * state.list.skin, least_reach * mean));
}

/// How far the walls may move within the next steps, m.
double wall_room(const State& state, double reach, double dt) {
  double speed = 0;
  const std::vector<model::WallMotion>& motions = state.model.wall_motions;
  if (motions.empty()) return 0;
  for (std::size_t m = 0; m < motions.size(); ++m) {
    const model::WallVelocity velocity = motions[m].at(state.time);
    const double servo = motions[m].servo ? motions[m].servo->max_speed : 0.0;
    speed = std::max(speed,
                     velocity.translation.norm() + state.list.wall_lever[m] * velocity.spin.norm() + servo);
  }
  return std::min(reach + 2 * speed * steps_of_room * dt, 0.5 * state.list.skin - state.list.wall_way);
}

void make_room(const State& state, StepGuard& guard) {
  const model::Bodies& bodies = state.model.bodies;
  const double dt = state.next_dt > 0 ? state.next_dt : state.dt;
  guard.position = bodies.position;
  guard.room.resize(bodies.position.size());
  for (std::size_t i = 0; i < guard.room.size(); ++i) {
    const double wished = guard.reach + 2 * bodies.velocity[i].norm() * steps_of_room * dt;
    const double way = (bodies.position[i] - state.list.position[i]).norm();
    guard.room[i] = std::max(0.0, std::min(wished, 0.5 * state.list.skin - way));
  }
  guard.wall_way = state.list.wall_way + std::max(0.0, wall_room(state, guard.reach, dt));
}

/// Whether proofs of this kind are made here.
bool can_track(const State& state) {
  const model::Bodies& bodies = state.model.bodies;
  return !state.model.cell.deforms() && state.model.surfaces.empty() && state.model.contacts.size() > 0 &&
         state.list.position.size() == bodies.position.size() &&
         !model::radii_change(bodies, state.time, std::numeric_limits<double>::infinity());
}

void prove_from_scratch(StepProver& prover, StepGuard& guard) {
  prover.set_weights(std::vector<double>(prover.weights().size(), 1.0));
  const double bound = prover.bound();
  guard.dt = prover.sharpen(std::numeric_limits<double>::infinity(), content);
  guard.gain = guard.dt / bound;
}

/// Tries to prove more than `guard.dt`, which the prover's weights prove.
void try_more(StepProver& prover, StepGuard& guard) {
  const double before = guard.dt;
  std::vector<double> weights = prover.weights();
  prover.set_weights(std::vector<double>(weights.size(), 1.0));
  if (guard.gain * prover.bound() > worth_a_new_proof * before) {
    prove_from_scratch(prover, guard);
    guard.pause = guard.last_pause = 1;
    if (guard.dt > before) return;
    guard.dt = before;
  }
  prover.set_weights(std::move(weights));
  if (--guard.pause > 0) return;
  for (int tries = 0; tries < most_at_once && prover.prove(more * guard.dt); ++tries) guard.dt *= more;
  guard.last_pause = guard.dt > before ? 1 : std::min(longest_pause, 4 * guard.last_pause);
  guard.pause = guard.last_pause;
}

/// Proves the step of before once more, or less, or from scratch.
void prove_again(StepProver& prover, StepGuard& guard) {
  const double before = guard.dt;
  if (prover.prove(before)) {
    if (guard.proofs % proofs_between_tries == 0) try_more(prover, guard);
    return;
  }
  for (const double part : fewer)
    if (prover.prove(part * before)) {
      guard.dt = part * before;
      return;
    }
  prove_from_scratch(prover, guard);
}

}  // namespace

std::optional<StepGuard> track_step(const State& state) {
  if (!can_track(state)) return std::nullopt;
  StepGuard guard;
  guard.step = state.step;
  guard.reach = reach_of(state);
  make_room(state, guard);
  const assembly::LinearSystem system(
      state.model, assembly::WithinRooms{state.model, guard.room, guard.wall_way - state.list.wall_way});
  StepProver prover(system, alike(assembly::largest_damping(state.model), system));
  if (state.guard && state.guard->weight.size() == guard.room.size()) {
    guard.dt = state.guard->dt;
    guard.gain = state.guard->gain;
    guard.proofs = state.guard->proofs + 1;
    guard.pause = state.guard->pause;
    guard.last_pause = state.guard->last_pause;
    prover.set_weights(state.guard->weight);
    prove_again(prover, guard);
  } else {
    prove_from_scratch(prover, guard);
  }
  if (!std::isfinite(guard.dt)) return std::nullopt;
  guard.weight = prover.weights();
  return guard;
}

}  // namespace eigengrain::cycle
