#include "first_contact.hpp"

#include "eigengrain/assembly/cell_motion.hpp"
#include "eigengrain/assembly/contact_list.hpp"
#include "eigengrain/assembly/local_damping.hpp"
#include "eigengrain/assembly/stiffness.hpp"

#include <algorithm>
#include <cmath>
#include <optional>
#include <vector>

namespace eigengrain::cycle {
namespace {

/// A body as its first contact sees it; of several bodies, the least that any has to set against it.
struct Meeting {
  double mass = 0;     ///< kg
  double heavy = 0;    ///< the largest mass, for the energy of the impact, kg
  double inertia = 0;  ///< about any axis, kg m²
  double lever = 0;    ///< of the contact about the centre, m
  double radius = 0;   ///< of the ball that touches, m
  bool radial = true;  ///< the contact's normal goes through the centre
};

/// The lightest of some balls that is of a material and can move.
std::optional<Meeting> lightest_ball(const model::Bodies& bodies, std::span<const std::int32_t> rows,
                                     std::int32_t material) {
  std::optional<std::int32_t> found;
  for (const std::int32_t i : rows)
    if (bodies.material[i] == material && bodies.clumps.of(i) == model::Clumps::none &&
        (!found || model::inertial_mass(bodies, i) < model::inertial_mass(bodies, *found)))
      found = i;
  if (!found) return std::nullopt;
  return Meeting{.mass = model::inertial_mass(bodies, *found),
                 .heavy = model::inertial_mass(bodies, *found),
                 .inertia = model::inertial_moment(bodies, *found),
                 .lever = bodies.radius[*found],
                 .radius = bodies.radius[*found]};
}

/// The clumps of a material taken together, on the safe side: the least mass with the least inertia, and the
/// longest lever.
std::optional<Meeting> any_clump(const model::Bodies& bodies, std::span<const std::int32_t> rows,
                                 std::int32_t material) {
  const model::Clumps& clumps = bodies.clumps;
  std::optional<Meeting> result;
  for (const std::int32_t row : rows) {
    const std::int32_t clump = clumps.of(row);
    if (clump == model::Clumps::none || bodies.material[row] != material) continue;
    const double factor = model::mass_factor_of(bodies, static_cast<std::size_t>(row));
    const double mass = factor * clumps.mass[clump];
    const double inertia = factor * clumps.inertia[clump].minCoeff();
    if (!result)
      result =
          Meeting{.mass = mass, .heavy = mass, .inertia = inertia, .lever = 0, .radius = 0, .radial = false};
    result->mass = std::min(result->mass, mass);
    result->heavy = std::max(result->heavy, mass);
    result->inertia = std::min(result->inertia, inertia);
    result->lever = std::max(result->lever, clumps.radius[clump]);
    for (const std::int32_t ball : clumps.members(clump))
      result->radius = std::max(result->radius, bodies.radius[ball]);
  }
  return result;
}

/// The largest step of one degree of freedom: stiffness and viscosity over its inertia in 1/s² and 1/s, of
/// the system M/(1 + α), K, C (docs/theory.md).
double step_of(double stiffness, double viscosity, double local_damping) {
  const double k = (1 + local_damping) * stiffness;
  const double c = (1 + local_damping) * viscosity;
  return 4 / (c + std::sqrt(c * c + 4 * k));
}

/// Lowers the steps to what the contact of a body by one rule allows.
void add(const Meeting& body, const model::ContactRule& rule, std::int32_t index, double approach,
         double damping, FirstContact& result) {
  const double mass = body.mass;
  const double inertia = body.inertia;
  const auto [k, beta] = head_on(rule, index, body.radius, 0.5 * body.heavy * approach * approach);
  const auto stiffened = [](double stiffness, double ratio) {  // eq. 1.35
    const double root = std::sqrt(1 + ratio * ratio) + ratio;
    return stiffness * root * root;
  };
  const double kn = stiffened(k.normal, beta.normal);
  const double ks = stiffened(k.shear, beta.shear);
  const double across_lever = body.radial ? ks : std::max(kn, ks);
  const double turning = std::max(across_lever * body.lever * body.lever + k.bending, k.twist);
  const double diagonal = std::max(std::max(kn, ks) / mass, turning / inertia);
  if (diagonal > 0) result.estimate = std::min(result.estimate, 1 / std::sqrt(diagonal));
  // The block bound of two such bodies is twice the block of one. The reduced mass is at most the body's.
  const double across = 1 / mass + body.lever * body.lever / inertia;
  const double cn = 2 * beta.normal * std::sqrt(mass * k.normal);
  const double cs = 2 * beta.shear * std::sqrt(mass * k.shear);
  const double turning_alone = std::max(k.bending, k.twist) / inertia;
  if (body.radial)
    result.bound = std::min({result.bound, step_of(2 * k.normal / mass, 2 * cn / mass, damping),
                             step_of(2 * (k.shear * across + turning_alone), 2 * cs * across, damping)});
  else  // force along n and across it turn the same axes
    result.bound = std::min(result.bound, step_of(2 * (std::max(k.normal, k.shear) * across + turning_alone),
                                                  2 * std::max(cn, cs) * across, damping));
}

}  // namespace

double fastest_approach(const assembly::State& state) {
  double ball = 0;
  const model::Bodies& bodies = state.model.bodies;
  const assembly::Fluctuation fluctuation(state.model.cell);
  for (std::size_t i = 0; i < bodies.velocity.size(); ++i)
    ball = std::max(ball, fluctuation.of(bodies.velocity[i], bodies.position[i]).norm());
  // The flow of a cell moves neighbours against each other, each by this at most.
  ball +=
      state.model.cell.flow_gradient().norm() * *std::max_element(bodies.radius.begin(), bodies.radius.end());
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

HeadOn head_on(const model::ContactRule& rule, std::int32_t index, double radius, double energy) {
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

FirstContact first_contact(const assembly::State& state, std::span<const std::int32_t> bodies,
                           double approach) {
  FirstContact result;
  const model::Scene& settings = state.settings;
  const double damping = assembly::largest_damping(state.model);
  const auto materials = static_cast<std::int32_t>(settings.materials.size());
  for (std::int32_t a = 0; a < materials; ++a) {
    const auto ball = lightest_ball(state.model.bodies, bodies, a);
    const auto clump = any_clump(state.model.bodies, bodies, a);
    for (std::int32_t b = 0; b < materials; ++b) {
      const std::int32_t rule = settings.rule_for(a, b);
      if (rule < 0 || settings.contacts[rule].law == "none") continue;
      for (const auto& body : {ball, clump})
        if (body) add(*body, settings.contacts[rule], rule, approach, damping, result);
    }
  }
  return result;
}

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

std::vector<std::int32_t> bodies_apart(const assembly::State& state, const assembly::LinearSystem& listed,
                                       bool varies) {
  return varies ? assembly::LinearSystem(state.model).unknowns.set_aside() : listed.unknowns.set_aside();
}

}  // namespace eigengrain::cycle
