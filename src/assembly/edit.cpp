#include "eigengrain/assembly/edit.hpp"

#include "eigengrain/assembly/contact_list.hpp"
#include "eigengrain/assembly/forces.hpp"
#include "eigengrain/assembly/loads.hpp"
#include "eigengrain/assembly/selection.hpp"
#include "eigengrain/base/error.hpp"
#include "eigengrain/contact/facet.hpp"
#include "eigengrain/search/candidates.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <numeric>
#include <set>
#include <span>

namespace eigengrain::assembly {
namespace {

/// The selected balls that are bodies of their own, and the clumps that any of the others belongs to.
struct SelectedBodies {
  std::vector<std::int32_t> rows;
  std::set<std::int32_t> clumps;
};

SelectedBodies selected_bodies(const State& state, const model::Selection& selection,
                               const std::string& where) {
  SelectedBodies result;
  const model::Clumps& clumps = state.model.bodies.clumps;
  for (const std::int32_t row : selected(state.model.bodies, state.groups, selection))
    if (const std::int32_t clump = clumps.of(row); clump == model::Clumps::none)
      result.rows.push_back(row);
    else
      result.clumps.insert(clump);
  if (result.rows.empty() && result.clumps.empty())
    throw InputError(fmt::format("{}: no ball is meant; look at where the balls are", where));
  return result;
}

/// The velocity half a step before the one given, of a body that the force F accelerates.
Vec3 half_a_step_before(const Vec3& velocity, const Vec3& force, double inertia, double dt,
                        std::uint8_t fixed) {
  return velocity - 0.5 * dt / inertia * model::free_part(force, fixed);
}

/// Sets a value in a column that is there only where some body has need of it.
template <class T>
void set_own(std::vector<T>& column, std::size_t rows, std::size_t row, const T& value, const T& no_need) {
  if (column.empty()) column.assign(rows, no_need);
  column[row] = value;
}

/// Loads and local damping, which stand in a row of the bodies.
void change_own(model::Bodies& bodies, std::size_t row, const model::BodyChange& change) {
  const std::size_t rows = bodies.position.size();
  const Vec3 none = Vec3::Zero();
  if (change.force) set_own(bodies.applied_force, rows, row, *change.force, none);
  if (change.moment) set_own(bodies.applied_moment, rows, row, *change.moment, none);
  if (change.damping) set_own(bodies.damping, rows, row, *change.damping, model::Bodies::scene_damping);
}

void change_radius(State& state, std::int32_t row, const model::BodyChange& change) {
  model::Bodies& bodies = state.model.bodies;
  if (!change.radius_by) return;
  if (change.over == 0) return model::scale_radii(bodies, std::array{row}, *change.radius_by);
  const auto i = static_cast<std::size_t>(row);
  if (bodies.ramp.empty()) bodies.ramp.resize(bodies.position.size());
  bodies.ramp[i] = {.radius = bodies.radius[i],
                    .mass = bodies.mass[i],
                    .inertia = bodies.inertia[i],
                    .factor = *change.radius_by,
                    .from = state.time,
                    .over = change.over};
}

void change_ball(State& state, std::int32_t row, const model::BodyChange& change) {
  model::Bodies& bodies = state.model.bodies;
  const auto i = static_cast<std::size_t>(row);
  bodies.fixed[i] = bodies.fixed[i].with(change.fix).without(change.free);
  const model::FixedComponents fixed = bodies.fixed[i];
  change_own(bodies, i, change);
  change_radius(state, row, change);
  if (change.velocity)
    bodies.velocity[i] = half_a_step_before(*change.velocity, state.force[i] + load_on(state.model, i),
                                            model::inertial_mass(bodies, i), state.dt, fixed.translation());
  if (change.spin)
    bodies.spin[i] = half_a_step_before(*change.spin, state.moment[i] + moment_on(state.model, i),
                                        model::inertial_moment(bodies, i), state.dt, fixed.rotation());
}

void change_clump(State& state, std::int32_t clump, const model::BodyChange& change,
                  const std::string& where) {
  model::Bodies& bodies = state.model.bodies;
  model::Clumps& clumps = bodies.clumps;
  const auto c = static_cast<std::size_t>(clump);
  const auto holder = static_cast<std::size_t>(clumps.holder(clump));
  if (change.radius_by)
    throw InputError(fmt::format(
        "{}: ball {} belongs to a clump, whose balls keep their size; leave clumps out of the selection",
        where, bodies.identity[holder]));
  const model::FixedComponents fixed = bodies.fixed[holder].with(change.fix).without(change.free);
  if (fixed.rotation() != 0 && fixed.rotation() != 7)
    throw InputError(
        fmt::format("{}: rotations of a clump are fixed all or none; name wx, wy and wz", where));
  change_own(bodies, holder, change);
  if (change.velocity) clumps.velocity[c] = *change.velocity;
  if (change.spin) {
    clumps.spin[c] = *change.spin;
    clumps.angular_momentum[c] = model::angular_momentum(clumps, clump, *change.spin);
  }
  for (const std::int32_t row : clumps.members(clump)) {
    const auto i = static_cast<std::size_t>(row);
    bodies.fixed[i] = fixed;
    if (change.damping) bodies.damping[i] = *change.damping;
    bodies.velocity[i] = clumps.velocity[c] + clumps.spin[c].cross(bodies.position[i] - clumps.position[c]);
    bodies.spin[i] = clumps.spin[c];
  }
}

/// Contacts and forces of a state whose balls have other sizes, or others beside them.
void begin_anew(State& state) {
  renew_list(state, state.list.skin);
  renew_forces(state);
}

bool overlaps_a_wall(const Model& model, const Vec3& x, double radius) {
  const auto behind = [&](const model::Plane& wall) { return (x - wall.point).dot(wall.normal) < radius; };
  if (std::any_of(model.walls.begin(), model.walls.end(), behind)) return true;
  std::vector<std::int32_t> near;
  for (std::size_t s = 0; s < model.surfaces.size(); ++s) {
    const Vec3 local = model.surface_places[s].to_local(x);
    near.clear();
    model.facet_trees[s].near(local, radius, near);
    for (const std::int32_t facet : near) {
      const auto& f = model.facets.facet[static_cast<std::size_t>(facet)];
      if ((contact::nearest_point(local, f).point - local).norm() < radius) return true;
    }
  }
  return false;
}

/// [new balls] whether each keeps clear of the balls and walls of the model.
std::vector<bool> free_places(const Model& model, const model::Bodies& balls) {
  std::vector<Vec3> centres = model.bodies.position;
  std::vector<double> radii = model.bodies.radius;
  const auto there = static_cast<std::int32_t>(centres.size());
  centres.insert(centres.end(), balls.position.begin(), balls.position.end());
  radii.insert(radii.end(), balls.radius.begin(), balls.radius.end());
  std::vector<bool> free(balls.position.size());
  for (std::size_t i = 0; i < free.size(); ++i)
    free[i] = !overlaps_a_wall(model, balls.position[i], balls.radius[i]);
  for (const search::CandidatePair& pair : search::candidate_pairs(centres, radii, model.cell))
    if (pair.a < there && pair.b >= there) free[static_cast<std::size_t>(pair.b - there)] = false;
  return free;
}

/// Appends rows to a column that may be absent on either side; `rest` stands for what is not there.
template <class T>
void append(std::vector<T>& column, std::size_t rows, const std::vector<T>& more, std::size_t more_rows,
            const T& rest) {
  if (column.empty() && more.empty()) return;
  column.resize(rows, rest);
  column.insert(column.end(), more.begin(), more.end());
  column.resize(rows + more_rows, rest);
}

}  // namespace

void change_bodies(State& state, const model::BodyChange& change, const std::string& where) {
  const SelectedBodies selection = selected_bodies(state, change.of, where);
  if ((change.spin || change.moment) && !state.turns()) {
    state.model.bodies.spin.assign(state.model.bodies.position.size(), Vec3::Zero());
    state.moment = state.model.bodies.spin;
  }
  for (const std::int32_t row : selection.rows) change_ball(state, row, change);
  for (const std::int32_t clump : selection.clumps) change_clump(state, clump, change, where);
  if (change.radius_by && change.over == 0) begin_anew(state);
  state.next_dt = 0;
  state.ledger.reset();
}

Added add_balls(State& state, const model::Bodies& balls) {
  model::Bodies& bodies = state.model.bodies;
  const std::vector<bool> free = free_places(state.model, balls);
  std::vector<std::int32_t> order;
  for (std::int32_t row = 0; row < balls.size(); ++row)
    if (free[static_cast<std::size_t>(row)]) order.push_back(row);
  const model::Bodies added = model::reordered(balls, order);
  const auto count = std::ssize(order);
  const auto there = static_cast<std::size_t>(bodies.size());
  const auto more = static_cast<std::size_t>(count);
  if (count > 0) {
    const auto all = [&](auto& column, const auto& new_rows) {
      column.insert(column.end(), new_rows.begin(), new_rows.end());
    };
    all(bodies.position, added.position);
    all(bodies.radius, added.radius);
    all(bodies.mass, added.mass);
    all(bodies.inertia, added.inertia);
    all(bodies.material, added.material);
    all(bodies.fixed, added.fixed);
    bodies.identity.resize(there + more);
    std::iota(bodies.identity.begin() + static_cast<std::ptrdiff_t>(there), bodies.identity.end(),
              static_cast<std::int64_t>(there));
    const Vec3 none = Vec3::Zero();
    append(bodies.velocity, there, added.velocity, more, none);
    if (state.turns()) append(bodies.spin, there, added.spin, more, none);
    append(bodies.orientation, there, added.orientation, more, Quat(Quat::Identity()));
    append(bodies.applied_force, there, added.applied_force, more, none);
    append(bodies.applied_moment, there, added.applied_moment, more, none);
    append(bodies.damping, there, added.damping, more, model::Bodies::scene_damping);
    append(bodies.ramp, there, added.ramp, more, model::RadiusRamp());
    append(bodies.mass_factor, there, added.mass_factor, more, 1.0);  // until masses are scaled anew
    state.force.resize(there + more, none);
    if (state.turns()) state.moment.resize(there + more, none);
    begin_anew(state);
    state.next_dt = 0;
    state.ledger.reset();
  }
  return {.balls = count, .left_out = balls.size() - count};
}

}  // namespace eigengrain::assembly
