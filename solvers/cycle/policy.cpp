#include "eigengrain/cycle/policy.hpp"

#include "eigengrain/assembly/contact_list.hpp"
#include "eigengrain/assembly/linear_system.hpp"
#include "eigengrain/cycle/bounds.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <vector>

namespace eigengrain::cycle {
namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();
constexpr std::int64_t steps_between_estimates = 100;

/// Overlap over radius at which a contact that does not exist yet is judged; only laws whose stiffness grows
/// with the overlap depend on it.
constexpr double typical_overlap = 1e-3;

/// The lightest ball of a material that can move, as its row in the bodies; nothing where there is none.
std::optional<std::size_t> lightest(const model::Bodies& bodies, std::int32_t material) {
  std::optional<std::size_t> found;
  for (std::size_t i = 0; i < bodies.mass.size(); ++i)
    if (bodies.material[i] == material && !bodies.fixed[i].all() &&
        (!found || bodies.mass[i] < bodies.mass[*found]))
      found = i;
  return found;
}

contact::ContactStiffness head_on_stiffness(const model::ContactRule& rule, std::int32_t index,
                                            double radius) {
  const contact::AnyGroup group = assembly::new_group(contact::BallBall::name, rule, index);
  return std::visit(
      [&](const auto& g) {
        const Vec3 n = Vec3::UnitZ();
        const contact::ContactMotion motion{.normal = n, .overlap = typical_overlap * radius};
        return g.law.stiffness(motion, g.law.formed(n));
      },
      group);
}

}  // namespace

double single_contact_estimate(const model::Scene& settings, const model::Bodies& bodies) {
  double dt = infinity;
  const auto materials = static_cast<std::int32_t>(settings.materials.size());
  for (std::int32_t a = 0; a < materials; ++a) {
    const auto ball = lightest(bodies, a);
    if (!ball) continue;
    const double radius = bodies.radius[*ball];
    for (std::int32_t b = 0; b < materials; ++b) {
      const std::int32_t rule = settings.rule_for(a, b);
      if (rule < 0 || settings.contacts[rule].law == "none") continue;
      const contact::ContactStiffness k = head_on_stiffness(settings.contacts[rule], rule, radius);
      const double turning = std::max({k.shear * radius * radius, k.bending, k.twist});
      if (k.normal > 0) dt = std::min(dt, std::sqrt(bodies.mass[*ball] / std::max(k.normal, k.shear)));
      if (turning > 0) dt = std::min(dt, std::sqrt(bodies.inertia[*ball] / turning));
    }
  }
  return dt;
}

TimestepPolicy policy_of(const model::Scene& settings) {
  const model::TimestepChoice choice = settings.timestep;
  switch (choice.policy) {
    case model::TimestepPolicy::fixed:
      return {[dt = choice.dt.value_or(0)](const assembly::State&) { return dt; }, 0};
    case model::TimestepPolicy::bound:
      return {[choice](const assembly::State& state) {
                const assembly::LinearSystem system(state.model, assembly::Listed::all);
                const double bound = std::min(scaled_block_bound(system),
                                              single_contact_estimate(state.settings, state.model.bodies));
                return choice.safety * damped_timestep(bound, state.model.local_damping);
              },
              0};
    case model::TimestepPolicy::estimate:
      break;
  }
  return {[choice](const assembly::State& state) {
            const assembly::LinearSystem system(state.model);
            return choice.safety * std::min(diagonal_estimate(system),
                                            single_contact_estimate(state.settings, state.model.bodies));
          },
          steps_between_estimates};
}

}  // namespace eigengrain::cycle
