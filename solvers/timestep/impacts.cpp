#include "impacts.hpp"

#include "eigengrain/assembly/acting.hpp"
#include "eigengrain/assembly/loads.hpp"
#include "eigengrain/assembly/local_damping.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <set>
#include <type_traits>

namespace eigengrain::timestep {
namespace {

constexpr std::int32_t most_balls = 100;

/// Motion of two sides along their normal: positive when they part.
struct Along {
  double gap = 0;       ///< at t, m
  double velocity = 0;  ///< at t - dt/2, m/s
  double gravity = 0;   ///< difference of accelerations in flight, m/s²
};

Along between(const assembly::State& state, std::size_t a, std::size_t b) {
  const model::Bodies& bodies = state.model.bodies;
  const Vec3 branch = bodies.position[b] - bodies.position[a];
  const double distance = branch.norm();
  return {.gap = distance - bodies.radius[a] - bodies.radius[b],
          .velocity = branch.dot(bodies.velocity[b] - bodies.velocity[a]) / distance};
}

Along at_wall(const assembly::State& state, std::size_t a, const model::Plane& wall) {
  const model::Bodies& bodies = state.model.bodies;
  return {.gap = (bodies.position[a] - wall.point).dot(wall.normal) - bodies.radius[a],
          .velocity = bodies.velocity[a].dot(wall.normal),
          .gravity = state.model.gravity.dot(wall.normal)};
}

/// Squared speed at the moment of touching, from a moment of the same flight: v² - 2 g s.
double squared_at_touching(double velocity, double gravity, double gap) {
  return velocity * velocity - 2 * gravity * gap;
}

/// Just after the first step of a contact: the velocity of its middle is still that of the flight.
double approach_squared(const Along& along, double dt) {
  const double gap = along.gap - 0.5 * dt * along.velocity - 0.125 * dt * dt * along.gravity;
  return squared_at_touching(along.velocity, along.gravity, gap);
}

/// Just after the last step: from t on nothing but gravity acts.
double parting_squared(const Along& along, double dt) {
  return squared_at_touching(along.velocity + 0.5 * dt * along.gravity, along.gravity, along.gap);
}

}  // namespace

bool has_clear_impacts(const assembly::State& state) {
  const assembly::Model& model = state.model;
  const bool damped_flight = assembly::largest_damping(model) > 0 && !model.gravity.isZero(0);
  return model.bodies.size() <= most_balls && model.bodies.clumps.empty() && model.bodies.ramp.empty() &&
         !model.cell.any() && state.settings.surfaces.empty() && state.settings.wall_motions.empty() &&
         !assembly::has_loads(model.bodies) && !damped_flight;
}

void Impacts::look(const assembly::State& state) {
  const model::Bodies& bodies = state.model.bodies;
  std::map<Sides, Along> touching;
  std::map<std::int64_t, int> count;  // of contacts of a ball
  assembly::for_each_acting(state.model, [&](const auto& group, std::size_t c, const auto&) {
    using Kinematics = typename std::decay_t<decltype(group)>::KinematicsType;
    const contact::Pair& pair = group.pairs[c];
    const auto a = static_cast<std::size_t>(pair.a);
    const auto b = static_cast<std::size_t>(pair.b);
    if constexpr (Kinematics::second_is_body) {
      touching[{bodies.identity[a], bodies.identity[b]}] = between(state, a, b);
      ++count[bodies.identity[b]];
    } else {
      touching[{bodies.identity[a], -1 - std::int64_t{pair.b}}] = at_wall(state, a, state.model.walls[b]);
    }
    ++count[bodies.identity[a]];
  });
  const bool first = state.dt == 0 || state.step == 0;
  for (const auto& [sides, along] : touching) {
    const auto [impact, is_new] = going_on_.try_emplace(sides);
    if (is_new) impact->second = {approach_squared(along, state.dt), !first && along.velocity < 0};
    const bool crowded = count[sides.first] > 1 || (sides.second >= 0 && count[sides.second] > 1);
    impact->second.alone = impact->second.alone && !crowded;
  }
  const auto row = [&](std::int64_t identity) {
    return static_cast<std::size_t>(std::find(bodies.identity.begin(), bodies.identity.end(), identity) -
                                    bodies.identity.begin());
  };
  for (auto impact = going_on_.begin(); impact != going_on_.end();) {
    const auto& [sides, what] = *impact;
    if (touching.contains(sides)) {
      ++impact;
      continue;
    }
    // A side that went straight from this contact into the next one does not part in free flight.
    const bool free = !count.contains(sides.first) && (sides.second < 0 || !count.contains(sides.second));
    const Along along = sides.second >= 0
                            ? between(state, row(sides.first), row(sides.second))
                            : at_wall(state, row(sides.first),
                                      state.model.walls[static_cast<std::size_t>(-1 - sides.second)]);
    if (what.alone && free && what.approach_squared > 0)
      restitution_.push_back(
          std::sqrt(std::max(0.0, parting_squared(along, state.dt)) / what.approach_squared));
    impact = going_on_.erase(impact);
  }
}

}  // namespace eigengrain::timestep
