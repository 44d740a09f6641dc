#include "part.hpp"

#include "eigengrain/assembly/body_size.hpp"
#include "eigengrain/assembly/clump_members.hpp"
#include "eigengrain/assembly/contact_list.hpp"
#include "eigengrain/assembly/forces.hpp"
#include "eigengrain/assembly/loads.hpp"

#include <algorithm>
#include <type_traits>
#include <utility>

namespace eigengrain::relaxation {
namespace {

using assembly::Model;
using assembly::State;

/// Bodies may go this part of the width of a ring before the part is made anew: what is left over is for the
/// way between two looks.
constexpr double room_of_ring = 0.5;

constexpr model::FixedComponents held(63);

/// Marks all balls of the clumps that have a marked one.
void spread_over_clumps(const model::Clumps& clumps, std::vector<char>& marked) {
  for (std::int32_t c = 0; c < clumps.size(); ++c) {
    const std::span<const std::int32_t> balls = clumps.members(c);
    if (std::none_of(balls.begin(), balls.end(), [&](std::int32_t ball) { return marked[ball] != 0; }))
      continue;
    for (const std::int32_t ball : balls) marked[ball] = 1;
  }
}

/// Marks the bodies that share a listed pair with a marked one.
void add_ring(const Model& model, std::vector<char>& marked) {
  const std::vector<char> before = marked;
  model.contacts.for_each_group([&](const auto& group) {
    if constexpr (std::decay_t<decltype(group)>::KinematicsType::second_is_body)
      for (const contact::Pair& pair : group.pairs) {
        if (before[pair.a] != 0) marked[pair.b] = 1;
        if (before[pair.b] != 0) marked[pair.a] = 1;
      }
  });
  spread_over_clumps(model.bodies.clumps, marked);
}

/// The clumps chosen, in their order; row_of says where the rows of their balls are now.
model::Clumps clumps_of(const model::Clumps& from, std::span<const std::int32_t> chosen,
                        std::span<const std::int32_t> row_of, std::size_t rows) {
  model::Clumps part;
  if (chosen.empty()) return part;
  part.of_row.assign(rows, model::Clumps::none);
  for (const std::int32_t clump : chosen) {
    const auto c = static_cast<std::size_t>(clump);
    part.identity.push_back(from.identity[c]);
    part.mass.push_back(from.mass[c]);
    part.volume.push_back(from.volume[c]);
    part.radius.push_back(from.radius[c]);
    part.inertia.push_back(from.inertia[c]);
    part.position.push_back(from.position[c]);
    part.orientation.push_back(from.orientation[c]);
    part.velocity.push_back(from.velocity[c]);
    part.angular_momentum.push_back(from.angular_momentum[c]);
    part.spin.push_back(from.spin[c]);
    for (std::int32_t m = from.starts[c]; m < from.starts[c + 1]; ++m) {
      const std::int32_t row = row_of[from.member[m]];
      part.member.push_back(row);
      part.place.push_back(from.place[m]);
      part.of_row[row] = part.size() - 1;
    }
    part.starts.push_back(static_cast<std::int32_t>(part.member.size()));
  }
  return part;
}

/// Forces and moments of contacts on bodies, of clumps in the rows of their holders.
assembly::BodyForces forces_on_bodies(const State& state) {
  assembly::BodyForces forces{state.force, state.moment};
  if (!state.model.bodies.clumps.empty()) assembly::gather_members(state.model.bodies, {}, forces);
  return forces;
}

template <class Group>
bool touches(const contact::Pair& pair, const std::vector<char>& marked) {
  if constexpr (Group::KinematicsType::second_is_body)
    if (marked[pair.b] != 0) return true;
  return marked[pair.a] != 0;
}

/// Appends the contacts of `from` that hold on to a marked body, with rows renumbered.
template <class Group>
void append(const Group& from, const std::vector<char>& marked, std::span<const std::int32_t> row_of,
            Group& to) {
  for (std::size_t c = 0; c < from.pairs.size(); ++c) {
    contact::Pair pair = from.pairs[c];
    if (!touches<Group>(pair, marked)) continue;
    pair.a = row_of[pair.a];
    if constexpr (Group::KinematicsType::second_is_body) pair.b = row_of[pair.b];
    to.pairs.push_back(pair);
    to.states.push_back(from.states[c]);
  }
}

template <class Group>
void erase(Group& group, const std::vector<char>& marked) {
  std::size_t kept = 0;
  for (std::size_t c = 0; c < group.pairs.size(); ++c) {
    if (touches<Group>(group.pairs[c], marked)) continue;
    group.pairs[kept] = group.pairs[c];
    group.states[kept++] = group.states[c];
  }
  group.pairs.resize(kept);
  group.states.resize(kept);
}

/// The group of the same kind and rule, made where there is none.
template <class Group>
Group& matching(contact::Contacts& contacts, const Group& like) {
  for (contact::AnyGroup& candidate : contacts.groups)
    if (auto* group = std::get_if<Group>(&candidate); group != nullptr && group->rule == like.rule)
      return *group;
  return std::get<Group>(contacts.groups.emplace_back(Group{like.law, like.rule, {}, {}}));
}

double mean_radius(const model::Bodies& bodies, std::span<const std::int32_t> rows) {
  double sum = 0;
  for (const std::int32_t row : rows) sum += bodies.radius[row];
  return sum / static_cast<double>(rows.size());
}

}  // namespace

Movers movers_of(const State& state, double force) {
  const model::Bodies& bodies = state.model.bodies;
  const assembly::BodyForces forces = forces_on_bodies(state);
  Movers movers;
  double pushes = 0;
  double turns = 0;
  for (std::int32_t body = 0; body < bodies.size(); ++body) {
    if (bodies.clumps.owner(body) != body) continue;
    const auto i = static_cast<std::size_t>(body);
    const model::FixedComponents fixed = bodies.fixed[i];
    const double push =
        model::free_part(forces.force[i] + assembly::load_on(state.model, i), fixed.translation()).norm();
    const Vec3 moment =
        state.turns() ? Vec3(forces.moment[i] + assembly::moment_on(state.model, i)) : Vec3(Vec3::Zero());
    const double turn = model::free_part(moment, fixed.rotation()).norm() / assembly::size_of(bodies, body);
    // Nothing touches a body without any force, and loads take it along, however light it is.
    const bool falls = (push > 0 || turn > 0) && forces.force[i].isZero(0);
    if (falls || std::max(push, turn) > force) {
      movers.bodies.push_back(body);
      movers.moving += std::max(push, turn);
    } else {
      pushes += push;
      turns += turn;
    }
  }
  movers.rest = std::max(pushes, turns);
  return movers;
}

Part::Part(State& whole, std::span<const std::int32_t> movers) {
  const double ring = mean_radius(whole.model.bodies, movers);
  room_ = room_of_ring * ring;
  assembly::renew_list(whole, ring);

  const auto count = static_cast<std::size_t>(whole.model.bodies.size());
  std::vector<char> free(count, 0);
  for (const std::int32_t mover : movers) free[mover] = 1;
  spread_over_clumps(whole.model.bodies.clumps, free);
  add_ring(whole.model, free);
  std::vector<char> chosen = free;
  add_ring(whole.model, chosen);
  std::vector<std::int32_t> row_of(count, -1);
  for (std::size_t i = 0; i < count; ++i) {
    if (chosen[i] == 0) continue;
    row_of[i] = static_cast<std::int32_t>(bodies_.size());
    bodies_.push_back(static_cast<std::int32_t>(i));
    free_.push_back(free[i]);
  }

  const model::Clumps& clumps = whole.model.bodies.clumps;
  for (std::int32_t c = 0; c < clumps.size(); ++c)
    if (chosen[clumps.holder(c)] != 0) clumps_.push_back(c);

  state_.settings = whole.settings;
  // All of the model but what grows with the packing.
  model::Bodies bodies = std::exchange(whole.model.bodies, {});
  contact::Contacts contacts = std::exchange(whole.model.contacts, {});
  state_.model = whole.model;
  whole.model.bodies = std::move(bodies);
  whole.model.contacts = std::move(contacts);
  model::Clumps all_clumps = std::exchange(whole.model.bodies.clumps, {});
  state_.model.wall_motions.clear();  // a part bears none of what servo walls push with
  state_.model.wall_poses.clear();
  state_.model.bodies = model::reordered(whole.model.bodies, bodies_);
  whole.model.bodies.clumps = std::move(all_clumps);
  state_.model.bodies.clumps = clumps_of(whole.model.bodies.clumps, clumps_, row_of, bodies_.size());
  whole.model.contacts.for_each_group(
      [&](const auto& group) { append(group, free, row_of, matching(state_.model.contacts, group)); });
  for (std::size_t k = 0; k < bodies_.size(); ++k) {
    state_.force.push_back(whole.force[bodies_[k]]);
    if (whole.turns()) state_.moment.push_back(whole.moment[bodies_[k]]);
    if (free_[k] != 0) continue;
    // A fixed body keeps its velocity, and one that was free in another part has some.
    state_.model.bodies.fixed[k] = held;
    state_.model.bodies.velocity[k].setZero();
    if (whole.turns()) state_.model.bodies.spin[k].setZero();
  }
  model::Clumps& held_clumps = state_.model.bodies.clumps;
  for (std::int32_t c = 0; c < held_clumps.size(); ++c) {
    if (free_[held_clumps.holder(c)] != 0) continue;
    held_clumps.velocity[c].setZero();
    held_clumps.spin[c].setZero();
    held_clumps.angular_momentum[c].setZero();
  }
  position_ = state_.model.bodies.position;
  state_.list.skin = whole.list.skin;
}

bool Part::has_room(const State& state) const {
  for (std::size_t k = 0; k < bodies_.size(); ++k)
    if (!((state.model.bodies.position[k] - position_[k]).squaredNorm() <= room_ * room_)) return false;
  return true;
}

void Part::put_back(const State& part, State& whole) const {
  std::vector<char> free(static_cast<std::size_t>(whole.model.bodies.size()), 0);
  model::Bodies& bodies = whole.model.bodies;
  for (std::size_t k = 0; k < bodies_.size(); ++k) {
    if (free_[k] == 0) continue;
    const std::int32_t row = bodies_[k];
    free[row] = 1;
    bodies.position[row] = part.model.bodies.position[k];
    bodies.velocity[row] = part.model.bodies.velocity[k];
    if (whole.turns()) bodies.spin[row] = part.model.bodies.spin[k];
    if (!bodies.orientation.empty()) bodies.orientation[row] = part.model.bodies.orientation[k];
  }
  for (std::size_t k = 0; k < clumps_.size(); ++k) {
    const model::Clumps& from = part.model.bodies.clumps;
    if (free_[from.holder(static_cast<std::int32_t>(k))] == 0) continue;
    const std::int32_t c = clumps_[k];
    bodies.clumps.position[c] = from.position[k];
    bodies.clumps.orientation[c] = from.orientation[k];
    bodies.clumps.velocity[c] = from.velocity[k];
    bodies.clumps.angular_momentum[c] = from.angular_momentum[k];
    bodies.clumps.spin[c] = from.spin[k];
  }
  whole.model.contacts.for_each_group([&](auto& group) { erase(group, free); });
  part.model.contacts.for_each_group(
      [&](const auto& group) { append(group, free_, bodies_, matching(whole.model.contacts, group)); });
  assembly::renew_list(whole, whole.list.skin);
  assembly::note_breaks(whole, part.breaks);
  assembly::renew_forces(whole);
}

}  // namespace eigengrain::relaxation
