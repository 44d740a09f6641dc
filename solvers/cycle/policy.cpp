#include "eigengrain/cycle/policy.hpp"

#include "eigengrain/assembly/contact_list.hpp"
#include "eigengrain/assembly/linear_system.hpp"
#include "eigengrain/cycle/bounds.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <span>

namespace eigengrain::cycle {
namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();
constexpr std::int64_t steps_between_estimates = 100;

/// Overlap over radius at which a contact that does not exist yet is judged; only laws whose stiffness grows
/// with the overlap depend on it.
constexpr double typical_overlap = 1e-3;

/// The lightest of some balls that is of a material and can move; nothing where there is none.
std::optional<std::int32_t> lightest(const model::Bodies& bodies, std::span<const std::int32_t> balls,
                                     std::int32_t material) {
  std::optional<std::int32_t> found;
  for (const std::int32_t i : balls)
    if (bodies.material[i] == material && (!found || bodies.mass[i] < bodies.mass[*found])) found = i;
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

/// The steps that the first contact of a ball allows, s.
struct FirstContact {
  double estimate = infinity;  ///< √(m/k), √(I/k) of the degrees of freedom apart
  double bound = infinity;     ///< √(2/λ), λ the largest eigenvalue of the ball's block: proven
};

/// Of balls that touch nothing yet, for any head-on contact that the rules of the scene allow.
FirstContact first_contact(const model::Scene& settings, const model::Bodies& bodies,
                           std::span<const std::int32_t> balls) {
  FirstContact result;
  const auto materials = static_cast<std::int32_t>(settings.materials.size());
  for (std::int32_t a = 0; a < materials; ++a) {
    const auto ball = lightest(bodies, balls, a);
    if (!ball) continue;
    const double radius = bodies.radius[*ball];
    const double mass = bodies.mass[*ball];
    const double inertia = bodies.inertia[*ball];
    for (std::int32_t b = 0; b < materials; ++b) {
      const std::int32_t rule = settings.rule_for(a, b);
      if (rule < 0 || settings.contacts[rule].law == "none") continue;
      const contact::ContactStiffness k = head_on_stiffness(settings.contacts[rule], rule, radius);
      const double turning = std::max(k.shear * radius * radius + k.bending, k.twist);
      const double diagonal = std::max(std::max(k.normal, k.shear) / mass, turning / inertia);
      const double block = std::max(k.normal / mass, k.shear / mass + turning / inertia);
      if (diagonal > 0) result.estimate = std::min(result.estimate, 1 / std::sqrt(diagonal));
      if (block > 0) result.bound = std::min(result.bound, std::sqrt(2 / block));
    }
  }
  return result;
}

double estimate(const assembly::State& state) {
  const assembly::LinearSystem system(state.model);
  const auto& alone = system.unknowns.set_aside();
  return std::min(diagonal_estimate(system),
                  first_contact(state.settings, state.model.bodies, alone).estimate);
}

double bound(const assembly::State& state) {
  const assembly::LinearSystem system(state.model, assembly::Listed::all);
  const auto& alone = system.unknowns.set_aside();
  return damped_timestep(
      std::min(scaled_block_bound(system), first_contact(state.settings, state.model.bodies, alone).bound),
      state.model.local_damping);
}

}  // namespace

TimestepPolicy policy_of(const model::Scene& settings) {
  const model::TimestepChoice choice = settings.timestep;
  switch (choice.policy) {
    case model::TimestepPolicy::fixed:
      return {[dt = choice.dt.value_or(0)](const assembly::State&) { return dt; }, 0};
    case model::TimestepPolicy::bound:
      return {[choice](const assembly::State& state) { return choice.safety * bound(state); }, 0};
    case model::TimestepPolicy::estimate:
      break;
  }
  return {[choice](const assembly::State& state) { return choice.safety * estimate(state); },
          steps_between_estimates};
}

}  // namespace eigengrain::cycle
