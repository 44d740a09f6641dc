#pragma once

#include "eigengrain/base/pack.hpp"
#include "eigengrain/contact/dissipation.hpp"
#include "eigengrain/contact/law.hpp"
#include "eigengrain/contact/shear_transport.hpp"

#include <array>
#include <cmath>
#include <span>
#include <string>
#include <string_view>

namespace eigengrain::contact {

/// Coefficient of friction as scene files describe it.
inline constexpr ParameterDescription friction_parameter{
    .name = "friction", .unit = "", .default_value = 0, .minimum = 0, .description = "coefficient μ"};

/// How the shear force follows its contact, as scene files describe it; turned with it in the middle of the
/// step where nothing is said.
struct ShearOptions {
  bool small_angle = false;
  bool end_step = false;
  bool projected = false;

  static constexpr std::array<ParameterDescription, 3> parameters{{
      {.name = "small_angle",
       .kind = ParameterDescription::Kind::flag,
       .unit = "",
       .default_value = 0,
       .description =
           "carry the shear force by the small-angle forms of eqs. 1.11-1.12, not by exact rotations"},
      {.name = "end_step",
       .kind = ParameterDescription::Kind::flag,
       .unit = "",
       .default_value = 0,
       .description =
           "measure shear increments with the geometry at the end of the step, as PFC3D does, not of its "
           "middle"},
      {.name = "projected",
       .kind = ParameterDescription::Kind::flag,
       .unit = "",
       .default_value = 0,
       .description = "project the shear force onto the new contact plane, in place of turning it, and let "
                      "it begin with "
                      "all of the step in which the contact forms, as LAMMPS's gran/hooke/history does"},
  }};
  /// values: of these parameters, and perhaps of more behind them.
  static ShearOptions from_values(std::span<const double> values) {
    return {.small_angle = values[0] != 0, .end_step = values[1] != 0, .projected = values[2] != 0};
  }
};

/// Springs across n at the present overlap, and what becomes of the old shear force:
/// F_s <- kept · carried(F_s) - k_s δ_s.
template <class Real>
struct ShearSprings {
  Real stiffness = 0;        ///< k_s, N/m
  Real stiffness_slope = 0;  ///< dk_s/dU, N/m²
  Real kept = 1;
  Real kept_slope = 0;  ///< d kept/dU, 1/m
};

/// Part of R* below which a difference of overlaps is rounding: the overlap itself is one of distances.
inline constexpr double overlap_rounding = 1e-12;

/// What a law found while it computed its force; laws built on it go on from there.
template <class Real>
struct Response {
  ForceIn<Real> force;
  Real normal_force = 0;  ///< F_n of the springs, N
  MaskOf<Real> slides{};
};

/// Springs with Coulomb slip (PFC3D eqs. 1.9-1.19), for any springs along n:
///
///   normal, secant       F_n(U)                              while U > 0
///   shear, incremental   F_s <- kept · carried(F_s) - k_s δ_s      δ_s = the part of δ across n
///   slip                 |F_s| <= μ F_n
///   energy               normal energy + ½ |F_s|²/k_s
///
/// F_s starts at zero when the contact forms (`projected`: with the increment of that step). k_s counts only
/// where friction is positive.
///
/// Springs say what F_n, k_s and the energy are (laws/linear.hpp, hertz.hpp, hysteretic.hpp): Params with
/// `friction` and `shear` (ShearOptions); Memory<Real>, what they remember beside the shear force;
/// and the functions used here, of the motion and the old memory. `lost(memory)`, where they have it, is what
/// the springs along n have turned into heat since the contact formed.
template <class Springs>
class Frictional {
 public:
  using Params = typename Springs::Params;

  template <class Real>
  struct StateIn {
    Vec3Of<Real> shear = Vec3Of<Real>::Zero();  ///< F_s, N, of the first side on the second
    Vec3Of<Real> normal =
        Vec3Of<Real>::Zero();  ///< n at the committed state; zero: the contact has not formed
    [[no_unique_address]] typename Springs::template Memory<Real> memory{};

    MaskOf<Real> formed() const { return (normal.x() != 0.0) | (normal.y() != 0.0) | (normal.z() != 0.0); }
  };
  using State = StateIn<double>;
  static constexpr auto state_fields =
      joined(std::array<StateField, 2>{{{.name = "shear_force", .unit = "N", .components = 3},
                                        {.name = "normal", .unit = "", .components = 3}}},
             Springs::memory_fields);

  explicit Frictional(const Params& params)
      : springs_(params),
        friction_(params.friction),
        transport_(params.shear.projected     ? Transport::projected
                   : params.shear.small_angle ? Transport::small_angle
                                              : Transport::rotated),
        end_step_(params.shear.end_step) {}

  bool tension() const { return springs_.tension(); }
  bool needs_rotation() const { return springs_.has_shear(); }
  /// Without shear nothing depends on the increments.
  bool mid_step() const { return springs_.has_shear() && !end_step_; }

  bool end_step() const { return end_step_; }

  /// The state of a contact that forms with normal n.
  State formed(const Vec3& n) const { return {.normal = n}; }

  template <class Real>
  MaskOf<Real> acts(const MotionIn<Real>& motion, const StateIn<Real>& old) const {
    const MaskOf<Real> touches = motion.overlap > 0.0;
    return springs_.tension() ? touches | old.formed() : touches;
  }

  template <class Real>
  Response<Real> respond(const MotionIn<Real>& motion, const StateIn<Real>& old, StateIn<Real>& next) const {
    using std::sqrt;
    next = StateIn<Real>{};
    if (none(acts(motion, old))) return {};
    const Real normal_force = springs_.force(motion, old.memory);
    const Vec3Of<Real> trial = trial_shear(motion, old);
    const MaskOf<Real> sliding = slips(trial, normal_force);
    next.normal = motion.normal;
    next.memory = springs_.remembered(motion, old.memory);
    next.shear = trial;
    if (!none(sliding)) {
      const Real within = friction_ * normal_force / sqrt(trial.squaredNorm());
      next.shear = select<Real>(sliding, within * trial, trial);
    }
    return {.force = {.force = normal_force * motion.normal + next.shear},
            .normal_force = normal_force,
            .slides = sliding};
  }

  template <class Real>
  ForceIn<Real> evaluate(const MotionIn<Real>& motion, const StateIn<Real>& old, StateIn<Real>& next) const {
    return respond(motion, old, next).force;
  }

  /// Elastic: sticking, whatever the contact does now.
  template <class Real>
  StiffnessIn<Real> stiffness(const MotionIn<Real>& motion, const StateIn<Real>& old) const {
    return springs_.stiffness(motion, old.memory);
  }

  /// With k_n = dF_n/dU, T the trial shear force and g = dT/dU. Sticking: k_n nnᵀ + k_s (1 - nnᵀ) + g nᵀ.
  /// Slipping, with t = T/|T|:
  /// k_n (n + μ t) nᵀ + (μ F_n/|T|) (1 - nnᵀ - ttᵀ) (k_s + g nᵀ).
  ContactTangent tangent(const ContactMotion& motion, const State& old) const {
    const Vec3& n = motion.normal;
    const double normal_force = springs_.force(motion, old.memory);
    const double kn = springs_.tangent(motion, old.memory);
    const double ks = springs_.shear(motion, old.memory).stiffness;
    const Vec3 trial = trial_shear(motion, old);
    const Vec3 growth = trial_growth(motion, old);
    if (!slips(trial, normal_force)) {
      const ContactStiffness sticking{.normal = kn, .shear = ks};
      return {.translation = sticking.translation(n) + growth * n.transpose()};
    }
    const double magnitude = trial.norm();
    const Vec3 t = trial / magnitude;
    const double across = friction_ * normal_force / magnitude;
    const Mat3 plane = Mat3::Identity() - n * n.transpose() - t * t.transpose();
    return {.translation = kn * (n + friction_ * t) * n.transpose() +
                           across * (ks * plane + plane * growth * n.transpose())};
  }

  double energy(const ContactMotion& motion, const State& old) const {
    if (!acts(motion, old)) return 0.0;
    State next;
    respond(motion, old, next);
    const double normal = springs_.energy(motion, old.memory);
    if (!springs_.has_shear()) return normal;
    return normal + 0.5 * next.shear.squaredNorm() / springs_.shear(motion, old.memory).stiffness;
  }

  /// Of friction, with C = kept · carried(F_s,old), T the trial shear force and F_s,new:
  ///
  ///   ½ (C + F_s,new)·(T - F_s,new)/k_s      the mean shear force on the way that slips
  ///
  /// and, where k_s follows the overlap, what the shear spring loses as that changes. Where the contact opens
  /// F_s,new is zero, and what was stored is lost.
  Dissipation dissipation(const ContactMotion& motion, const State& old, const State& next) const {
    Dissipation result;
    if constexpr (requires { springs_.lost(next.memory); })
      if (next.formed()) result.hysteresis = springs_.lost(next.memory) - springs_.lost(old.memory);
    if (!springs_.has_shear()) return result;
    const Vec3 before = old.formed() ? carried(motion, old) : Vec3(Vec3::Zero());
    const Vec3 way = across(motion);
    if (!acts(motion, old)) {
      if (!before.isZero(0))
        result.slip = 0.5 * before.dot(before / springs_.old_shear_stiffness(motion, old.memory) - way);
      return result;
    }
    const ShearSprings<double> shear = springs_.shear(motion, old.memory);
    const Vec3 trial = trial_shear(motion, old);
    result.slip = 0.5 * (shear.kept * before + next.shear).dot(trial - next.shear) / shear.stiffness;
    if constexpr (Springs::shear_follows_overlap)
      if (!before.isZero(0)) {
        const double then = springs_.old_shear_stiffness(motion, old.memory);
        result.slip += 0.5 * before.squaredNorm() * (1 / then - shear.kept * shear.kept / shear.stiffness) -
                       0.5 * (1 - shear.kept) * before.dot(way);
      }
    return result;
  }

  // What scene files say.

  static constexpr std::string_view name = Springs::name;
  static constexpr std::string_view description = Springs::description;
  static constexpr auto& parameters = Springs::parameters;
  /// How many parameters are its own; those behind them belong to laws built on it.
  static constexpr std::size_t own_parameters = Springs::own_parameters.size();

  /// Whether this class is the one for these parameters: nothing is asked that laws built on it offer.
  static bool serves(std::span<const double> values) {
    return are_defaults(values, parameters, own_parameters);
  }
  static Frictional from_values(std::span<const double> values) {
    return Frictional(Springs::params(values));
  }
  /// What is wrong with values that are each in range; empty: nothing.
  static std::string mistake(std::span<const double> values) {
    const Params params = Springs::params(values);
    if (params.shear.small_angle && params.shear.projected)
      return "small_angle and projected are two ways to carry the shear force; keep one of the two";
    return {};
  }
  static double damping_ratio(double restitution) { return Springs::damping_ratio(restitution); }

 private:
  enum class Transport { rotated, small_angle, projected };

  /// F_s carried from the committed state to the present contact plane.
  template <class Real>
  Vec3Of<Real> carried(const MotionIn<Real>& motion, const StateIn<Real>& old) const {
    if (transport_ == Transport::rotated)
      return carry_shear<Real>(old.shear, old.normal, motion.normal, motion.spin);
    if (transport_ == Transport::projected) return project_shear<Real>(old.shear, motion.normal);
    return carry_shear_small_angle<Real>(old.shear, old.normal, motion.normal, motion.spin);
  }
  template <class Real>
  static Vec3Of<Real> across(const MotionIn<Real>& motion) {
    return motion.displacement - motion.displacement.dot(motion.normal) * motion.normal;
  }

  /// Shear force before the slip check. Zero in the step in which the contact forms.
  template <class Real>
  Vec3Of<Real> trial_shear(const MotionIn<Real>& motion, const StateIn<Real>& old) const {
    using Vector = Vec3Of<Real>;
    if (!springs_.has_shear()) return Vector::Zero();
    const ShearSprings<Real> shear = springs_.shear(motion, old.memory);
    const Vector increment = -shear.stiffness * across(motion);
    const Vector first = transport_ == Transport::projected ? increment : Vector(Vector::Zero());
    return select<Real>(old.formed(), shear.kept * carried(motion, old) + increment, first);
  }
  /// Its derivative with respect to U.
  Vec3 trial_growth(const ContactMotion& motion, const State& old) const {
    if (!springs_.has_shear() || !old.formed()) return Vec3::Zero();
    const ShearSprings<double> shear = springs_.shear(motion, old.memory);
    return shear.kept_slope * carried(motion, old) - shear.stiffness_slope * across(motion);
  }

  template <class Real>
  MaskOf<Real> slips(const Vec3Of<Real>& shear, const Real& normal_force) const {
    const Real limit = friction_ * normal_force;
    const MaskOf<Real> beyond = shear.squaredNorm() > limit * limit;
    return springs_.tension() ? MaskOf<Real>{} : beyond;
  }

  Springs springs_;
  double friction_;
  Transport transport_;
  bool end_step_;
};

}  // namespace eigengrain::contact
