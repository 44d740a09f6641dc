#include "eigengrain/assembly/energies.hpp"

#include "eigengrain/assembly/forces.hpp"

namespace eigengrain::assembly {
Energies energies_of(const State& state) {
  const model::Bodies& bodies = state.model.bodies;
  Energies result{.elastic = elastic_energy(state.model)};
  for (std::size_t i = 0; i < bodies.position.size(); ++i) {
    const double m = bodies.mass[i];
    const Vec3& v = bodies.velocity[i];
    const Vec3 a = state.force[i] / m + state.model.gravity;
    result.kinetic += 0.5 * m * v.squaredNorm();
    result.kinetic_product +=
        0.5 * m * v.dot(v + model::free_part(state.dt * a, bodies.fixed[i].translation()));
    result.gravitational -= m * state.model.gravity.dot(bodies.position[i]);
    if (!state.turns()) continue;
    const double inertia = bodies.inertia[i];
    const Vec3& w = bodies.spin[i];
    result.kinetic += 0.5 * inertia * w.squaredNorm();
    result.kinetic_product +=
        0.5 * inertia *
        w.dot(w + model::free_part(state.dt / inertia * state.moment[i], bodies.fixed[i].rotation()));
  }
  return result;
}

}  // namespace eigengrain::assembly
