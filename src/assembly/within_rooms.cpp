#include "eigengrain/assembly/within_rooms.hpp"

#include <algorithm>
#include <type_traits>

namespace eigengrain::assembly {
namespace {

/// By how much of itself a block can grow when all its contacts turn by an angle of one.
double sensitivity_of(const model::Clumps& clumps, std::int32_t row) {
  const std::int32_t clump = clumps.empty() ? model::Clumps::none : clumps.of(row);
  if (clump == model::Clumps::none) return 9;
  const auto c = static_cast<std::size_t>(clump);
  return 18 * (1 + clumps.mass[c] * clumps.radius[c] * clumps.radius[c] / clumps.inertia[c].minCoeff());
}

}  // namespace

WithinRooms::WithinRooms(const Model& model, std::span<const double> room, double wall_room)
    : model_(model), room_(room), wall_room_(wall_room), factor_(room.size(), 1.0) {
  const model::Bodies& bodies = model.bodies;
  const auto note = [&](std::int32_t row, double turn) {
    double& factor =
        factor_[static_cast<std::size_t>(bodies.clumps.empty() ? row : bodies.clumps.owner(row))];
    factor = std::max(factor, 1 + sensitivity_of(bodies.clumps, row) * turn);
  };
  model.contacts.for_each_group([&](const auto& group) {
    constexpr bool with_ball = std::decay_t<decltype(group)>::KinematicsType::second_is_body;
    for (const contact::Pair& pair : group.pairs) {
      // n turns by the approach over the distance, and a short lever changes by more of itself than that.
      double length = bodies.radius[static_cast<std::size_t>(pair.a)];
      if (with_ball) {
        const double other = bodies.radius[static_cast<std::size_t>(pair.b)];
        length = std::min(length + other, 2 * std::min(length, other));
      }
      const double turn = approach(pair, with_ball) / length;
      note(pair.a, turn);
      if (with_ball) note(pair.b, turn);
    }
  });
}

double WithinRooms::factor(const contact::Pair& pair, bool with_ball) const {
  const model::Clumps& clumps = model_.bodies.clumps;
  const auto of = [&](std::int32_t row) {
    return factor_[static_cast<std::size_t>(clumps.empty() ? row : clumps.owner(row))];
  };
  return with_ball ? std::max(of(pair.a), of(pair.b)) : of(pair.a);
}

}  // namespace eigengrain::assembly
