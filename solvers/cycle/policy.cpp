#include "eigengrain/cycle/policy.hpp"

#include "eigengrain/assembly/contact_list.hpp"
#include "eigengrain/assembly/linear_system.hpp"
#include "eigengrain/cycle/bounds.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <span>
#include <vector>

namespace eigengrain::cycle {
namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();
constexpr std::int64_t steps_between_estimates = 100;
/// Where stiffnesses follow the overlap. An impact takes some twenty steps.
constexpr std::int64_t steps_between_varying = 5;

/// The lightest of some balls that is of a material and can move; nothing where there is none.
std::optional<std::int32_t> lightest(const model::Bodies& bodies, std::span<const std::int32_t> balls,
                                     std::int32_t material) {
  std::optional<std::int32_t> found;
  for (const std::int32_t i : balls)
    if (bodies.material[i] == material && (!found || bodies.mass[i] < bodies.mass[*found])) found = i;
  return found;
}

/// What a head-on contact of a ball with a wall, or a ball that is far larger, is like when it has stored an
/// energy (or at the typical overlap, where that stores more).
struct HeadOn {
  contact::ContactStiffness stiffness;
  contact::DampingRatios beta;
};

HeadOn head_on(const model::ContactRule& rule, std::int32_t index, double radius, double energy = 0) {
  const contact::AnyGroup group = assembly::new_group(contact::BallBall::name, rule, index);
  return std::visit(
      [&](const auto& g) {
        using Law = typename std::decay_t<decltype(g)>::LawType;
        // What forms contacts is never in total form: bonds beside a law are groups that a rule does not
        // open.
        if constexpr (contact::in_total_form<Law>)
          return HeadOn{};
        else {
          const Vec3 n = Vec3::UnitZ();
          contact::ContactMotion motion{
              .normal = n, .overlap = assembly::typical_overlap * radius, .reduced_radius = radius};
          while (g.law.energy(motion, {}) < energy && motion.overlap < radius) motion.overlap *= 2;
          HeadOn result{g.law.stiffness(motion, g.law.formed(n)), {}};
          if constexpr (contact::asks_rate<Law>) result.beta = g.law.damping();
          return result;
        }
      },
      group);
}

/// The largest step of one degree of freedom: stiffness and viscosity over its inertia in 1/s² and 1/s, of
/// the system M/(1 + α), K, C (docs/theory.md).
double step_of(double stiffness, double viscosity, double local_damping) {
  const double k = (1 + local_damping) * stiffness;
  const double c = (1 + local_damping) * viscosity;
  return 4 / (c + std::sqrt(c * c + 4 * k));
}

/// The steps that the first contact of a ball allows, s.
struct FirstContact {
  double estimate = infinity;  ///< √(m/k), √(I/k) of the degrees of freedom apart, k over F(β)² of dashpots
  double bound = infinity;  ///< of the ball's block, local damping and dashpots included: proven
};

/// No ball meets another or a wall faster, m/s.
double fastest_approach(const assembly::State& state) {
  double ball = 0;
  for (const Vec3& v : state.model.bodies.velocity) ball = std::max(ball, v.norm());
  double other = ball;
  const std::vector<model::WallMotion>& motions = state.model.wall_motions;
  for (std::size_t m = 0; m < motions.size(); ++m) {
    const model::WallVelocity velocity = motions[m].at(state.time);
    const double lever = m < state.list.wall_lever.size() ? state.list.wall_lever[m] : 0.0;
    const double servo = motions[m].servo ? motions[m].servo->max_speed : 0.0;
    other = std::max(other, velocity.translation.norm() + lever * velocity.spin.norm() + servo);
  }
  return ball + other;
}

/// Of balls that touch nothing yet, for any head-on contact that the rules of the scene allow.
FirstContact first_contact(const assembly::State& state, std::span<const std::int32_t> balls) {
  FirstContact result;
  const model::Scene& settings = state.settings;
  const model::Bodies& bodies = state.model.bodies;
  const double damping = state.model.local_damping;
  const double approach = fastest_approach(state);
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
      const auto [k, beta] = head_on(settings.contacts[rule], rule, radius, 0.5 * mass * approach * approach);
      const auto stiffened = [](double stiffness, double ratio) {  // eq. 1.35
        const double root = std::sqrt(1 + ratio * ratio) + ratio;
        return stiffness * root * root;
      };
      const double kn = stiffened(k.normal, beta.normal);
      const double ks = stiffened(k.shear, beta.shear);
      const double turning = std::max(ks * radius * radius + k.bending, k.twist);
      const double diagonal = std::max(std::max(kn, ks) / mass, turning / inertia);
      if (diagonal > 0) result.estimate = std::min(result.estimate, 1 / std::sqrt(diagonal));
      // The block bound of two such balls is twice the block of one. The reduced mass is at most the ball's.
      const double across = 1 / mass + radius * radius / inertia;
      const double cn = 2 * beta.normal * std::sqrt(mass * k.normal);
      const double cs = 2 * beta.shear * std::sqrt(mass * k.shear);
      const double turning_alone = std::max(k.bending, k.twist) / inertia;
      result.bound = std::min({result.bound, step_of(2 * k.normal / mass, 2 * cn / mass, damping),
                               step_of(2 * (k.shear * across + turning_alone), 2 * cs * across, damping)});
    }
  }
  return result;
}

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
