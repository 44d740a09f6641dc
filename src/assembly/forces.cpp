#include "eigengrain/assembly/forces.hpp"

#include "eigengrain/base/adjacency.hpp"
#include "eigengrain/base/parallel.hpp"

namespace eigengrain::assembly {
namespace {

using contact::SideMotion;

/// A trial state: where the bodies are, and how they came there.
struct Trial {
  Trial(const Model& model, const Displacement& displacement) : moved(displacement) {
    position.reserve(model.bodies.position.size());
    for (std::size_t i = 0; i < model.bodies.position.size(); ++i)
      position.emplace_back(model.bodies.position[i] + displacement.translation[i]);
  }
  SideMotion body(std::int32_t i) const {
    const auto row = static_cast<std::size_t>(i);
    return {moved.translation[row], moved.rotation.empty() ? Vec3(Vec3::Zero()) : moved.rotation[row]};
  }

  const Displacement& moved;
  std::vector<Vec3> position;
};

/// The motion of contact `pair` in the trial state.
template <class Kinematics>
contact::ContactMotion motion_of(const contact::ContactGeometry& geometry, const Trial& trial,
                                 const contact::Pair& pair) {
  const SideMotion b = Kinematics::second_is_body ? trial.body(pair.b) : SideMotion{};
  return contact::contact_motion(geometry, trial.body(pair.a), b);
}

template <class Group>
std::vector<contact::EndForces> evaluate(const Model& model, const Trial& trial, const Group& group) {
  using Kinematics = typename Group::KinematicsType;
  const contact::Placement placement = model.placement(trial.position);
  std::vector<contact::EndForces> result(group.pairs.size());
  for_each_index(group.size(), [&](std::int64_t index) {
    const auto c = static_cast<std::size_t>(index);
    const contact::ContactGeometry geometry = Kinematics::geometry(placement, group.pairs[c]);
    typename Group::State discarded;
    const contact::ContactForce f = group.law.evaluate(motion_of<Kinematics>(geometry, trial, group.pairs[c]),
                                                       group.states[c], discarded);
    result[c] = contact::end_forces(geometry, f);
  });
  return result;
}

template <class Group>
void add_to_bodies(const Group& group, const std::vector<contact::EndForces>& ends, BodyForces& sum) {
  const auto bodies = static_cast<std::int32_t>(sum.force.size());
  std::vector<std::int32_t> body_of_end(2 * group.pairs.size(), -1);
  for (std::size_t c = 0; c < group.pairs.size(); ++c) {
    body_of_end[2 * c] = group.pairs[c].a;
    if constexpr (Group::KinematicsType::second_is_body) body_of_end[2 * c + 1] = group.pairs[c].b;
  }
  const Adjacency ends_of_body = group_by_row(bodies, body_of_end);
  for_each_index(bodies, [&](std::int64_t body) {
    const auto i = static_cast<std::size_t>(body);
    for (const std::int32_t end : ends_of_body.links(static_cast<std::int32_t>(body))) {
      const contact::EndForces& f = ends[static_cast<std::size_t>(end) / 2];
      const bool first = end % 2 == 0;
      sum.force[i] += first ? f.force_a : f.force_b;
      sum.moment[i] += first ? f.moment_a : f.moment_b;
    }
  });
}

Displacement no_displacement(const Model& model) {
  return {std::vector<Vec3>(model.bodies.position.size(), Vec3::Zero()), {}};
}

}  // namespace

BodyForces contact_forces(const Model& model, const Displacement& displacement) {
  const Trial trial(model, displacement);
  BodyForces sum{std::vector<Vec3>(model.bodies.position.size(), Vec3::Zero()),
                 std::vector<Vec3>(model.bodies.position.size(), Vec3::Zero())};
  model.contacts.for_each_group(
      [&](const auto& group) { add_to_bodies(group, evaluate(model, trial, group), sum); });
  return sum;
}

BodyForces contact_forces(const Model& model) {
  return contact_forces(model, no_displacement(model));
}

double elastic_energy(const Model& model, const Displacement& displacement) {
  const Trial trial(model, displacement);
  const contact::Placement placement = model.placement(trial.position);
  double energy = 0;
  model.contacts.for_each_group([&](const auto& group) {
    using Kinematics = typename std::decay_t<decltype(group)>::KinematicsType;
    for (std::size_t c = 0; c < group.pairs.size(); ++c) {
      const contact::ContactGeometry geometry = Kinematics::geometry(placement, group.pairs[c]);
      energy += group.law.energy(motion_of<Kinematics>(geometry, trial, group.pairs[c]), group.states[c]);
    }
  });
  return energy;
}

}  // namespace eigengrain::assembly
