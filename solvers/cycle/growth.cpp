#include "growth.hpp"

#include "eigengrain/measures/ledger.hpp"

#include <vector>

namespace eigengrain::cycle {

namespace {

/// What radii can change at given places. Not the energy across n and against rolling: that of a contact at
/// the cone would follow F_n, which is the business of its slip.
double energy_along_normals(const assembly::Model& model) {
  const measures::ElasticEnergy energy = measures::elastic_energy(model);
  return energy.normal + energy.bonds;
}

}  // namespace

Growth::Growth(assembly::State& state, double dt)
    : state_(state),
      any_(model::radii_change(state.model.bodies, state.time, state.time + dt)),
      end_(state.time + dt) {
  if (!any_ || !state_.ledger) return;
  before_ = state_.model.bodies.radius;
  gain_ = elastic_gain();
}

void Growth::apply() {
  if (!any_) return;
  model::Bodies& bodies = state_.model.bodies;
  const bool counts = state_.ledger.has_value();
  const std::vector<double> mass = counts ? bodies.mass : std::vector<double>();
  const std::vector<double> inertia = counts ? bodies.inertia : std::vector<double>();
  state_.list.growth += model::set_radii(bodies, end_);
  if (!counts) return;
  double kinetic = 0;
  for (std::size_t i = 0; i < mass.size(); ++i) {
    kinetic += 0.5 * (bodies.mass[i] - mass[i]) * bodies.velocity[i].squaredNorm();
    if (state_.turns()) kinetic += 0.5 * (bodies.inertia[i] - inertia[i]) * bodies.spin[i].squaredNorm();
  }
  state_.ledger->integrals.growth += kinetic;
}

void Growth::count() {
  if (any_ && state_.ledger) state_.ledger->integrals.growth += 0.5 * (gain_ + elastic_gain());
}

double Growth::elastic_gain() {
  model::Bodies& bodies = state_.model.bodies;
  const std::vector<double> now = bodies.radius;
  bodies.radius = before_;
  const double small = energy_along_normals(state_.model);
  for (std::size_t i = 0; i < now.size(); ++i)
    if (bodies.ramp[i].factor != 1) bodies.radius[i] = bodies.ramp[i].scale(end_) * bodies.ramp[i].radius;
  const double large = energy_along_normals(state_.model);
  bodies.radius = now;
  return large - small;
}

}  // namespace eigengrain::cycle
