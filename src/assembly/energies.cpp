#include "eigengrain/assembly/energies.hpp"

#include "eigengrain/assembly/cell_motion.hpp"
#include "eigengrain/assembly/clump_members.hpp"
#include "eigengrain/assembly/forces.hpp"
#include "eigengrain/assembly/loads.hpp"

namespace eigengrain::assembly {
namespace {

/// Adds what a clump has, with its tensor of inertia as it lies at t, of its inertial mass: that is what the
/// cycle moves.
void add_clump(const State& state, std::int32_t clump, const Fluctuation& fluctuation,
               const BodyForces& gathered, Energies& result) {
  const model::Bodies& bodies = state.model.bodies;
  const model::Clumps& clumps = bodies.clumps;
  const auto c = static_cast<std::size_t>(clump);
  const auto holder = static_cast<std::size_t>(clumps.holder(clump));
  const double factor = model::mass_factor_of(bodies, holder);
  const double m = factor * clumps.mass[c];
  const Vec3 v = fluctuation.of(clumps.velocity[c], clumps.position[c]);
  const Vec3 a = (gathered.force[holder] + load_on(state.model, holder)) / m;
  const model::FixedComponents fixed = bodies.fixed[holder];
  const Vec3 w = model::angular_velocity(clumps, clump);
  result.kinetic += 0.5 * m * v.squaredNorm() + 0.5 * factor * w.dot(clumps.angular_momentum[c]);
  result.kinetic_product += 0.5 * m * v.dot(v + model::free_part(state.dt * a, fixed.translation()));
  // ½ w₋·L₊, as I is the same for both.
  Vec3 momentum = factor * clumps.angular_momentum[c];
  if (fixed.rotation() == 0)
    momentum += state.dt * (gathered.moment[holder] + moment_on(state.model, holder));
  result.kinetic_product += 0.5 * w.dot(momentum);
  result.gravitational -= clumps.mass[c] * state.model.gravity.dot(clumps.position[c]);
}

}  // namespace

Energies energies_of(const State& state) {
  const model::Bodies& bodies = state.model.bodies;
  Energies result{.elastic = elastic_energy(state.model)};
  const Fluctuation fluctuation(state.model.cell);
  for (std::size_t i = 0; i < bodies.position.size(); ++i) {
    if (bodies.clumps.of(static_cast<std::int32_t>(i)) != model::Clumps::none) continue;
    const double m = model::inertial_mass(bodies, i);
    const Vec3 v = fluctuation.of(bodies.velocity[i], bodies.position[i]);
    const Vec3 a = (state.force[i] + load_on(state.model, i)) / m;
    result.kinetic += 0.5 * m * v.squaredNorm();
    result.kinetic_product +=
        0.5 * m * v.dot(v + model::free_part(state.dt * a, bodies.fixed[i].translation()));
    result.gravitational -= bodies.mass[i] * state.model.gravity.dot(bodies.position[i]);
    if (!state.turns()) continue;
    const double inertia = model::inertial_moment(bodies, i);
    const Vec3& w = bodies.spin[i];
    result.kinetic += 0.5 * inertia * w.squaredNorm();
    result.kinetic_product +=
        0.5 * inertia *
        w.dot(w + model::free_part(state.dt / inertia * (state.moment[i] + moment_on(state.model, i)),
                                   bodies.fixed[i].rotation()));
  }
  if (bodies.clumps.empty()) return result;
  BodyForces gathered{state.force, state.moment};
  gather_members(bodies, {}, gathered);
  for (std::int32_t c = 0; c < bodies.clumps.size(); ++c) add_clump(state, c, fluctuation, gathered, result);
  return result;
}

}  // namespace eigengrain::assembly
