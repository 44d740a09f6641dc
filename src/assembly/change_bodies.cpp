#include "eigengrain/assembly/change_bodies.hpp"

#include "eigengrain/assembly/clump_members.hpp"
#include "eigengrain/assembly/contact_list.hpp"
#include "eigengrain/assembly/forces.hpp"
#include "eigengrain/assembly/half_step.hpp"
#include "eigengrain/assembly/loads.hpp"
#include "eigengrain/assembly/selection.hpp"
#include "eigengrain/base/error.hpp"

#include <fmt/format.h>

#include <array>
#include <set>
#include <vector>

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
  for (const std::int32_t row : selected(state.model.bodies, state.groups, selection, where))
    if (const std::int32_t clump = clumps.of(row); clump == model::Clumps::none)
      result.rows.push_back(row);
    else
      result.clumps.insert(clump);
  if (result.rows.empty() && result.clumps.empty())
    throw InputError(fmt::format("{}: no ball is meant; look at where the balls are", where));
  return result;
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
  if (!change.growth) return;
  if (change.over == 0) return model::scale_radii(bodies, std::array{row}, *change.growth);
  const auto i = static_cast<std::size_t>(row);
  if (bodies.ramp.empty()) bodies.ramp.resize(bodies.position.size());
  bodies.ramp[i] = {.radius = bodies.radius[i],
                    .mass = bodies.mass[i],
                    .inertia = bodies.inertia[i],
                    .factor = *change.growth,
                    .from = state.time,
                    .over = change.over};
}

/// All but velocities.
void change_ball(State& state, std::int32_t row, const model::BodyChange& change) {
  model::Bodies& bodies = state.model.bodies;
  const auto i = static_cast<std::size_t>(row);
  bodies.fixed[i] = bodies.fixed[i].with(change.fix).without(change.free);
  change_own(bodies, i, change);
  change_radius(state, row, change);
}

/// The velocity of the flow of a periodic cell, beside which velocities are given.
Vec3 flow_at(const model::PeriodicCell& cell, const Vec3& x) {
  return cell.flow_gradient() * (x - cell.origin);
}

/// Forces are those of the changed bodies.
void set_ball_in_motion(State& state, std::int32_t row, const model::BodyChange& change) {
  model::Bodies& bodies = state.model.bodies;
  const auto i = static_cast<std::size_t>(row);
  const model::FixedComponents fixed = bodies.fixed[i];
  if (change.velocity)
    bodies.velocity[i] = half_a_step_before(*change.velocity + flow_at(state.model.cell, bodies.position[i]),
                                            state.force[i] + load_on(state.model, i),
                                            model::inertial_mass(bodies, i), state.dt, fixed.translation());
  if (change.spin)
    bodies.spin[i] = half_a_step_before(*change.spin, state.moment[i] + moment_on(state.model, i),
                                        model::inertial_moment(bodies, i), state.dt, fixed.rotation());
}

/// All but velocities.
void change_clump(State& state, std::int32_t clump, const model::BodyChange& change,
                  const std::string& where) {
  model::Bodies& bodies = state.model.bodies;
  const model::Clumps& clumps = bodies.clumps;
  const auto holder = static_cast<std::size_t>(clumps.holder(clump));
  if (change.growth)
    throw InputError(fmt::format(
        "{}: ball {} belongs to a clump, whose balls keep their size; leave clumps out of the selection",
        where, bodies.identity[holder]));
  const model::FixedComponents fixed = bodies.fixed[holder].with(change.fix).without(change.free);
  if (fixed.rotation() != 0 && fixed.rotation() != 7)
    throw InputError(
        fmt::format("{}: rotations of a clump are fixed all or none; name wx, wy and wz", where));
  change_own(bodies, holder, change);
  for (const std::int32_t row : clumps.members(clump)) {
    const auto i = static_cast<std::size_t>(row);
    bodies.fixed[i] = fixed;
    if (change.damping) bodies.damping[i] = *change.damping;
  }
}

void set_clump_in_motion(State& state, std::int32_t clump, const model::BodyChange& change) {
  model::Bodies& bodies = state.model.bodies;
  model::Clumps& clumps = bodies.clumps;
  const auto c = static_cast<std::size_t>(clump);
  const auto holder = static_cast<std::size_t>(clumps.holder(clump));
  const model::FixedComponents fixed = bodies.fixed[holder];
  const Resultant contacts = resultant_on(bodies, clump, state.force, state.moment);
  const double factor = model::mass_factor_of(bodies, holder);
  if (change.velocity)
    clumps.velocity[c] = half_a_step_before(*change.velocity + flow_at(state.model.cell, clumps.position[c]),
                                            contacts.force + load_on(state.model, holder),
                                            factor * clumps.mass[c], state.dt, fixed.translation());
  if (change.spin) {
    clumps.spin[c] = *change.spin;
    clumps.angular_momentum[c] = model::angular_momentum(clumps, clump, *change.spin);
    if (fixed.rotation() == 0) {
      clumps.angular_momentum[c] -=
          0.5 * state.dt / factor * (contacts.moment + moment_on(state.model, holder));
      clumps.spin[c] = model::angular_velocity(clumps, clump);
    }
  }
  for (const std::int32_t row : clumps.members(clump)) {
    const auto i = static_cast<std::size_t>(row);
    bodies.velocity[i] = clumps.velocity[c] + clumps.spin[c].cross(bodies.position[i] - clumps.position[c]);
    bodies.spin[i] = clumps.spin[c];
  }
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
  if (change.growth && change.over == 0) {
    renew_list(state, state.list.skin);
    renew_forces(state);
  }
  for (const std::int32_t row : selection.rows) set_ball_in_motion(state, row, change);
  for (const std::int32_t clump : selection.clumps) set_clump_in_motion(state, clump, change);
  forget_step(state);
  state.ledger.reset();
}

}  // namespace eigengrain::assembly
