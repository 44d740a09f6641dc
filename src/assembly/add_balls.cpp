#include "eigengrain/assembly/add_balls.hpp"

#include "eigengrain/assembly/contact_list.hpp"
#include "eigengrain/assembly/forces.hpp"
#include "eigengrain/assembly/half_step.hpp"
#include "eigengrain/assembly/loads.hpp"
#include "eigengrain/contact/facet.hpp"
#include "eigengrain/search/candidates.hpp"

#include <algorithm>
#include <array>
#include <vector>

namespace eigengrain::assembly {
namespace {

/// Calls visit(shift) for the cell and those beside it.
template <class Visit>
void for_each_neighbour_cell(const model::PeriodicCell& cell, const Visit& visit) {
  const auto reach = [&](std::size_t k) { return cell.periodic[k] ? 1 : 0; };
  for (int i = -reach(0); i <= reach(0); ++i)
    for (int j = -reach(1); j <= reach(1); ++j)
      for (int k = -reach(2); k <= reach(2); ++k) visit(cell.shift(std::array<int, 3>{i, j, k}));
}

/// x lies in the cell.
bool overlaps_a_wall(const Model& model, const Vec3& x, double radius) {
  const auto behind = [&](const model::Plane& wall) { return (x - wall.point).dot(wall.normal) < radius; };
  if (std::any_of(model.walls.begin(), model.walls.end(), behind)) return true;
  bool overlaps = false;
  std::vector<std::int32_t> near;
  for_each_neighbour_cell(model.cell, [&](const Vec3& shift) {
    for (std::size_t s = 0; s < model.surfaces.size(); ++s) {
      const Vec3 local = model.surface_places[s].to_local(x - shift);
      near.clear();
      model.facet_trees[s].near(local, radius, near);
      for (const std::int32_t facet : near) {
        const auto& f = model.facets.facet[static_cast<std::size_t>(facet)];
        overlaps = overlaps || (contact::nearest_point(local, f).point - local).norm() < radius;
      }
    }
  });
  return overlaps;
}

/// [new balls] whether each keeps clear of the balls and walls of the model; in a cell that has moved, for
/// which they were not made, of those before it too.
std::vector<bool> free_places(const State& state, const model::Bodies& balls) {
  const Model& model = state.model;
  const bool moved = model.cell.edges != state.settings.cell.edges;
  std::vector<Vec3> centres = model.bodies.position;
  std::vector<double> radii = model.bodies.radius;
  const auto there = static_cast<std::int32_t>(centres.size());
  centres.insert(centres.end(), balls.position.begin(), balls.position.end());
  radii.insert(radii.end(), balls.radius.begin(), balls.radius.end());
  std::vector<bool> free(balls.position.size());
  for (std::size_t i = 0; i < free.size(); ++i)
    free[i] = !overlaps_a_wall(model, model.cell.wrapped(balls.position[i]), balls.radius[i]);
  for (const search::CandidatePair& pair : search::candidate_pairs(centres, radii, model.cell))
    if (pair.b >= there && (pair.a < there || moved)) free[static_cast<std::size_t>(pair.b - there)] = false;
  return free;
}

/// The velocities of a ball that are given for t become those of half a step before.
void set_back(State& state, std::size_t row) {
  model::Bodies& bodies = state.model.bodies;
  const model::FixedComponents fixed = bodies.fixed[row];
  bodies.velocity[row] =
      half_a_step_before(bodies.velocity[row], state.force[row] + load_on(state.model, row),
                         model::inertial_mass(bodies, row), state.dt, fixed.translation());
  if (state.turns())
    bodies.spin[row] = half_a_step_before(bodies.spin[row], state.moment[row] + moment_on(state.model, row),
                                          model::inertial_moment(bodies, row), state.dt, fixed.rotation());
}

}  // namespace

Added add_balls(State& state, const model::Bodies& balls) {
  const std::vector<bool> free = free_places(state, balls);
  std::vector<std::int32_t> order;
  for (std::int32_t row = 0; row < balls.size(); ++row)
    if (free[static_cast<std::size_t>(row)]) order.push_back(row);
  const auto count = std::ssize(order);
  if (count > 0) {
    model::Bodies added = model::reordered(balls, order);
    for (model::RadiusRamp& ramp : added.ramp) ramp.from += state.time;
    model::Bodies& bodies = state.model.bodies;
    const std::size_t first = bodies.position.size();
    if (!state.turns() && (!added.spin.empty() || !added.applied_moment.empty()))
      bodies.spin.assign(first, Vec3::Zero());
    model::append_rows(bodies, added);
    state.force.resize(bodies.position.size(), Vec3::Zero());
    if (state.turns()) state.moment.resize(bodies.position.size(), Vec3::Zero());
    const model::PeriodicCell& cell = state.model.cell;
    for (std::size_t i = first; i < bodies.position.size(); ++i)  // velocities are beside the flow
      bodies.velocity[i] += cell.flow_gradient() * (bodies.position[i] - cell.origin);
    renew_list(state, state.list.skin);
    renew_forces(state);
    for (std::size_t i = first; i < bodies.position.size(); ++i) set_back(state, i);
    forget_step(state);
    state.ledger.reset();
  }
  return {.balls = count, .left_out = balls.size() - count};
}

}  // namespace eigengrain::assembly
