#include "probe.hpp"

#include "eigengrain/assembly/acting.hpp"
#include "eigengrain/assembly/clump_members.hpp"
#include "eigengrain/assembly/forces.hpp"
#include "eigengrain/measures/acting_contacts.hpp"

#include "cycle/first_contact.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <utility>

namespace eigengrain::timestep {
namespace {

/// Where the three numbers of a block begin.
std::ptrdiff_t first_of(std::int32_t block) {
  return static_cast<std::ptrdiff_t>(assembly::Unknowns::block_size) * block;
}

/// Overlaps of this part of the radius change eigenvalues by as much, which no accuracy asked for sees.
constexpr double unstressed = 1e-8;

void stop(assembly::State& state) {
  model::Bodies& bodies = state.model.bodies;
  const Vec3 zero = Vec3::Zero();
  std::fill(bodies.velocity.begin(), bodies.velocity.end(), zero);
  std::fill(bodies.spin.begin(), bodies.spin.end(), zero);
  model::Clumps& clumps = bodies.clumps;
  std::fill(clumps.velocity.begin(), clumps.velocity.end(), zero);
  std::fill(clumps.angular_momentum.begin(), clumps.angular_momentum.end(), zero);
  std::fill(clumps.spin.begin(), clumps.spin.end(), zero);
  bodies.ramp.clear();
  state.list.growth = 0;
  state.model.cell.velocity_gradient.setZero();
  state.model.cell.rate.setZero();
  state.model.wall_motions.clear();
  state.model.wall_poses.clear();
  state.list.wall_lever.clear();
  state.list.wall_way = 0;
}

std::int64_t acting(const assembly::Model& model) {
  std::int64_t count = 0;
  assembly::for_each_acting(model, [&](const auto&, std::size_t, const auto&) { ++count; });
  return count;
}

std::int64_t sliding(const assembly::Model& model) {
  const std::vector<measures::ActingContact> contacts = measures::acting_contacts(model);
  return std::count_if(contacts.begin(), contacts.end(), [](const auto& c) { return c.slides; });
}

/// The largest spring force of a contact over k_n R, R that of its first ball.
double prestress(const assembly::Model& model) {
  double most = 0;
  const contact::Placement placement = model.placement();
  assembly::for_each_acting(model, placement, [&](const auto& group, std::size_t c, const auto& geometry) {
    const contact::Pair& pair = group.pairs[c];
    const double force =
        contact::spring_force(group.law, placement, pair, geometry, group.states[c]).force.norm();
    const double k = group.law.stiffness(contact::at_rest(geometry), group.states[c]).normal;
    if (k > 0) most = std::max(most, force / (k * model.bodies.radius[pair.a]));
  });
  return most;
}

}  // namespace

void add_once(std::vector<std::string>& all, std::string text) {
  if (std::find(all.begin(), all.end(), text) == all.end()) all.push_back(std::move(text));
}

assembly::State in_balance(assembly::State state) {
  stop(state);
  state.ledger.reset();
  state.breaks.clear();
  state.dt = 0;
  assembly::forget_step(state);
  assembly::renew_forces(state);
  model::Bodies& bodies = state.model.bodies;
  assembly::BodyForces sum{state.force, state.moment};
  if (!bodies.clumps.empty()) assembly::gather_members(bodies, {}, sum);
  for (std::size_t i = 0; i < sum.force.size(); ++i)
    sum.force[i] = -(sum.force[i] + bodies.mass[i] * state.model.gravity);
  for (Vec3& moment : sum.moment) moment = -moment;
  bodies.applied_force = std::move(sum.force);
  bodies.applied_moment = std::move(sum.moment);
  return state;
}

void Motion::set(assembly::State& state, std::span<const double> v, double factor) const {
  model::Bodies& bodies = state.model.bodies;
  model::Clumps& clumps = bodies.clumps;
  for (std::int32_t block = 0; block < system_.unknowns.blocks(); ++block) {
    const std::int32_t body = system_.unknowns.body(block);
    const auto i = static_cast<std::size_t>(body);
    const Vec3 value = factor * Eigen::Map<const Vec3>(v.data() + first_of(block));
    const std::int32_t clump = clumps.of(body);
    const auto c = static_cast<std::size_t>(clump);
    if (clump == model::Clumps::none) {
      (system_.unknowns.is_rotation(block) ? bodies.spin : bodies.velocity)[i] = value;
    } else if (system_.unknowns.is_rotation(block)) {
      clumps.spin[c] = clumps.orientation[c] * value;
      clumps.angular_momentum[c] = model::angular_momentum(clumps, clump, clumps.spin[c]);
    } else {
      clumps.velocity[c] = value;
    }
  }
}

void Motion::get(const assembly::State& state, std::span<double> y) const {
  const model::Bodies& bodies = state.model.bodies;
  const model::Clumps& clumps = bodies.clumps;
  for (std::int32_t block = 0; block < system_.unknowns.blocks(); ++block) {
    const std::int32_t body = system_.unknowns.body(block);
    const auto i = static_cast<std::size_t>(body);
    const std::int32_t clump = clumps.of(body);
    const auto c = static_cast<std::size_t>(clump);
    Vec3 v = Vec3::Zero();
    if (clump == model::Clumps::none)
      v = (system_.unknowns.is_rotation(block) ? bodies.spin : bodies.velocity)[i];
    else if (system_.unknowns.is_rotation(block))
      v = (clumps.orientation[c].conjugate() * clumps.angular_momentum[c]).cwiseQuotient(clumps.inertia[c]);
    else
      v = clumps.velocity[c];
    for (int k = 0; k < assembly::Unknowns::block_size; ++k) {
      const auto number = static_cast<std::size_t>(first_of(block) + k);
      y[number] = system_.unknowns.is_fixed(block, k) ? 0.0 : std::sqrt(system_.mass[number]) * v[k];
    }
  }
}

double Motion::fastest_surface(const assembly::State& state, std::span<const double> v) const {
  const model::Bodies& bodies = state.model.bodies;
  double most = 0;
  for (std::int32_t block = 0; block < system_.unknowns.blocks(); ++block) {
    const std::int32_t body = system_.unknowns.body(block);
    const std::int32_t clump = bodies.clumps.of(body);
    double arm = 1;
    if (system_.unknowns.is_rotation(block))
      arm = clump == model::Clumps::none ? bodies.radius[static_cast<std::size_t>(body)]
                                         : bodies.clumps.radius[static_cast<std::size_t>(clump)];
    const Eigen::Map<const Vec3> value(v.data() + first_of(block));
    most = std::max(most, arm * value.cwiseAbs().maxCoeff());
  }
  return most;
}

std::vector<std::string> reservations_about(const assembly::State& state) {
  std::vector<std::string> all;
  if (const double stress = prestress(state.model); stress > unstressed)
    all.push_back(fmt::format(
        "contacts bear up to {:.1e} of k_n R, and what that adds to the stiffness is not in K", stress));
  if (cycle::stiffness_varies(state.settings)) all.emplace_back("the stiffness follows the overlap");
  if (sliding(state.model) > 0) all.emplace_back("contacts slide");
  return all;
}

void add_changes(const assembly::State& before, const assembly::State& after,
                 std::vector<std::string>& reservations) {
  if (acting(before.model) != acting(after.model))
    add_once(reservations, "contacts opened or formed while it was tried");
  if (sliding(after.model) > 0 && sliding(before.model) == 0)
    add_once(reservations, "contacts slid while it was tried, which hides growth");
  if (!after.breaks.empty()) add_once(reservations, "bonds broke while it was tried");
}

}  // namespace eigengrain::timestep
