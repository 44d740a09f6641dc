#include "eigengrain/assembly/forces.hpp"

#include "eigengrain/assembly/dissipation.hpp"
#include "eigengrain/assembly/state.hpp"
#include "eigengrain/assembly/surroundings.hpp"
#include "eigengrain/base/assert.hpp"
#include "eigengrain/base/parallel.hpp"
#include "eigengrain/contact/facet_choice.hpp"
#include "eigengrain/contact/orientation.hpp"

#include "flat.hpp"

#include <algorithm>
#include <optional>
#include <type_traits>
#include <utility>

namespace eigengrain::assembly {
namespace {

/// A trial state with vectors of its own.
struct TrialState {
  TrialState(const Model& model, const Displacement& displacement) : moved(displacement) {
    position.reserve(model.bodies.position.size());
    for (std::size_t i = 0; i < model.bodies.position.size(); ++i)
      position.emplace_back(model.bodies.position[i] + displacement.translation[i]);
    orientation = turned_orientations(model.bodies, displacement.rotation);
  }
  Trial trial() const { return {position, moved.translation, moved.rotation, 1.0, orientation}; }

  const Displacement& moved;
  std::vector<Vec3> position;
  std::vector<Quat> orientation;
};

Displacement no_displacement(const Model& model) {
  return {std::vector<Vec3>(model.bodies.position.size(), Vec3::Zero()), {}};
}

template <class Group>
BondBreak break_of(const Group& group, std::size_t c, const model::Bodies& bodies,
                   const contact::Placement& placement, const contact::ContactGeometry& geometry,
                   std::optional<contact::BreakMode> mode) {
  EIGENGRAIN_ASSERT(mode.has_value());
  const auto a = static_cast<std::size_t>(group.pairs[c].a);
  const auto b = static_cast<std::size_t>(group.pairs[c].b);
  BondBreak found{.first = bodies.identity[a],
                  .second = bodies.identity[b],
                  .place = placement.position[a] + geometry.lever_a,
                  .normal = geometry.normal,
                  .mode = mode.value_or(contact::BreakMode::tension),
                  .rule = group.rule};
  return found;
}

/// Bodies of a chunk: few enough for the caches and for several threads, many enough that most contacts stay
/// inside. A function of the number of bodies alone.
std::int64_t chunk_of_bodies(std::int64_t bodies) {
  return std::clamp<std::int64_t>(bodies / 16, 128, 2048);
}

}  // namespace

std::vector<Quat> turned_orientations(const model::Bodies& bodies, std::span<const Vec3> rotation) {
  std::vector<Quat> result = bodies.orientation;
  if (!rotation.empty())
    for (std::size_t i = 0; i < result.size(); ++i) result[i] = contact::turned(result[i], rotation[i]);
  return result;
}

ContactForceSum::ContactForceSum(const Model& model, bool turns) : turns_(turns) {
  const std::int64_t bodies = model.bodies.size();
  chunk_size_ = chunk_of_bodies(bodies);
  const std::int64_t chunks = (bodies + chunk_size_ - 1) / chunk_size_;
  const auto elsewhere = [&](const contact::Pair& pair) {
    return pair.a / chunk_size_ != pair.b / chunk_size_;
  };

  foreign_starts_.assign(static_cast<std::size_t>(bodies) + 1, 0);
  model.contacts.for_each_group([&](const auto& group) {
    if constexpr (std::decay_t<decltype(group)>::KinematicsType::second_is_body)
      for (const contact::Pair& pair : group.pairs)
        if (elsewhere(pair)) ++foreign_starts_[static_cast<std::size_t>(pair.b) + 1];
  });
  for (std::size_t i = 0; i < static_cast<std::size_t>(bodies); ++i)
    foreign_starts_[i + 1] += foreign_starts_[i];
  foreign_force_.assign(static_cast<std::size_t>(foreign_starts_.back()), Vec3::Zero());
  if (turns_) foreign_moment_ = foreign_force_;

  std::vector<std::int32_t> next(foreign_starts_.begin(), foreign_starts_.end() - 1);
  model.contacts.for_each_group([&](const auto& group) {
    GroupPlan& plan = plans_.emplace_back();
    const auto& pairs = group.pairs;
    EIGENGRAIN_ASSERT(std::is_sorted(pairs.begin(), pairs.end(), [](auto l, auto r) { return l.a < r.a; }));
    for (std::int64_t chunk = 0; chunk <= chunks; ++chunk) {
      const auto first = std::partition_point(pairs.begin(), pairs.end(),
                                              [&](const auto& pair) { return pair.a < chunk * chunk_size_; });
      plan.starts.push_back(first - pairs.begin());
    }
    if constexpr (std::decay_t<decltype(group)>::KinematicsType::second_is_body)
      for (const contact::Pair& pair : pairs)
        plan.slot.push_back(elsewhere(pair) ? next[pair.b]++ : own_chunk);
  });
}

template <bool turns, bool commit, class Group>
void ContactForceSum::sum_group(const GroupPlan& plan, Group& group, const model::Bodies& bodies,
                                const contact::Placement& placement, const Trial& trial, BodyForces& sum) {
  using Kinematics = typename std::decay_t<Group>::KinematicsType;
  using ContactState = typename std::decay_t<Group>::State;
  using Law = typename std::decay_t<Group>::LawType;
  const auto contacts_of = [&](std::int64_t chunk) {
    for (std::int64_t index = plan.starts[chunk]; index < plan.starts[chunk + 1]; ++index) {
      const auto c = static_cast<std::size_t>(index);
      const contact::Pair& pair = group.pairs[c];
      const auto& old = group.states[c];
      const contact::ContactGeometry geometry = Kinematics::geometry(placement, pair);
      if (!group.law.acts(contact::at_rest(geometry), old)) {
        if constexpr (commit) group.states[c] = ContactState{};
        if constexpr (Kinematics::second_is_body)
          if (const std::int32_t slot = plan.slot[c]; slot != own_chunk) {
            foreign_force_[slot].setZero();
            if constexpr (turns) foreign_moment_[slot].setZero();
          }
        continue;
      }
      ContactState next;
      const auto motion = motion_in<Kinematics>(group.law, placement, trial, pair, geometry);
      const contact::ContactForce f = group.law.evaluate(motion, old, next);
      if constexpr (commit && contact::BondLaw<Law>)
        if (old.bonded() && !next.bonded())
          broken_in_chunk_[static_cast<std::size_t>(chunk)].push_back(
              break_of(group, c, bodies, placement, geometry, group.law.failure(motion, old)));
      if constexpr (commit) group.states[c] = next;
      const contact::EndForces ends = contact::end_forces(geometry, f);
      sum.force[pair.a] += ends.force_a;
      if constexpr (turns) sum.moment[pair.a] += ends.moment_a;
      if constexpr (Kinematics::second_is_body) {
        const std::int32_t slot = plan.slot[c];
        if (slot == own_chunk) {
          sum.force[pair.b] += ends.force_b;
          if constexpr (turns) sum.moment[pair.b] += ends.moment_b;
        } else {
          foreign_force_[slot] = ends.force_b;
          if constexpr (turns) foreign_moment_[slot] = ends.moment_b;
        }
      }
    }
  };
  if constexpr (commit && contact::BondLaw<Law>) broken_in_chunk_.resize(plan.starts.size());
  // The cycle's contacts of balls, which are nearly all there are, in one flat piece.
  if constexpr (commit && Kinematics::second_is_body)
    for_chunks(std::ssize(sum.force), chunk_size_,
               [&](std::int64_t, std::int64_t, std::int64_t chunk) EIGENGRAIN_FLAT { contacts_of(chunk); });
  else
    for_chunks(std::ssize(sum.force), chunk_size_,
               [&](std::int64_t, std::int64_t, std::int64_t chunk) { contacts_of(chunk); });
  if constexpr (commit && contact::BondLaw<Law>)
    for (std::vector<BondBreak>& chunk : broken_in_chunk_) {
      broken_.insert(broken_.end(), chunk.begin(), chunk.end());
      chunk.clear();
    }
}

template <bool turns, bool commit, class ModelRef>
void ContactForceSum::sum_groups(ModelRef& model, const Trial& trial, BodyForces& sum) {
  EIGENGRAIN_ASSERT(plans_.size() == model.contacts.groups.size(), plans_.size());
  const auto bodies = static_cast<std::size_t>(model.bodies.size());
  sum.force.assign(bodies, Vec3::Zero());
  sum.moment.assign(turns ? bodies : 0, Vec3::Zero());
  if constexpr (commit) broken_.clear();
  const contact::Placement placement = placement_in(model, trial);
  auto plan = plans_.begin();
  model.contacts.for_each_group(
      [&](auto& group) { sum_group<turns, commit>(*plan++, group, model.bodies, placement, trial, sum); });
  add_foreign(sum);
}

void ContactForceSum::add_foreign(BodyForces& sum) const {
  for_each_index(std::ssize(sum.force), [&](std::int64_t index) {
    const auto body = static_cast<std::size_t>(index);
    for (std::int32_t slot = foreign_starts_[body]; slot < foreign_starts_[body + 1]; ++slot) {
      sum.force[body] += foreign_force_[slot];
      if (turns_) sum.moment[body] += foreign_moment_[slot];
    }
  });
}

void ContactForceSum::evaluate(const Model& model, const Trial& trial, BodyForces& sum) {
  if (turns_)
    sum_groups<true, false>(model, trial, sum);
  else
    sum_groups<false, false>(model, trial, sum);
}

void ContactForceSum::follow_facets(Model& model, const contact::Placement& placement) const {
  auto plan = plans_.begin();
  model.contacts.for_each_group([&](auto& group) {
    const GroupPlan& of_group = *plan++;
    if constexpr (std::is_same_v<typename std::decay_t<decltype(group)>::KinematicsType, contact::BallFacet>)
      for_chunks(model.bodies.size(), chunk_size_, [&](std::int64_t, std::int64_t, std::int64_t chunk) {
        contact::follow_facets(placement, group, static_cast<std::size_t>(of_group.starts[chunk]),
                               static_cast<std::size_t>(of_group.starts[chunk + 1]));
      });
  });
}

void ContactForceSum::advance(Model& model, const Trial& trial, BodyForces& sum,
                              contact::Dissipation* dissipated) {
  try {
    const contact::Placement placement = placement_in(model, trial);
    follow_facets(model, placement);
    if (dissipated != nullptr) *dissipated += dissipation_in(model, placement, trial);
    if (turns_)
      sum_groups<true, true>(model, trial, sum);
    else
      sum_groups<false, true>(model, trial, sum);
  } catch (const contact::CentreOnFacet& found) {
    throw centre_on_facet(model, found);
  }
}

void renew_forces(State& state) {
  const model::Bodies& bodies = state.model.bodies;
  BodyForces sum;
  ContactForceSum contacts(state.model, state.turns());
  contacts.advance(state.model, {bodies.position, bodies.velocity, bodies.spin, 0.0, bodies.orientation},
                   sum);
  note_breaks(state, contacts.broken());
  state.force = std::move(sum.force);
  state.moment = std::move(sum.moment);
}

BodyForces contact_forces(const Model& model, const Displacement& displacement) {
  const TrialState state(model, displacement);
  BodyForces sum;
  ContactForceSum(model, true).evaluate(model, state.trial(), sum);
  return sum;
}

BodyForces contact_forces(const Model& model) {
  return contact_forces(model, no_displacement(model));
}

double elastic_energy(const Model& model, const Displacement& displacement) {
  constexpr std::int64_t chunk_size = 4096;
  const TrialState state(model, displacement);
  const Trial trial = state.trial();
  const contact::Placement placement = model.placement(trial.position, trial.orientation);
  double energy = 0;
  model.contacts.for_each_group([&](const auto& group) {
    using Kinematics = typename std::decay_t<decltype(group)>::KinematicsType;
    std::vector<double> parts(static_cast<std::size_t>((group.size() + chunk_size - 1) / chunk_size), 0.0);
    for_chunks(group.size(), chunk_size, [&](std::int64_t begin, std::int64_t end, std::int64_t chunk) {
      for (auto c = static_cast<std::size_t>(begin); c < static_cast<std::size_t>(end); ++c) {
        const contact::Pair& pair = group.pairs[c];
        const contact::ContactGeometry geometry = Kinematics::geometry(placement, pair);
        parts[chunk] += group.law.energy(motion_in<Kinematics>(group.law, placement, trial, pair, geometry),
                                         group.states[c]);
      }
    });
    for (const double part : parts) energy += part;
  });
  return energy;
}

double elastic_energy(const Model& model) {
  return elastic_energy(model, no_displacement(model));
}

std::vector<WallLoad> wall_loads(const Model& model) {
  std::vector<WallLoad> loads(model.wall_count());
  const contact::Placement placement = model.placement();
  model.contacts.for_each_group([&](const auto& group) {
    using Group = std::decay_t<decltype(group)>;
    using Kinematics = typename Group::KinematicsType;
    if constexpr (!Kinematics::second_is_body) {
      for (std::size_t c = 0; c < group.pairs.size(); ++c) {
        const contact::Pair& pair = group.pairs[c];
        const contact::ContactGeometry geometry = Kinematics::geometry(placement, pair);
        const contact::EndForces ends = contact::end_forces(
            geometry, contact::force_now(group.law, placement, pair, geometry, group.states[c]));
        WallLoad& load = loads[static_cast<std::size_t>(Kinematics::wall(placement, pair))];
        load.force += ends.force_b;
        load.moment += ends.moment_b;
      }
    }
  });
  return loads;
}

std::vector<Vec3> wall_forces(const Model& model) {
  std::vector<Vec3> forces;
  for (const WallLoad& load : wall_loads(model)) forces.push_back(load.force);
  return forces;
}

}  // namespace eigengrain::assembly
