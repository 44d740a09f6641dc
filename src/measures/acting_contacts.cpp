#include "eigengrain/measures/acting_contacts.hpp"

#include "eigengrain/assembly/acting.hpp"
#include "eigengrain/assembly/clump_members.hpp"
#include "eigengrain/base/adjacency.hpp"

#include <algorithm>
#include <cstddef>
#include <type_traits>
#include <utility>

namespace eigengrain::measures {
namespace {

Vec3 across(const Vec3& v, const Vec3& n) {
  return v - v.dot(n) * n;
}

/// After a slip the shear force is at the limit to rounding only, so the contact is probed with a little
/// more.
template <class Law, class State>
bool slides(const Law& law, const contact::ContactMotion& motion, const State& state) {
  if constexpr (contact::BondLaw<Law>)
    if (state.bonded()) return false;
  State discarded;
  const Vec3 force = law.evaluate(motion, state, discarded).force;
  constexpr double probe = 1e-6;  // of the shear force
  const double shear = across(force, motion.normal).norm();
  const double stiffness = law.stiffness(motion, state).shear;
  constexpr double rounding = 1e-12;  // of the force: what is left across n of a force along it
  if (!(shear > rounding * force.norm()) || !(stiffness > 0)) return false;
  contact::ContactMotion more = motion;
  more.displacement = -probe / stiffness * across(force, motion.normal);
  const double raised = across(law.evaluate(more, state, discarded).force, motion.normal).norm();
  return raised - shear < 0.5 * probe * shear;
}

/// Where a pair of bodies is among the contacts.
struct Place {
  contact::Pair pair;
  std::size_t index;
};
bool precedes(const Place& left, const Place& right) {
  return contact::precedes(left.pair, right.pair);
}

}  // namespace

std::vector<ActingContact> acting_contacts(const assembly::Model& model) {
  std::vector<ActingContact> result;
  std::vector<Place> between_bodies;
  std::vector<std::pair<contact::Pair, ActingContact>> beside;
  const contact::Placement placement = model.placement();
  assembly::for_each_acting(model, placement, [&](const auto& group, std::size_t c, const auto& geometry) {
    using Group = std::decay_t<decltype(group)>;
    using Kinematics = typename Group::KinematicsType;
    const contact::Pair& pair = group.pairs[c];
    ActingContact found;
    const model::Bodies& bodies = model.bodies;
    found.a = bodies.clumps.owner(pair.a);
    found.normal = geometry.normal;
    found.force = contact::force_now(group.law, placement, pair, geometry, group.states[c]).force;
    found.b = Kinematics::second_is_body ? bodies.clumps.owner(pair.b) : ActingContact::wall;
    found.ball_a = pair.a;
    found.image = pair.image;
    found.overlap = geometry.overlap;
    found.point = bodies.position[static_cast<std::size_t>(pair.a)] + geometry.lever_a;
    found.rule = group.rule;
    if constexpr (Kinematics::second_is_body)
      found.ball_b = pair.b;
    else
      found.ball_b = Kinematics::wall(placement, pair);
    if constexpr (Kinematics::second_is_body)
      found.branch =
          geometry.branch() + assembly::lever_of(bodies, pair.a) - assembly::lever_of(bodies, pair.b);
    else
      found.branch = geometry.lever_a + assembly::lever_of(bodies, pair.a);
    if constexpr (contact::is_beside_law<typename Group::LawType>) {
      found.carries_moments = true;
      beside.emplace_back(pair, found);
    } else {
      found.slides = slides(group.law, contact::at_rest(geometry), group.states[c]);
      if constexpr (Kinematics::second_is_body) between_bodies.push_back({pair, result.size()});
      result.push_back(found);
    }
  });
  if (beside.empty()) return result;
  std::sort(between_bodies.begin(), between_bodies.end(), precedes);
  for (const auto& [pair, bond] : beside) {
    const Place wanted{pair, 0};
    const auto same = std::lower_bound(between_bodies.begin(), between_bodies.end(), wanted, precedes);
    if (same != between_bodies.end() && !precedes(wanted, *same)) {
      result[same->index].force += bond.force;
      result[same->index].carries_moments = true;
    } else {
      result.push_back(bond);
    }
  }
  return result;
}

std::int32_t least_contacts(const assembly::Model& model) {
  bool shear = false;
  model.contacts.for_each_group([&](const auto& group) { shear = shear || group.law.needs_rotation(); });
  if (shear) return 2;
  const std::vector<model::FixedComponents>& fixed = model.bodies.fixed;
  const auto flat = [&](int axis) {
    return std::all_of(fixed.begin(), fixed.end(), [&](const auto& f) { return f.component(axis); });
  };
  const int dimensions = flat(0) || flat(1) || flat(2) ? 2 : 3;
  return model.gravity.isZero(0) ? dimensions + 1 : dimensions;
}

std::vector<bool> rattlers(const assembly::Model& model, std::span<const ActingContact> contacts,
                           std::int32_t least) {
  const std::int32_t bodies = model.bodies.size();
  std::vector<std::int32_t> first;
  std::vector<std::int32_t> second;
  std::vector<std::int32_t> count(static_cast<std::size_t>(bodies), 0);
  const auto weight = [&](const ActingContact& contact) { return contact.carries_moments ? least : 1; };
  for (const ActingContact& contact : contacts) {
    first.push_back(contact.a);
    second.push_back(contact.b);
    count[contact.a] += weight(contact);
    if (contact.b != ActingContact::wall) count[contact.b] += weight(contact);
  }
  const Adjacency as_first = group_by_row(bodies, first);
  const Adjacency as_second = group_by_row(bodies, second);

  std::vector<bool> removed(static_cast<std::size_t>(bodies), false);
  std::vector<std::int32_t> waiting;
  const auto look = [&](std::int32_t body) {
    if (assembly::is_node(model.bodies, static_cast<std::size_t>(body))) return;  // elements hold it
    if (removed[body] || count[body] >= least || model.bodies.fixed[body].translation() == 7) return;
    removed[body] = true;
    waiting.push_back(body);
  };
  const model::Clumps& clumps = model.bodies.clumps;
  for (std::int32_t body = 0; body < bodies; ++body)
    if (clumps.owner(body) == body) look(body);
  while (!waiting.empty()) {
    const std::int32_t body = waiting.back();
    waiting.pop_back();
    const auto lose = [&](std::int32_t other, const ActingContact& contact) {
      if (other == ActingContact::wall) return;
      count[other] -= weight(contact);
      look(other);
    };
    for (const std::int32_t c : as_first.links(body)) lose(contacts[c].b, contacts[c]);
    for (const std::int32_t c : as_second.links(body)) lose(contacts[c].a, contacts[c]);
  }
  for (std::int32_t c = 0; c < clumps.size(); ++c)
    for (const std::int32_t ball : clumps.members(c)) removed[ball] = removed[clumps.holder(c)];
  return removed;
}

}  // namespace eigengrain::measures
