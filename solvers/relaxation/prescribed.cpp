#include "eigengrain/relaxation/prescribed.hpp"

#include "eigengrain/assembly/clump_members.hpp"
#include "eigengrain/assembly/contact_list.hpp"
#include "eigengrain/assembly/forces.hpp"
#include "eigengrain/assembly/step_wall.hpp"
#include "eigengrain/base/error.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

namespace eigengrain::relaxation {
namespace {

using assembly::Displacement;
using assembly::State;

/// Longest way of anything at a time, over the skin of the list.
constexpr double longest_way = 0.2;

/// Which of the motions of walls is that of a wall; throws where it has none.
std::size_t motion_of(const assembly::Model& model, std::int32_t wall) {
  for (std::size_t m = 0; m < model.wall_motions.size(); ++m)
    if (model.wall_motions[m].wall == wall) return m;
  const auto w = static_cast<std::size_t>(wall);
  throw InputError(fmt::format(
      "{} cannot be moved: states know only where walls are that may move; give it "
      "velocity: [0, 0, 0] in the scene",
      w < model.walls.size() ? model.walls[w].name : model.surfaces[w - model.walls.size()].name));
}

/// Contacts take part in a displacement of balls, walls and cell; everything else has happened.
void remember(State& state, const Displacement& of_balls, const assembly::WallStep* walls,
              const Mat3* cell_step) {
  model::Bodies& bodies = state.model.bodies;
  bodies.orientation = assembly::turned_orientations(bodies, of_balls.rotation);
  assembly::BodyForces sum;
  assembly::ContactForceSum contacts(state.model, state.turns());
  contacts.advance(state.model,
                   {.position = bodies.position,
                    .velocity = of_balls.translation,
                    .spin = of_balls.rotation,
                    .duration = 1.0,
                    .orientation = bodies.orientation,
                    .walls = walls,
                    .cell_step = cell_step},
                   sum);
  assembly::note_breaks(state, contacts.broken());
  state.force = std::move(sum.force);
  state.moment = std::move(sum.moment);
}

Displacement at_rest(const State& state) {
  const auto count = static_cast<std::size_t>(state.model.bodies.size());
  Displacement none{.translation = std::vector<Vec3>(count, Vec3::Zero()), .rotation = {}};
  if (state.turns()) none.rotation.assign(count, Vec3::Zero());
  return none;
}

int parts_of(double way, double skin) {
  return std::max(1, static_cast<int>(std::ceil(way / (longest_way * skin))));
}

}  // namespace

void displace_wall(State& state, std::int32_t wall, const Vec3& displacement) {
  const std::size_t m = motion_of(state.model, wall);
  const int parts = parts_of(displacement.norm(), state.list.skin);
  const Displacement rest = at_rest(state);
  for (int k = 0; k < parts; ++k) {
    assembly::WallStep step(state.model);
    assembly::step_wall(state, m, {displacement / parts, Vec3::Zero()}, step);
    assembly::renew_list(state, state.list.skin);
    remember(state, rest, &step, nullptr);
  }
  assembly::forget_step(state);
}

void strain_cell(State& state, const Mat3& strain) {
  model::PeriodicCell& cell = state.model.cell;
  model::Bodies& bodies = state.model.bodies;
  double farthest = 0;
  for (const Vec3& x : bodies.position) farthest = std::max(farthest, (strain * (x - cell.origin)).norm());
  farthest = std::max(farthest, (strain * cell.edges).norm());
  const int parts = parts_of(farthest, state.list.skin);
  for (int k = 0; k < parts; ++k) {
    // From (1 + k/n E) H to (1 + (k + 1)/n E) H.
    const Mat3 part = strain / parts * (Mat3::Identity() + k * strain / parts).inverse();
    Displacement moved = at_rest(state);
    for (std::int32_t row = 0; row < bodies.size(); ++row) {
      if (bodies.clumps.owner(row) != row) continue;
      const Vec3& x = model::centre_of(bodies, row);
      moved.translation[static_cast<std::size_t>(row)] = part * (x - cell.origin);
    }
    Displacement balls = moved;
    assembly::carry_members(bodies, balls);
    cell.edges += part * cell.edges;
    for (std::size_t i = 0; i < bodies.position.size(); ++i) bodies.position[i] += balls.translation[i];
    assembly::commit_clumps(bodies, moved);
    assembly::renew_list(state, state.list.skin);
    // By the edges that the list left, which may be others of the same lattice.
    const Mat3 step = part * (Mat3::Identity() + part).inverse() * cell.edges;
    remember(state, balls, nullptr, &step);
  }
  assembly::forget_step(state);
}

}  // namespace eigengrain::relaxation
