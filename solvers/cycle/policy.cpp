#include "eigengrain/cycle/policy.hpp"

#include "eigengrain/assembly/contact_list.hpp"
#include "eigengrain/assembly/linear_system.hpp"
#include "eigengrain/cycle/bounds.hpp"

#include "first_contact.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

namespace eigengrain::cycle {
namespace {

constexpr std::int64_t steps_between_estimates = 100;
/// Where stiffnesses follow the overlap. An impact takes some twenty steps.
constexpr std::int64_t steps_between_varying = 5;

double estimate(const assembly::State& state) {
  const assembly::LinearSystem system(state.model);
  return std::min(diagonal_estimate(system), first_contact(state, system.unknowns.set_aside()).estimate);
}

/// Where stiffness varies, a near pair is listed with that of a typical overlap, and its impact counts as
/// well.
double bound(const assembly::State& state, bool varies) {
  const assembly::LinearSystem system(state.model, assembly::Listed::all);
  const std::vector<std::int32_t> apart =
      varies ? assembly::LinearSystem(state.model).unknowns.set_aside() : system.unknowns.set_aside();
  return std::min(damped_block_bound(system, state.model.local_damping), first_contact(state, apart).bound);
}

/// Whether stiffnesses follow the overlap, so that a step has to be asked for while nothing opens or closes.
bool stiffness_varies(const model::Scene& settings) {
  bool varies = false;
  for (std::size_t r = 0; r < settings.contacts.size(); ++r) {
    if (settings.contacts[r].law == "none") continue;
    const auto index = static_cast<std::int32_t>(r);
    const double low = head_on(settings.contacts[r], index, 1.0).stiffness.normal;
    varies = varies || low != head_on(settings.contacts[r], index, 2.0).stiffness.normal;
  }
  return varies;
}

/// Between lists a bound holds, but where stiffnesses follow the overlap, or balls come to touch other
/// triangles.
std::int64_t between_bounds(const model::Scene& settings, bool varies) {
  if (varies) return steps_between_varying;
  return settings.surfaces.empty() ? 0 : steps_between_estimates;
}

}  // namespace

TimestepPolicy policy_of(const model::Scene& settings) {
  const model::TimestepChoice choice = settings.timestep;
  const bool varies = stiffness_varies(settings);
  switch (choice.policy) {
    case model::TimestepPolicy::fixed:
      return {[dt = choice.dt.value_or(0)](const assembly::State&) { return dt; }, 0};
    case model::TimestepPolicy::bound:
      return {[choice, varies](const assembly::State& state) { return choice.safety * bound(state, varies); },
              between_bounds(settings, varies)};
    case model::TimestepPolicy::estimate:
      break;
  }
  return {[choice](const assembly::State& state) { return choice.safety * estimate(state); },
          varies ? steps_between_varying : steps_between_estimates};
}

}  // namespace eigengrain::cycle
