#include "tracked_step.hpp"

#include "eigengrain/assembly/local_damping.hpp"
#include "eigengrain/assembly/within_rooms.hpp"
#include "eigengrain/cycle/step_prover.hpp"

#include "first_contact.hpp"
#include "proven_step.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <memory>
#include <numeric>
#include <span>
#include <vector>

namespace eigengrain::cycle {
namespace {

using assembly::State;
using assembly::StepGuard;

/// Room of a body at rest over the mean radius. It costs what pairs count that are as near, and few are.
constexpr double room_at_rest = 3e-4;
/// A body that moves has the room for so many steps at twice its speed on top, or for this part
/// of what the list lasts: with more room its contacts may turn so far that the step suffers, with less no
/// proof lasts.
constexpr double steps_of_room = 200;
constexpr double part_of_list = 0.2;

/// Together with bodies that leave their rooms those get others that are more than half of the way there, so
/// that they do not ask one after the other. Where more than this part of all does, all get others.
constexpr double near_the_end = 0.5;
constexpr double most_to_renew = 0.125;

/// When the contacts have become others the step is proven again, or, failing that, less of it. Proofs that
/// fail are the dear ones.
constexpr std::array fewer{0.985, 0.95, 0.88};
constexpr double more = 1.01;
constexpr int most_at_once = 4;
/// Proofs of all between tries of a larger step: four times as many after one that failed.
constexpr std::int64_t shortest_pause = 4;
constexpr std::int64_t longest_pause = 64;
/// Where the block bound has risen by more than this, so that a proof from scratch should give more.
constexpr double worth_a_new_proof = 1.02;
/// What holds exactly must not fail by rounding when it is proven once more.
constexpr double beyond_rounding = 1e-9;
/// A proof from scratch is content when steps larger by this can no more be proven.
constexpr double content = 1.02;

/// What bodies and walls may travel until they leave their rooms.
class Rooms {
 public:
  explicit Rooms(const State& state) : state_(state) {
    const model::Bodies& bodies = state.model.bodies;
    const double mean = std::accumulate(bodies.radius.begin(), bodies.radius.end(), 0.0) /
                        static_cast<double>(bodies.radius.size());
    at_rest_ = room_at_rest * mean;
    double fastest = 0;
    for (const Vec3& v : bodies.velocity) fastest = std::max(fastest, v.norm());
    const double dt = state.next_dt > 0 ? state.next_dt : state.dt;
    const double list_lasts = fastest > 0 ? 0.5 * state.list.skin / fastest : 0;
    duration_ = std::min(steps_of_room * dt, part_of_list * list_lasts);
  }

  double of_body(std::size_t row) const {
    const model::Bodies& bodies = state_.model.bodies;
    const double way = (bodies.position[row] - state_.list.position[row]).norm();
    return at_most(0.5 * state_.list.skin - state_.list.growth - way, bodies.velocity[row].norm());
  }

  double of_walls() const {
    const std::vector<model::WallMotion>& motions = state_.model.wall_motions;
    if (motions.empty()) return 0;
    double speed = 0;
    for (std::size_t m = 0; m < motions.size(); ++m) {
      const model::WallVelocity velocity = motions[m].at(state_.time);
      const double servo = motions[m].servo ? motions[m].servo->max_speed : 0.0;
      speed = std::max(
          speed, velocity.translation.norm() + state_.list.wall_lever[m] * velocity.spin.norm() + servo);
    }
    return at_most(0.5 * state_.list.skin - state_.list.growth - state_.list.wall_way, speed);
  }

 private:
  double at_most(double left, double speed) const {
    return std::clamp(at_rest_ + 2 * speed * duration_, 0.0, std::max(0.0, left));
  }

  const State& state_;
  double at_rest_;   ///< m
  double duration_;  ///< s
};

/// Whether proofs of this kind are made here.
bool can_track(const State& state) {
  const model::Bodies& bodies = state.model.bodies;
  return !state.model.cell.deforms() && state.model.surfaces.empty() &&
         state.list.position.size() == bodies.position.size() &&
         !model::radii_change(bodies, state.time, std::numeric_limits<double>::infinity());
}

/// Whether single bodies of a state can be given other rooms.
bool some_can_be_renewed(const State& state, std::int64_t every) {
  // A list is new while all are where they were when it was made; who is asked then proves all anew.
  const bool new_list = state.model.bodies.position == state.list.position;
  return state.guard && !new_list && state.step - state.guard->step < every && can_track(state) &&
         assembly::WithinRooms::can_move(state.model);
}

std::vector<std::int32_t> bodies_near_the_end(const State& state) {
  std::vector<std::int32_t> found;
  const std::vector<Vec3>& position = state.model.bodies.position;
  for (std::size_t i = 0; i < position.size(); ++i) {
    const double way = near_the_end * state.guard->room[i];
    if (!((position[i] - state.guard->position[i]).squaredNorm() <= way * way))
      found.push_back(static_cast<std::int32_t>(i));
  }
  return found;
}

void prove_from_scratch(StepProver& prover, StepGuard& guard) {
  prover.set_weights(std::vector<double>(prover.weights().size(), 1.0));
  const double bound = prover.bound();
  guard.dt = (1 - beyond_rounding) * prover.sharpen(std::numeric_limits<double>::infinity(), content);
  guard.gain = std::isfinite(guard.dt) ? guard.dt / bound : 1.0;
}

/// Tries to prove more than `guard.dt`, which the prover's weights prove.
void try_more(StepProver& prover, StepGuard& guard) {
  const double before = guard.dt;
  std::vector<double> weights = prover.weights();
  prover.set_weights(std::vector<double>(weights.size(), 1.0));
  if (guard.gain * prover.bound() > worth_a_new_proof * before) prove_from_scratch(prover, guard);
  if (!(guard.dt > before)) {
    guard.dt = before;
    prover.set_weights(std::move(weights));
    for (int tries = 0; tries < most_at_once && prover.prove(more * guard.dt); ++tries) guard.dt *= more;
  }
  guard.last_pause = guard.dt > before ? shortest_pause : std::min(longest_pause, 4 * guard.last_pause);
  guard.pause = guard.last_pause;
}

/// Proves the step of before once more, or less, or from scratch.
void prove_again(StepProver& prover, StepGuard& guard) {
  const double before = guard.dt;
  if (prover.prove(before)) {
    if (--guard.pause <= 0) try_more(prover, guard);
    return;
  }
  for (const double part : fewer)
    if (prover.prove(part * before)) {
      guard.dt = part * before;
      return;
    }
  prove_from_scratch(prover, guard);
}

/// The α of a body with which its block counts for what it can grow by.
double counted_damping(double local_damping, double growth) {
  return (1 + local_damping) * growth - 1;
}

std::vector<double> counted_damping(double local_damping, const std::vector<double>& growth) {
  std::vector<double> result;
  result.reserve(growth.size());
  for (const double by : growth) result.push_back(counted_damping(local_damping, by));
  return result;
}

}  // namespace

struct StepTracker::Standing {
  Standing(const State& state, const StepGuard& guard)
      : damping(assembly::largest_damping(state.model)),
        contacts(state.model, guard.position, guard.room, guard.wall_way - state.list.wall_way),
        prover(contacts.system(), counted_damping(damping, contacts.growth())) {
    if (guard.weight.size() == guard.room.size()) prover.set_weights(guard.weight);
  }

  /// Whether it is what a guard was proven with.
  bool is_of(const StepGuard& guard) const {
    return contacts.room() == guard.room && contacts.position() == guard.position &&
           prover.weights() == guard.weight;
  }

  void move(const State& state, std::span<const std::int32_t> bodies, const StepGuard& guard) {
    const std::vector<std::int32_t> changed = contacts.move(state.model, bodies, guard.position, guard.room);
    for (const std::int32_t contact : changed) {
      const contact::ContactElement& element = contacts.system().elements[static_cast<std::size_t>(contact)];
      for (const std::int32_t body : {element.a, element.b})
        if (body != contact::no_body)
          prover.set_damping(body,
                             counted_damping(damping, contacts.growth()[static_cast<std::size_t>(body)]));
    }
    prover.update(changed);
  }

  double damping;  ///< α
  assembly::WithinRooms contacts;
  StepProver prover;
};

StepTracker::StepTracker(std::int64_t every) : every_(every) {}
StepTracker::~StepTracker() = default;

void StepTracker::forget() {
  standing_.reset();
}

std::optional<StepGuard> StepTracker::prove(const State& state) {
  forget();
  if (!can_track(state)) return std::nullopt;
  StepGuard guard;
  guard.step = state.step;
  const Rooms rooms(state);
  guard.position = state.model.bodies.position;
  guard.room.resize(guard.position.size());
  for (std::size_t i = 0; i < guard.room.size(); ++i) guard.room[i] = rooms.of_body(i);
  guard.wall_way = state.list.wall_way + rooms.of_walls();
  const bool known = state.guard && state.guard->weight.size() == guard.room.size();
  if (known) {
    guard.dt = state.guard->dt;
    guard.gain = state.guard->gain;
    guard.pause = state.guard->pause;
    guard.last_pause = state.guard->last_pause;
    guard.weight = state.guard->weight;
  }
  standing_ = std::make_unique<Standing>(state, guard);
  StepProver& prover = standing_->prover;
  if (known) {
    prove_again(prover, guard);
  } else {
    prove_from_scratch(prover, guard);
    guard.pause = guard.last_pause = shortest_pause;
  }
  // Nothing can touch within the rooms: what comes after is as good as known.
  if (!std::isfinite(guard.dt)) guard.dt = proven_step(state, stiffness_varies(state.settings));
  if (!std::isfinite(guard.dt)) return std::nullopt;
  guard.weight = prover.weights();
  return guard;
}

bool StepTracker::renew_some(const State& state, StepGuard& guard) {
  const std::vector<std::int32_t> bodies = bodies_near_the_end(state);
  if (static_cast<double>(bodies.size()) > most_to_renew * static_cast<double>(guard.room.size()))
    return false;
  if (!standing_ || !standing_->is_of(guard)) standing_ = std::make_unique<Standing>(state, guard);
  const Rooms rooms(state);
  for (const std::int32_t body : bodies) {
    const auto row = static_cast<std::size_t>(body);
    guard.position[row] = state.model.bodies.position[row];
    guard.room[row] = rooms.of_body(row);
  }
  standing_->move(state, bodies, guard);
  if (!standing_->prover.prove(guard.dt)) return false;
  guard.weight = standing_->prover.weights();
  return true;
}

void StepTracker::renew(State& state) {
  if (!(some_can_be_renewed(state, every_) && renew_some(state, *state.guard))) state.guard = prove(state);
}

}  // namespace eigengrain::cycle
