#include "eigengrain/assembly/within_rooms.hpp"

#include "eigengrain/base/assert.hpp"

#include "dashpots.hpp"

#include <algorithm>
#include <type_traits>
#include <utility>

namespace eigengrain::assembly {
namespace {

/// By how much of itself a block can grow when all its contacts turn by an angle of one.
double sensitivity_of(const model::Clumps& clumps, std::int32_t row) {
  const std::int32_t clump = clumps.empty() ? model::Clumps::none : clumps.of(row);
  if (clump == model::Clumps::none) return 9;
  const auto c = static_cast<std::size_t>(clump);
  return 18 * (1 + clumps.mass[c] * clumps.radius[c] * clumps.radius[c] / clumps.inertia[c].minCoeff());
}

Adjacency ends_of_bodies(const LinearSystem& system) {
  std::vector<std::int32_t> body_of_end;
  body_of_end.reserve(2 * system.elements.size());
  for (const contact::ContactElement& element : system.elements) {
    body_of_end.push_back(element.a);
    body_of_end.push_back(element.b);
  }
  return group_by_row(system.unknowns.bodies(), body_of_end);
}

}  // namespace

WithinRooms::WithinRooms(const Model& model, std::vector<Vec3> position, std::vector<double> room,
                         double wall_room)
    : system_(model, Listed::all),
      position_(std::move(position)),
      room_(std::move(room)),
      wall_room_(wall_room),
      turn_(2 * system_.elements.size(), 0.0),
      ends_(ends_of_bodies(system_)),
      growth_(room_.size(), 1.0) {
  std::int32_t element = 0;
  model.contacts.for_each_group([&](const auto& group) {
    for (std::size_t c = 0; c < group.pairs.size(); ++c)
      if (is_element(group, c)) renew(model, group, c, element++);
  });
  EIGENGRAIN_ASSERT(element == std::ssize(system_.elements), element);
  for (std::int32_t body = 0; body < std::ssize(growth_); ++body) renew_growth(model.bodies.clumps, body);
}

template <class Group>
void WithinRooms::renew(const Model& model, const Group& group, std::size_t c, std::int32_t element) {
  using Kinematics = typename Group::KinematicsType;
  const contact::Pair& pair = group.pairs[c];
  const contact::ContactGeometry geometry =
      Kinematics::geometry(model.placement(position_, model.bodies.orientation), pair);
  double approach = room_[static_cast<std::size_t>(pair.a)] + wall_room_;
  double apart = model.bodies.radius[static_cast<std::size_t>(pair.a)];
  if constexpr (Kinematics::second_is_body) {
    const auto b = static_cast<std::size_t>(pair.b);
    approach = room_[static_cast<std::size_t>(pair.a)] + room_[b];
    apart += model.bodies.radius[b];
  }
  contact::ContactMotion motion = contact::at_rest(geometry);
  motion.overlap += approach;
  const bool touches = group.law.acts(motion, group.states[c]);

  const auto e = static_cast<std::size_t>(element);
  contact::ContactElement& worst = system_.elements[e];
  worst.stiffness = touches ? group.law.stiffness(motion, group.states[c]) : contact::ContactStiffness{};
  if (model.bodies.clumps.empty()) {  // else they are where they were listed
    worst.normal = geometry.normal;
    worst.lever_a = geometry.lever_a;
    worst.lever_b = geometry.lever_b;
  }
  if (!system_.damping.empty()) system_.damping[e] = dashpots_of(group.law, worst, model.bodies.mass);
  const auto turn = [&](double radius) { return touches ? approach / std::min(apart, 2 * radius) : 0.0; };
  turn_[2 * e] = turn(model.bodies.radius[static_cast<std::size_t>(pair.a)]);
  if constexpr (Kinematics::second_is_body)
    turn_[2 * e + 1] = turn(model.bodies.radius[static_cast<std::size_t>(pair.b)]);
}

void WithinRooms::renew_growth(const model::Clumps& clumps, std::int32_t body) {
  double largest = 0;
  for (const std::int32_t end : ends_.links(body))
    largest = std::max(largest, turn_[static_cast<std::size_t>(end)]);
  growth_[static_cast<std::size_t>(body)] = 1 + sensitivity_of(clumps, body) * largest;
}

bool WithinRooms::can_move(const Model& model) {
  bool bonds = false;
  model.contacts.for_each_group([&](const auto& group) {
    if constexpr (contact::BondLaw<typename std::decay_t<decltype(group)>::LawType>) bonds = true;
  });
  return !bonds && model.bodies.clumps.empty() && model.wall_motions.empty();
}

std::vector<std::int32_t> WithinRooms::move(const Model& model, std::span<const std::int32_t> bodies,
                                            std::span<const Vec3> position, std::span<const double> room) {
  EIGENGRAIN_ASSERT(can_move(model) && model.contacts.size() == std::ssize(system_.elements));
  std::vector<std::int32_t> contacts;
  for (const std::int32_t body : bodies) {
    const auto row = static_cast<std::size_t>(body);
    position_[row] = position[row];
    room_[row] = room[row];
    for (const std::int32_t end : ends_.links(body)) contacts.push_back(end / 2);
  }
  std::ranges::sort(contacts);
  contacts.erase(std::unique(contacts.begin(), contacts.end()), contacts.end());
  std::size_t next = 0;
  std::int64_t first = 0;  // contact of the group
  model.contacts.for_each_group([&](const auto& group) {
    for (; next < contacts.size() && contacts[next] < first + group.size(); ++next)
      renew(model, group, static_cast<std::size_t>(contacts[next] - first), contacts[next]);
    first += group.size();
  });
  for (const std::int32_t contact : contacts)
    for (const std::int32_t body : {system_.elements[static_cast<std::size_t>(contact)].a,
                                    system_.elements[static_cast<std::size_t>(contact)].b})
      if (body != contact::no_body) renew_growth(model.bodies.clumps, body);
  return contacts;
}

}  // namespace eigengrain::assembly
