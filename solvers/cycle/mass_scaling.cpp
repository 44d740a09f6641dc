#include "eigengrain/cycle/mass_scaling.hpp"

#include "eigengrain/assembly/linear_system.hpp"
#include "eigengrain/assembly/local_damping.hpp"
#include "eigengrain/cycle/bounds.hpp"

#include "first_contact.hpp"
#include "proven_step.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>
#include <vector>

namespace eigengrain::cycle {
namespace {

using assembly::State;

double square(double x) {
  return x * x;
}

/// The factor of each row's body; `before`: those that masses had, or none.
std::vector<double> differential_factors(const State& state, double wished,
                                         const std::vector<double>& before) {
  const model::Bodies& bodies = state.model.bodies;
  const assembly::LinearSystem system(state.model, assembly::Listed::all);
  std::vector<double> factor = BlockBound(system).eigenvalues();
  const double per_rate = square(0.5 * wished) * (1 + assembly::largest_damping(state.model));
  for (double& c : factor) c *= per_rate;

  std::vector<std::int32_t> judged = bodies_apart(state, system, stiffness_varies(state.settings));
  std::vector<char> apart(factor.size(), 0);
  for (const std::int32_t row : judged) apart[static_cast<std::size_t>(row)] = 1;
  const double approach = fastest_approach(state);
  double largest = 0;
  std::vector<std::size_t> unresisted;
  for (std::size_t i = 0; i < factor.size(); ++i) {
    const auto row = static_cast<std::int32_t>(i);
    if (bodies.fixed[i].all() || bodies.clumps.owner(row) != row) continue;
    if (factor[i] == 0 || apart[i] != 0) {
      // The energy of the impact is that of the scaled mass.
      const double scaled = approach * std::sqrt(before.empty() ? 1.0 : before[i]);
      const double bound = first_contact(state, std::array{row}, scaled).bound;
      factor[i] = std::max(factor[i], square(wished / bound));
    }
    if (factor[i] == 0) unresisted.push_back(i);
    largest = std::max(largest, factor[i]);
  }
  for (const std::size_t i : unresisted) factor[i] = largest > 0 ? largest : 1.0;
  for (std::size_t i = 0; i < factor.size(); ++i)
    factor[i] = bodies.fixed[i].all()
                    ? 1.0  // any will do
                    : factor[static_cast<std::size_t>(bodies.clumps.owner(static_cast<std::int32_t>(i)))];
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
  state.model.bodies.mass_factor = scaling.form == model::MassScaling::Form::uniform
                                       ? uniform_factors(state, wished)
                                       : differential_factors(state, wished, before);
}

}  // namespace eigengrain::cycle
