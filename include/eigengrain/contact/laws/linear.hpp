#pragma once

#include "eigengrain/contact/dissipation.hpp"
#include "eigengrain/contact/law.hpp"
#include "eigengrain/contact/shear_transport.hpp"

#include <array>
#include <span>
#include <string_view>

namespace eigengrain::contact {

/// Linear springs, normal and shear, with Coulomb slip (PFC3D eqs. 1.9-1.19).
///
///   normal, secant       F_n = k_n U                         while U > 0
///   shear, incremental   F_s <- carried(F_s) - k_s δ_s       δ_s = the part of δ across n
///   slip                 |F_s| <= μ F_n
///   energy               ½ k_n U² + ½ |F_s|²/k_s
///
/// F_s starts at zero when the contact forms. k_s counts only where friction is positive. With `tension` the
/// springs pull as they push once the contact has formed: no opening, no slip, and friction means nothing;
/// that is the linear system whose spectrum K describes.
class Linear {
 public:
  struct Params {
    double kn = 0;        ///< N/m
    double ks = 0;        ///< N/m
    double friction = 0;  ///< μ
    bool tension = false;
    bool small_angle = false;
    bool end_step = false;
  };

  struct State {
    Vec3 shear = Vec3::Zero();   ///< F_s, N, of the first side on the second
    Vec3 normal = Vec3::Zero();  ///< n at the committed state; zero: the contact has not formed

    bool formed() const { return !normal.isZero(0); }
  };
  static constexpr std::array<StateField, 2> state_fields{
      {{.name = "shear_force", .unit = "N", .components = 3},
       {.name = "normal", .unit = "", .components = 3}}};

  explicit Linear(const Params& params) : params_(params) {
    if (params_.friction <= 0 && !params_.tension) params_.ks = 0;
  }

  bool tension() const { return params_.tension; }
  bool needs_rotation() const { return params_.ks > 0; }
  /// Without shear nothing depends on the increments.
  bool mid_step() const { return params_.ks > 0 && !params_.end_step; }

  /// The state of a contact that forms with normal n.
  State formed(const Vec3& n) const { return {.normal = n}; }

  bool acts(const ContactMotion& motion, const State& old) const {
    return motion.overlap > 0 || (params_.tension && old.formed());
  }

  ContactForce evaluate(const ContactMotion& motion, const State& old, State& next) const {
    if (!acts(motion, old)) {
      next = State{};
      return {};
    }
    next = formed(motion.normal);
    const double normal_force = params_.kn * motion.overlap;
    next.shear = trial_shear(motion, old);
    if (slips(next.shear, normal_force)) next.shear *= params_.friction * normal_force / next.shear.norm();
    return {.force = normal_force * motion.normal + next.shear};
  }

  /// Elastic: sticking, whatever the contact does now.
  ContactStiffness stiffness(const ContactMotion& /*motion*/, const State& /*old*/) const {
    return {.normal = params_.kn, .shear = params_.ks};
  }

  /// Sticking: the elastic D. Slipping, with t = F_s/|F_s| of the trial shear force:
  /// k_n nnᵀ + μ k_n t nᵀ + (μ F_n/|F_s|) k_s (1 - nnᵀ - ttᵀ).
  ContactTangent tangent(const ContactMotion& motion, const State& old) const {
    const Vec3& n = motion.normal;
    const double normal_force = params_.kn * motion.overlap;
    const Vec3 trial = trial_shear(motion, old);
    if (!slips(trial, normal_force)) return {.translation = stiffness(motion, old).translation(n)};
    const double magnitude = trial.norm();
    const Vec3 t = trial / magnitude;
    const double across = params_.friction * normal_force / magnitude * params_.ks;
    const Mat3 plane = Mat3::Identity() - n * n.transpose() - t * t.transpose();
    return {.translation = params_.kn * (n + params_.friction * t) * n.transpose() + across * plane};
  }

  double energy(const ContactMotion& motion, const State& old) const {
    if (!acts(motion, old)) return 0.0;
    State next;
    evaluate(motion, old, next);
    const double normal = 0.5 * params_.kn * motion.overlap * motion.overlap;
    return params_.ks > 0 ? normal + 0.5 * next.shear.squaredNorm() / params_.ks : normal;
  }

  /// ½ (F_s,old + F_s,new)·(F_s,trial - F_s,new)/k_s, F_s,old carried: the mean shear force on the way that
  /// slips. Where the contact opens F_s,new is zero, and what was stored is lost.
  Dissipation dissipation(const ContactMotion& motion, const State& old, const State& next) const {
    if (params_.ks <= 0 || !old.formed()) return {};
    const Vec3 trial = trial_shear(motion, old);
    const Vec3 slipped = trial - next.shear;
    if (slipped.isZero(0)) return {};
    const Vec3& n = motion.normal;
    const Vec3 carried = trial + params_.ks * (motion.displacement - motion.displacement.dot(n) * n);
    return {.slip = 0.5 * (carried + next.shear).dot(slipped) / params_.ks};
  }

  // What scene files say.

  static constexpr std::string_view name = "linear";
  static constexpr std::string_view description =
      "linear normal and shear springs of the pair, with Coulomb slip";
  static constexpr std::array<ParameterDescription, 6> parameters{{
      {.name = "kn",
       .unit = "N/m",
       .minimum = 0,
       .minimum_allowed = false,
       .description = "normal stiffness of the pair"},
      {.name = "ks",
       .unit = "N/m",
       .default_value = 0,
       .minimum = 0,
       .description =
           "shear stiffness of the pair; counts only where friction is positive or `tension` is on"},
      {.name = "friction", .unit = "", .default_value = 0, .minimum = 0, .description = "coefficient μ"},
      {.name = "tension",
       .kind = ParameterDescription::Kind::flag,
       .unit = "",
       .default_value = 0,
       .description = "springs that also pull, never open and never slip; for tests of linear systems"},
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
       .description = "measure shear increments with the geometry at the end of the step, as PFC3D does, not "
                      "of its middle"},
  }};

  /// Whether this class is the one for these parameters (see linear_frictionless.hpp).
  static bool serves(std::span<const double> /*values*/) { return true; }
  static Linear from_values(std::span<const double> values) {
    return Linear({.kn = values[0],
                   .ks = values[1],
                   .friction = values[2],
                   .tension = values[3] != 0,
                   .small_angle = values[4] != 0,
                   .end_step = values[5] != 0});
  }

 private:
  /// Shear force before the slip check. Zero in the step in which the contact forms.
  Vec3 trial_shear(const ContactMotion& motion, const State& old) const {
    if (params_.ks <= 0 || !old.formed()) return Vec3::Zero();
    const Vec3& n = motion.normal;
    const Vec3 carried = params_.small_angle ? carry_shear_small_angle(old.shear, old.normal, n, motion.spin)
                                             : carry_shear(old.shear, old.normal, n, motion.spin);
    return carried - params_.ks * (motion.displacement - motion.displacement.dot(n) * n);
  }

  bool slips(const Vec3& shear, double normal_force) const {
    if (params_.tension) return false;
    const double limit = params_.friction * normal_force;
    return shear.squaredNorm() > limit * limit;
  }

  Params params_;
};

}  // namespace eigengrain::contact
