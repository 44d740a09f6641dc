#include "eigengrain/cycle/mass_scaling.hpp"

#include "eigengrain/assembly/linear_system.hpp"
#include "eigengrain/assembly/local_damping.hpp"
#include "eigengrain/assembly/within_rooms.hpp"
#include "eigengrain/cycle/bounds.hpp"
#include "eigengrain/cycle/lift.hpp"

#include "first_contact.hpp"
#include "proven_step.hpp"
#include "tracked_step.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <span>
#include <utility>
#include <vector>

namespace eigengrain::cycle {
namespace {

using assembly::State;

double square(double x) {
  return x * x;
}

/// Whether a row stands for a body that can move.
bool moves(const model::Bodies& bodies, std::size_t i) {
  const auto row = static_cast<std::int32_t>(i);
  return !bodies.fixed[i].all() && bodies.clumps.owner(row) == row;
}

/// Raises the factors of bodies that may meet others to what their first contact needs. Those that have none
/// yet (zero) keep none where nothing would resist them.
///
/// before  the factors that masses had, or none
void count_first_contacts(const State& state, const assembly::LinearSystem& system, double wished,
                          const std::vector<double>& before, std::vector<double>& factor) {
  std::vector<char> apart(factor.size(), 0);
  for (const std::int32_t row : bodies_apart(state, system, stiffness_varies(state.settings)))
    apart[static_cast<std::size_t>(row)] = 1;
  const double approach = fastest_approach(state);
  for (std::size_t i = 0; i < factor.size(); ++i) {
    if (!moves(state.model.bodies, i) || (factor[i] != 0 && apart[i] == 0)) continue;
    // The energy of the impact is that of the scaled mass.
    const double scaled = approach * std::sqrt(before.empty() ? 1.0 : before[i]);
    const double bound = first_contact(state, std::array{static_cast<std::int32_t>(i)}, scaled).bound;
    factor[i] = std::max(factor[i], square(wished / bound));
  }
}

/// All rows of a clump have the factor of its holder; what cannot move has one, as any will do.
void spread_to_members(const model::Bodies& bodies, std::vector<double>& factor) {
  for (std::size_t i = 0; i < factor.size(); ++i)
    factor[i] = bodies.fixed[i].all()
                    ? 1.0
                    : factor[static_cast<std::size_t>(bodies.clumps.owner(static_cast<std::int32_t>(i)))];
}

std::vector<double> differential_factors(const State& state, double wished,
                                         const std::vector<double>& before) {
  const model::Bodies& bodies = state.model.bodies;
  const assembly::LinearSystem system(state.model, assembly::Listed::all);
  std::vector<double> factor = BlockBound(system).eigenvalues();
  const double per_rate = square(0.5 * wished) * (1 + assembly::largest_damping(state.model));
  for (double& c : factor) c *= per_rate;
  count_first_contacts(state, system, wished, before, factor);
  double largest = 0;
  for (std::size_t i = 0; i < factor.size(); ++i)
    if (moves(bodies, i)) largest = std::max(largest, factor[i]);
  for (std::size_t i = 0; i < factor.size(); ++i)
    if (moves(bodies, i) && factor[i] == 0) factor[i] = largest > 0 ? largest : 1.0;
  spread_to_members(bodies, factor);
  return factor;
}

/// The lift that a run makes: with few sweeps, which come within a few percent of what more would find, and
/// with the largest α for all.
///
/// growth  [bodies] of what the block of each counts for more (assembly::WithinRooms); empty: nothing
Lift lift_in_run(const State& state, const assembly::LinearSystem& system, double wished,
                 std::span<const double> growth = {}) {
  const std::vector<double>& mass = state.model.bodies.mass;
  const double alpha = assembly::largest_damping(state.model);
  std::vector<double> damping(mass.size(), alpha);
  for (std::size_t i = 0; i < growth.size(); ++i) damping[i] = (1 + alpha) * growth[i] - 1;
  return lift(system, mass, damping, wished, {.sweeps = 10});
}

std::vector<double> selective_factors(const State& state, double wished, const std::vector<double>& before) {
  const model::Bodies& bodies = state.model.bodies;
  const assembly::LinearSystem system(state.model, assembly::Listed::all);
  std::vector<double> factor = lift_in_run(state, system, wished).factor;
  count_first_contacts(state, system, wished, before, factor);
  spread_to_members(bodies, factor);
  return factor;
}

std::vector<double> uniform_factors(const State& state, double wished) {
  const double bound = proven_step(state, stiffness_varies(state.settings));
  const double factor = std::isfinite(bound) ? square(wished / bound) : 1.0;
  return std::vector<double>(state.model.bodies.position.size(), factor);
}

}  // namespace

void scale_masses(State& state) {
  const model::MassScaling& scaling = state.settings.mass_scaling.value();
  const double wished = scaling.dt / state.settings.timestep.safety;  // to be proven
  const std::vector<double> before = std::exchange(state.model.bodies.mass_factor, {});
  std::vector<double> factor;
  switch (scaling.form) {
    case model::MassScaling::Form::uniform:
      factor = uniform_factors(state, wished);
      break;
    case model::MassScaling::Form::selective:
      factor = selective_factors(state, wished, before);
      break;
    case model::MassScaling::Form::differential:
      factor = differential_factors(state, wished, before);
  }
  state.model.bodies.mass_factor = std::move(factor);
}

void track_masses(State& state, StepTracker& tracker) {
  const model::MassScaling& scaling = state.settings.mass_scaling.value();
  const double wished = scaling.dt / state.settings.timestep.safety;
  tracker.renew(state);
  if (!state.guard) return scale_masses(state);
  assembly::StepGuard& guard = *state.guard;
  if (guard.dt >= wished) return;
  tracker.forget();
  model::Bodies& bodies = state.model.bodies;
  bodies.mass_factor.clear();
  const assembly::WithinRooms contacts(state.model, guard.position, guard.room,
                                       guard.wall_way - state.list.wall_way);
  // A little more than needed, so that what holds exactly does not fail by rounding when it is proven again.
  Lift chosen = lift_in_run(state, contacts.system(), wished * (1 + 1e-9), contacts.growth());
  spread_to_members(bodies, chosen.factor);
  bodies.mass_factor = std::move(chosen.factor);
  guard.weight = std::move(chosen.weight);
  guard.dt = wished;
}

ScaledMasses scaled_masses(const model::Bodies& bodies) {
  ScaledMasses result;
  for (std::size_t i = 0; i < bodies.mass.size(); ++i) {
    if (!moves(bodies, i)) continue;
    const double factor = model::mass_factor_of(bodies, i);
    ++result.bodies;
    if (factor > 1) ++result.heavier;
    result.mass += bodies.mass[i];
    result.added += (factor - 1) * bodies.mass[i];
    result.largest = std::max(result.largest, factor);
  }
  return result;
}

}  // namespace eigengrain::cycle
