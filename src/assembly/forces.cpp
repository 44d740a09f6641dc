#include "eigengrain/assembly/forces.hpp"

#include "eigengrain/base/assert.hpp"
#include "eigengrain/base/parallel.hpp"

#include <algorithm>

namespace eigengrain::assembly {
namespace {

/// A trial state with vectors of its own.
struct TrialState {
  TrialState(const Model& model, const Displacement& displacement) : moved(displacement) {
    position.reserve(model.bodies.position.size());
    for (std::size_t i = 0; i < model.bodies.position.size(); ++i)
      position.emplace_back(model.bodies.position[i] + displacement.translation[i]);
  }
  Trial trial() const { return {position, moved.translation, moved.rotation, 1.0}; }

  const Displacement& moved;
  std::vector<Vec3> position;
};

Displacement no_displacement(const Model& model) {
  return {std::vector<Vec3>(model.bodies.position.size(), Vec3::Zero()), {}};
}

/// Bodies of a chunk: few enough for the caches and for several threads, many enough that most contacts stay
/// inside. A function of the number of bodies alone.
std::int64_t chunk_of_bodies(std::int64_t bodies) {
  return std::clamp<std::int64_t>(bodies / 16, 128, 2048);
}

/// Nobody looks.
struct Unobserved {
  static constexpr bool looks = false;
};

/// Adds up what contacts dissipate, in the order of the contacts in a chunk and of the chunks.
class DissipationObserver {
 public:
  static constexpr bool looks = true;

  explicit DissipationObserver(std::int64_t chunks) : of_chunk_(static_cast<std::size_t>(chunks)) {}

  template <class Law>
  void see(std::int64_t chunk, const Law& law, const contact::ContactMotion& motion,
           const typename Law::State& old, const typename Law::State& next) {
    if constexpr (contact::DissipativeLaw<Law>) of_chunk_[chunk] += law.dissipation(motion, old, next);
  }
  contact::Dissipation total() const {
    contact::Dissipation sum;
    for (const contact::Dissipation& part : of_chunk_) sum += part;
    return sum;
  }

 private:
  std::vector<contact::Dissipation> of_chunk_;
};

}  // namespace

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

template <bool turns, bool commit, class Group, class Observer>
void ContactForceSum::sum_group(const GroupPlan& plan, Group& group, const contact::Placement& placement,
                                const Trial& trial, BodyForces& sum, Observer& observer) {
  using Kinematics = typename std::decay_t<Group>::KinematicsType;
  using State = typename std::decay_t<Group>::State;
  // Flat: the small functions of kinematics and laws are many, and calls among them pass everything through
  // memory.
  const auto one_chunk = [&](std::int64_t, std::int64_t, std::int64_t chunk) __attribute__((flatten)) {
    for (std::int64_t index = plan.starts[chunk]; index < plan.starts[chunk + 1]; ++index) {
      const auto c = static_cast<std::size_t>(index);
      const contact::Pair& pair = group.pairs[c];
      const auto& old = group.states[c];
      const contact::ContactGeometry geometry = Kinematics::geometry(placement, pair);
      if (!group.law.acts(contact::at_rest(geometry), old)) {
        if constexpr (Observer::looks)
          observer.see(chunk, group.law, motion_in<Kinematics>(group.law, placement, trial, pair, geometry),
                       old, State{});
        if constexpr (commit) group.states[c] = State{};
        if constexpr (Kinematics::second_is_body)
          if (const std::int32_t slot = plan.slot[c]; slot != own_chunk) {
            foreign_force_[slot].setZero();
            if constexpr (turns) foreign_moment_[slot].setZero();
          }
        continue;
      }
      State next;
      const contact::ContactMotion motion =
          motion_in<Kinematics>(group.law, placement, trial, pair, geometry);
      const contact::ContactForce f = group.law.evaluate(motion, old, next);
      if constexpr (Observer::looks) observer.see(chunk, group.law, motion, old, next);
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
  for_chunks(std::ssize(sum.force), chunk_size_, one_chunk);
}

template <bool turns, bool commit, class ModelRef, class Observer>
void ContactForceSum::sum_groups(ModelRef& model, const Trial& trial, BodyForces& sum, Observer& observer) {
  EIGENGRAIN_ASSERT(plans_.size() == model.contacts.groups.size(), plans_.size());
  const auto bodies = static_cast<std::size_t>(model.bodies.size());
  sum.force.assign(bodies, Vec3::Zero());
  sum.moment.assign(turns ? bodies : 0, Vec3::Zero());
  const contact::Placement placement = model.placement(trial.position);
  auto plan = plans_.begin();
  model.contacts.for_each_group(
      [&](auto& group) { sum_group<turns, commit>(*plan++, group, placement, trial, sum, observer); });
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
  Unobserved nobody;
  if (turns_)
    sum_groups<true, false>(model, trial, sum, nobody);
  else
    sum_groups<false, false>(model, trial, sum, nobody);
}

void ContactForceSum::advance(Model& model, const Trial& trial, BodyForces& sum,
                              contact::Dissipation* dissipated) {
  const auto with = [&](auto& observer) {
    if (turns_)
      sum_groups<true, true>(model, trial, sum, observer);
    else
      sum_groups<false, true>(model, trial, sum, observer);
  };
  if (dissipated == nullptr) {
    Unobserved nobody;
    with(nobody);
  } else {
    DissipationObserver observer((model.bodies.size() + chunk_size_ - 1) / chunk_size_);
    with(observer);
    *dissipated += observer.total();
  }
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
  const contact::Placement placement = model.placement(trial.position);
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

std::vector<Vec3> wall_forces(const Model& model) {
  std::vector<Vec3> forces(model.walls.size(), Vec3::Zero());
  const contact::Placement placement = model.placement();
  model.contacts.for_each_group([&](const auto& group) {
    using Group = std::decay_t<decltype(group)>;
    if constexpr (!Group::KinematicsType::second_is_body) {
      for (std::size_t c = 0; c < group.pairs.size(); ++c) {
        typename Group::State discarded;
        const contact::ContactGeometry geometry = Group::KinematicsType::geometry(placement, group.pairs[c]);
        forces[group.pairs[c].b] +=
            group.law.evaluate(contact::at_rest(geometry), group.states[c], discarded).force;
      }
    }
  });
  return forces;
}

}  // namespace eigengrain::assembly
