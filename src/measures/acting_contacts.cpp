#include "eigengrain/measures/acting_contacts.hpp"

#include "eigengrain/base/adjacency.hpp"

#include <algorithm>
#include <cstddef>
#include <optional>
#include <tuple>

namespace eigengrain::measures {
namespace {

Vec3 across(const Vec3& v, const Vec3& n) {
  return v - v.dot(n) * n;
}

/// After a slip the shear force is at the limit to rounding only, so the contact is probed with a little
/// more.
template <class Law, class State>
bool slides(const Law& law, const contact::ContactMotion& motion, const State& state, const Vec3& force) {
  if constexpr (contact::BondLaw<Law>)
    if (state.bonded()) return false;
  constexpr double probe = 1e-6;  // of the shear force
  const double shear = across(force, motion.normal).norm();
  const double stiffness = law.stiffness(motion, state).shear;
  if (!(shear > 0) || !(stiffness > 0)) return false;
  contact::ContactMotion more = motion;
  more.displacement = -probe / stiffness * across(force, motion.normal);
  State discarded;
  const double raised = across(law.evaluate(more, state, discarded).force, motion.normal).norm();
  return raised - shear < 0.5 * probe * shear;
}

/// Bonds that add to another law on the same pair.
template <class Law>
constexpr bool beside_law() {
  if constexpr (contact::BondLaw<Law>)
    return Law::additive;
  else
    return false;
}
template <class Law>
inline constexpr bool is_beside_law = beside_law<Law>();

/// One contact of a group, if it acts.
template <class Group>
std::optional<ActingContact> acting(const Group& group, std::size_t c, const contact::Placement& placement) {
  using Kinematics = typename Group::KinematicsType;
  using Law = typename Group::LawType;
  const contact::Pair& pair = group.pairs[c];
  const contact::ContactGeometry geometry = Kinematics::geometry(placement, pair);
  if (!group.law.acts(contact::at_rest(geometry), group.states[c])) return std::nullopt;
  typename Group::State discarded;
  const auto motion = contact::at_rest_for<Law>(placement, pair, geometry);
  ActingContact contact;
  contact.a = pair.a;
  contact.normal = geometry.normal;
  contact.force = group.law.evaluate(motion, group.states[c], discarded).force;
  if constexpr (!is_beside_law<Law>)
    contact.slides = slides(group.law, motion, group.states[c], contact.force);
  if constexpr (Kinematics::second_is_body) {
    contact.b = pair.b;
    contact.branch = geometry.lever_a - geometry.lever_b;
  } else {
    contact.b = ActingContact::wall;
    contact.branch = geometry.lever_a;
  }
  return contact;
}

/// Where a pair of bodies is among the contacts.
struct Place {
  contact::Pair pair;
  std::size_t index;
};
bool precedes(const Place& left, const Place& right) {
  return std::tie(left.pair.a, left.pair.b, left.pair.image) <
         std::tie(right.pair.a, right.pair.b, right.pair.image);
}

}  // namespace

std::vector<ActingContact> acting_contacts(const assembly::Model& model) {
  std::vector<ActingContact> result;
  std::vector<Place> between_bodies;
  const contact::Placement placement = model.placement();
  model.contacts.for_each_group([&](const auto& group) {
    using Group = std::decay_t<decltype(group)>;
    using Kinematics = typename Group::KinematicsType;
    if constexpr (!is_beside_law<typename Group::LawType>)
      for (std::size_t c = 0; c < group.pairs.size(); ++c) {
        const std::optional<ActingContact> found = acting(group, c, placement);
        if (!found) continue;
        if constexpr (Kinematics::second_is_body) between_bodies.push_back({group.pairs[c], result.size()});
        result.push_back(*found);
      }
  });
  std::sort(between_bodies.begin(), between_bodies.end(), precedes);
  model.contacts.for_each_group([&](const auto& group) {
    if constexpr (is_beside_law<typename std::decay_t<decltype(group)>::LawType>)
      for (std::size_t c = 0; c < group.pairs.size(); ++c) {
        const std::optional<ActingContact> bond = acting(group, c, placement);
        if (!bond) continue;
        const Place wanted{group.pairs[c], 0};
        const auto same = std::lower_bound(between_bodies.begin(), between_bodies.end(), wanted, precedes);
        if (same != between_bodies.end() && !precedes(wanted, *same))
          result[same->index].force += bond->force;
        else
          result.push_back(*bond);
      }
  });
  return result;
}

std::int32_t least_contacts(const assembly::Model& model) {
  bool shear = false;
  model.contacts.for_each_group([&](const auto& group) { shear = shear || group.law.needs_rotation(); });
  if (shear) return 2;
  return model.gravity.isZero(0) ? 4 : 3;
}

std::vector<bool> rattlers(const assembly::Model& model, std::span<const ActingContact> contacts,
                           std::int32_t least) {
  const std::int32_t bodies = model.bodies.size();
  std::vector<std::int32_t> first;
  std::vector<std::int32_t> second;
  std::vector<std::int32_t> count(static_cast<std::size_t>(bodies), 0);
  for (const ActingContact& contact : contacts) {
    first.push_back(contact.a);
    second.push_back(contact.b);
    ++count[contact.a];
    if (contact.b != ActingContact::wall) ++count[contact.b];
  }
  const Adjacency as_first = group_by_row(bodies, first);
  const Adjacency as_second = group_by_row(bodies, second);

  std::vector<bool> removed(static_cast<std::size_t>(bodies), false);
  std::vector<std::int32_t> waiting;
  const auto look = [&](std::int32_t body) {
    if (removed[body] || count[body] >= least || model.bodies.fixed[body].translation() == 7) return;
    removed[body] = true;
    waiting.push_back(body);
  };
  for (std::int32_t body = 0; body < bodies; ++body) look(body);
  while (!waiting.empty()) {
    const std::int32_t body = waiting.back();
    waiting.pop_back();
    const auto lose = [&](std::int32_t other) {
      if (other == ActingContact::wall) return;
      --count[other];
      look(other);
    };
    for (const std::int32_t c : as_first.links(body)) lose(contacts[c].b);
    for (const std::int32_t c : as_second.links(body)) lose(contacts[c].a);
  }
  return removed;
}

}  // namespace eigengrain::measures
