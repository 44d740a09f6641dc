#include "eigengrain/assembly/energies.hpp"

#include "eigengrain/assembly/forces.hpp"

namespace eigengrain::assembly {
namespace {

/// What the free components of v gain in dt.
Vec3 gain(const Vec3& acceleration, std::uint8_t fixed, double dt) {
  Vec3 result = dt * acceleration;
  for (int k = 0; k < 3; ++k)
    if (((fixed >> k) & 1) != 0) result[k] = 0;
  return result;
}

}  // namespace

Energies energies_of(const State& state) {
  const model::Bodies& bodies = state.model.bodies;
  Energies result{.elastic = elastic_energy(state.model)};
  for (std::size_t i = 0; i < bodies.position.size(); ++i) {
    const double m = bodies.mass[i];
    const Vec3& v = bodies.velocity[i];
    const Vec3 a = state.force[i] / m + state.model.gravity;
    result.kinetic += 0.5 * m * v.squaredNorm();
    result.kinetic_product += 0.5 * m * v.dot(v + gain(a, bodies.fixed[i].translation(), state.dt));
    result.gravitational -= m * state.model.gravity.dot(bodies.position[i]);
    if (!state.turns()) continue;
    const double inertia = bodies.inertia[i];
    const Vec3& w = bodies.spin[i];
    result.kinetic += 0.5 * inertia * w.squaredNorm();
    result.kinetic_product +=
        0.5 * inertia * w.dot(w + gain(state.moment[i] / inertia, bodies.fixed[i].rotation(), state.dt));
  }
  return result;
}

}  // namespace eigengrain::assembly
