#pragma once

#include "eigengrain/contact/law.hpp"
#include "eigengrain/contact/laws/frictional.hpp"

#include <array>
#include <cmath>
#include <span>
#include <string>

namespace eigengrain::contact {

/// Viscous dashpots as scene files describe them.
struct Dashpots {
  double beta_n = 0;  ///< β along n
  double beta_s = 0;  ///< β across n
  bool no_tension = false;

  static constexpr std::array<ParameterDescription, 4> parameters{{
      {.name = "beta_n",
       .unit = "",
       .default_value = 0,
       .minimum = 0,
       .description = "damping ratio of the dashpot along the normal: c = 2 beta_n sqrt(m k)"},
      {.name = "beta_s",
       .unit = "",
       .default_value = 0,
       .minimum = 0,
       .description = "damping ratio of the dashpot across the normal; it rests while the contact slides"},
      {.name = "no_tension",
       .kind = ParameterDescription::Kind::flag,
       .unit = "",
       .default_value = 0,
       .description = "the dashpot along the normal never pulls more than the spring pushes"},
      {.name = "restitution",
       .unit = "",
       .default_value = 1,
       .minimum = 0,
       .minimum_allowed = false,
       .maximum = 1,
       .description = "in place of `beta_n`: the part of the normal velocity that a head-on impact leaves, "
                      "exact without `no_tension`"},
  }};
};

/// Dashpots beside the springs of a law (PFC3D eqs. 1.57-1.60), after its slip check:
///
///   D_n = -c_n V_n,  c_n = 2 β_n √(m k_n)     V the velocity of δ, m the reduced mass
///   D_s = -c_s V_s,  c_s = 2 β_s √(m k_s)     zero while the contact slides
///   `no_tension`     F_n + D_n >= 0           unless the law has tension itself
///
/// k_n, k_s are the stiffnesses of the law at the present overlap. At rest there is no dashpot: Newton's
/// method, energies and the balance see the springs alone. The velocities of the cycle are those of the
/// middle of the step, half a step behind the forces, so that what dashpots dissipate is of first order in
/// the step.
template <class Base>
class Damped : public Base {
 public:
  template <class Real>
  struct StateIn : Base::template StateIn<Real> {
    Vec3Of<Real> viscous =
        Vec3Of<Real>::Zero();  ///< D_n + D_s of the step that led here, N, on the second side
  };
  using State = StateIn<double>;
  static constexpr auto state_fields =
      joined(Base::state_fields,
             std::array<StateField, 1>{{{.name = "viscous_force", .unit = "N", .components = 3}}});
  static constexpr bool asks_rate = true;

  Damped(const Base& base, const Dashpots& dashpots) : Base(base), dashpots_(dashpots) {}

  /// Velocities are taken from the increments: in a rigid motion those of the middle of the step vanish.
  bool mid_step() const { return !Base::end_step(); }
  State formed(const Vec3& n) const { return {Base::formed(n)}; }

  template <class Real>
  Response<Real> respond(const MotionIn<Real>& motion, const StateIn<Real>& old, StateIn<Real>& next) const {
    Response<Real> response = Base::template respond<Real>(motion, old, next);
    next.viscous = Vec3Of<Real>::Zero();
    if (none(Base::template acts<Real>(motion, old))) return response;
    next.viscous = viscous_force(motion, Base::template stiffness<Real>(motion, old), response);
    response.force.force += next.viscous;
    return response;
  }
  template <class Real>
  ForceIn<Real> evaluate(const MotionIn<Real>& motion, const StateIn<Real>& old, StateIn<Real>& next) const {
    return respond(motion, old, next).force;
  }
  /// Of the dashpots: the trapezoidal work of their forces, each half of the way with that at its own end.
  Dissipation dissipation(const ContactMotion& motion, const State& old, const State& next) const {
    Dissipation result = Base::dissipation(motion, old, next);
    Vec3 force = next.viscous;
    if (old.formed()) force += carry_vector(old.viscous, old.normal, motion.normal, motion.spin);
    result.viscous = -0.5 * force.dot(motion.displacement);
    return result;
  }
  DampingRatios damping() const { return {.normal = dashpots_.beta_n, .shear = dashpots_.beta_s}; }

  static constexpr std::size_t own_parameters = Base::own_parameters + Dashpots::parameters.size();

  static bool serves(std::span<const double> values) {
    return are_defaults(values, Base::parameters, own_parameters);
  }
  static Damped from_values(std::span<const double> values) {
    const std::span<const double> own = values.subspan(Base::own_parameters, Dashpots::parameters.size());
    const double restitution = own[3];
    return {Base::from_values(values),
            {.beta_n = restitution < 1 ? Base::damping_ratio(restitution) : own[0],
             .beta_s = own[1],
             .no_tension = own[2] != 0}};
  }
  /// What is wrong with values that are each in range; empty: nothing.
  static std::string mistake(std::span<const double> values) {
    const std::span<const double> own = values.subspan(Base::own_parameters, Dashpots::parameters.size());
    if (own[0] > 0 && own[3] < 1)
      return "both beta_n and restitution are given, and each says how strong the dashpot along the normal "
             "is; "
             "keep one of the two";
    return Base::mistake(values);
  }

 private:
  template <class Real>
  Vec3Of<Real> viscous_force(const MotionIn<Real>& motion, const StiffnessIn<Real>& k,
                             const Response<Real>& springs) const {
    using std::sqrt;
    const Vec3Of<Real>& n = motion.normal;
    const Real approach = motion.velocity.dot(n);
    Real normal = -2 * dashpots_.beta_n * sqrt(motion.reduced_mass * k.normal) * approach;
    if (dashpots_.no_tension && !Base::tension())
      normal = select(springs.normal_force + normal < 0.0, -springs.normal_force, normal);
    const Real shear =
        select(springs.slides, Real(0), -2 * dashpots_.beta_s * sqrt(motion.reduced_mass * k.shear));
    return normal * n + shear * (motion.velocity - approach * n);
  }

  Dashpots dashpots_;
};

}  // namespace eigengrain::contact
