#pragma once

#include "eigengrain/contact/law.hpp"
#include "eigengrain/contact/laws/frictional.hpp"

#include <array>
#include <span>
#include <string>

namespace eigengrain::contact {

/// A spring against relative rotation as scene files describe it.
struct RollingSpring {
  double kr = 0;        ///< k_r, N m
  double friction = 0;  ///< μ_r

  static constexpr std::array<ParameterDescription, 2> parameters{{
      {.name = "kr",
       .unit = "N m",
       .default_value = 0,
       .minimum = 0,
       .description =
           "stiffness against rolling and twisting, a moment per radian of relative rotation; counts "
           "only where `rolling_friction` is positive or `tension` is on"},
      {.name = "rolling_friction",
       .unit = "",
       .default_value = 0,
       .minimum = 0,
       .description = "limits that moment to rolling_friction R* F_n, 1/R* = 1/R_1 + 1/R_2"},
  }};
};

/// Rolling and twisting resistance beside a law: a moment M of the first side on the second,
///
///   incremental   M <- carried(M) - k_r φ     φ the relative rotation, all three components alike
///   slip          |M| <= μ_r R* F_n           unless the law has tension
///   energy        ½ |M|²/k_r
///
/// carried with the contact frame like the shear force, and zero when the contact forms. k_r adds to both
/// rotational stiffnesses of the contact (κ_n, κ_s of eq. 1.34).
template <class Base>
class Rolling : public Base {
 public:
  template <class Real>
  struct StateIn : Base::template StateIn<Real> {
    Vec3Of<Real> moment = Vec3Of<Real>::Zero();  ///< M, N m, of the first side on the second
  };
  using State = StateIn<double>;
  static constexpr auto state_fields =
      joined(Base::state_fields,
             std::array<StateField, 1>{{{.name = "rolling_moment", .unit = "N m", .components = 3}}});

  Rolling(const Base& base, const RollingSpring& spring) : Base(base), spring_(spring) {
    if (spring_.friction <= 0 && !Base::tension()) spring_.kr = 0;
  }

  bool needs_rotation() const { return spring_.kr > 0 || Base::needs_rotation(); }
  State formed(const Vec3& n) const { return {Base::formed(n)}; }

  template <class Real>
  Response<Real> respond(const MotionIn<Real>& motion, const StateIn<Real>& old, StateIn<Real>& next) const {
    using std::sqrt;
    Response<Real> response = Base::template respond<Real>(motion, old, next);
    next.moment = Vec3Of<Real>::Zero();
    if (none(Base::template acts<Real>(motion, old))) return response;
    const Vec3Of<Real> trial = trial_moment(motion, old);
    const Real limit = limit_of(motion, response);
    const MaskOf<Real> sliding = slips(trial, limit);
    next.moment = trial;
    if (!none(sliding)) next.moment = select<Real>(sliding, limit / sqrt(trial.squaredNorm()) * trial, trial);
    response.force.moment += next.moment;
    return response;
  }
  template <class Real>
  ForceIn<Real> evaluate(const MotionIn<Real>& motion, const StateIn<Real>& old, StateIn<Real>& next) const {
    return respond(motion, old, next).force;
  }
  template <class Real>
  StiffnessIn<Real> stiffness(const MotionIn<Real>& motion, const StateIn<Real>& old) const {
    StiffnessIn<Real> k = Base::template stiffness<Real>(motion, old);
    k.twist += spring_.kr;
    k.bending += spring_.kr;
    return k;
  }
  /// Sticking: k_r. Slipping, with m = M/|M| of the trial moment: (μ_r R* F_n/|M|) k_r (1 - mmᵀ), and -dM/dδ
  /// = μ_r R* k_n m nᵀ, as the limit follows the normal force.
  ContactTangent tangent(const ContactMotion& motion, const State& old) const {
    ContactTangent result = Base::tangent(motion, old);
    State discarded;
    const double limit = limit_of(motion, Base::respond(motion, old, discarded));
    const Vec3 trial = trial_moment(motion, old);
    if (!slips(trial, limit)) {
      result.rotation += spring_.kr * Mat3::Identity();
      return result;
    }
    const Vec3& n = motion.normal;
    const double magnitude = trial.norm();
    const Vec3 m = trial / magnitude;
    result.rotation += limit / magnitude * spring_.kr * (Mat3::Identity() - m * m.transpose());
    const double kn = n.dot(result.translation * n);
    result.coupling += spring_.friction * motion.reduced_radius * kn * m * n.transpose();
    return result;
  }
  /// Of the moment, as Frictional has it of the shear force.
  Dissipation dissipation(const ContactMotion& motion, const State& old, const State& next) const {
    Dissipation result = Base::dissipation(motion, old, next);
    if (spring_.kr <= 0 || !old.formed()) return result;
    const Vec3 trial = trial_moment(motion, old);
    const Vec3 before = trial + spring_.kr * motion.rotation;
    result.rolling = 0.5 * (before + next.moment).dot(trial - next.moment) / spring_.kr;
    return result;
  }
  double energy(const ContactMotion& motion, const State& old) const {
    const double base = Base::energy(motion, old);
    if (spring_.kr <= 0) return base;
    State next;
    respond(motion, old, next);
    return base + 0.5 * next.moment.squaredNorm() / spring_.kr;
  }

  static constexpr std::size_t own_parameters = Base::own_parameters + RollingSpring::parameters.size();

  static bool serves(std::span<const double> values) {
    return are_defaults(values, Base::parameters, own_parameters);
  }
  static Rolling from_values(std::span<const double> values) {
    return {Base::from_values(values),
            {.kr = values[Base::own_parameters], .friction = values[Base::own_parameters + 1]}};
  }

 private:
  /// M before the slip check. Zero in the step in which the contact forms.
  template <class Real>
  Vec3Of<Real> trial_moment(const MotionIn<Real>& motion, const StateIn<Real>& old) const {
    using Vector = Vec3Of<Real>;
    if (spring_.kr <= 0) return Vector::Zero();
    return select<Real>(
        old.formed(),
        carry_vector<Real>(old.moment, old.normal, motion.normal, motion.spin) - spring_.kr * motion.rotation,
        Vector::Zero());
  }
  template <class Real>
  Real limit_of(const MotionIn<Real>& motion, const Response<Real>& base) const {
    return spring_.friction * motion.reduced_radius * base.normal_force;
  }
  template <class Real>
  MaskOf<Real> slips(const Vec3Of<Real>& moment, const Real& limit) const {
    const MaskOf<Real> beyond = moment.squaredNorm() > limit * limit;
    return Base::tension() ? MaskOf<Real>{} : beyond;
  }

  RollingSpring spring_;
};

}  // namespace eigengrain::contact
