#pragma once

#include "eigengrain/contact/laws/damped.hpp"
#include "eigengrain/contact/laws/frictional.hpp"
#include "eigengrain/contact/laws/rolling.hpp"

#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <optional>
#include <span>
#include <string_view>

namespace eigengrain::contact {
namespace detail {

/// What one side of a linear contact adds in series: infinite for a rigid one.
inline std::optional<double> linear_side(const model::Material& material, std::optional<double> k) {
  return material.rigid ? std::numeric_limits<double>::infinity() : k;
}

}  // namespace detail

/// Linear springs (PFC3D eqs. 1.9-1.19): F_n = k_n U, k_s constant, normal energy ½ k_n U².
///
/// With `tension` the springs pull as they push once the contact has formed: no opening, no slip, and
/// friction means nothing; that is the linear system whose spectrum K describes.
class LinearSprings {
 public:
  struct Params {
    double kn = 0;        ///< N/m
    double ks = 0;        ///< N/m
    double friction = 0;  ///< μ
    bool tension = false;
    ShearOptions shear{};
  };
  template <class Real>
  struct Memory {};
  static constexpr std::array<StateField, 0> memory_fields{};

  explicit LinearSprings(const Params& params)
      : kn_(params.kn),
        ks_(params.friction > 0 || params.tension ? params.ks : 0.0),
        tension_(params.tension) {}

  bool tension() const { return tension_; }
  bool has_shear() const { return ks_ > 0; }

  template <class Real>
  Real force(const MotionIn<Real>& motion, Memory<Real> /*old*/) const {
    return kn_ * motion.overlap;
  }
  double tangent(const ContactMotion& /*motion*/, Memory<double> /*old*/) const { return kn_; }
  static constexpr bool shear_follows_overlap = false;
  template <class Real>
  ShearSprings<Real> shear(const MotionIn<Real>& /*motion*/, Memory<Real> /*old*/) const {
    return {.stiffness = ks_};
  }
  double old_shear_stiffness(const ContactMotion& /*motion*/, Memory<double> /*old*/) const { return ks_; }
  template <class Real>
  StiffnessIn<Real> stiffness(const MotionIn<Real>& /*motion*/, Memory<Real> /*old*/) const {
    return {.normal = kn_, .shear = ks_};
  }
  double energy(const ContactMotion& motion, Memory<double> /*old*/) const {
    return 0.5 * kn_ * motion.overlap * motion.overlap;
  }
  template <class Real>
  Memory<Real> remembered(const MotionIn<Real>& /*motion*/, Memory<Real> /*old*/) const {
    return {};
  }

  /// β of the dashpot along n after which an impact leaves the part e of its velocity, where the dashpot may
  /// pull: e = exp(-πβ/√(1 - β²)).
  static double damping_ratio(double restitution) {
    const double b = -std::log(restitution);
    return b / std::hypot(std::numbers::pi, b);
  }

  static constexpr std::string_view name = "linear";
  static constexpr std::string_view description =
      "linear normal and shear springs of the pair, with Coulomb slip; dashpots and rolling resistance on "
      "demand";
  static constexpr auto own_parameters = joined(
      std::array<ParameterDescription, 4>{{
          {.name = "kn",
           .unit = "N/m",
           .minimum = 0,
           .minimum_allowed = false,
           .description = "normal stiffness of the pair",
           .of_material = [](const model::Material& m) { return detail::linear_side(m, m.kn); },
           .material_keys = "kn"},
          {.name = "ks",
           .unit = "N/m",
           .default_value = 0,
           .minimum = 0,
           .description =
               "shear stiffness of the pair; counts only where friction is positive or `tension` is on",
           .of_material = [](const model::Material& m) { return detail::linear_side(m, m.ks); },
           .material_keys = "ks"},
          friction_parameter,
          {.name = "tension",
           .kind = ParameterDescription::Kind::flag,
           .unit = "",
           .default_value = 0,
           .description = "springs that also pull, never open and never slip; for tests of linear systems"},
      }},
      ShearOptions::parameters);
  static constexpr auto parameters =
      joined(joined(own_parameters, Dashpots::parameters), RollingSpring::parameters);

  static Params params(std::span<const double> values) {
    return {.kn = values[0],
            .ks = values[1],
            .friction = values[2],
            .tension = values[3] != 0,
            .shear = ShearOptions::from_values(values.subspan(4))};
  }

 private:
  double kn_;
  double ks_;
  bool tension_;
};

using Linear = Frictional<LinearSprings>;
using DampedLinear = Damped<Linear>;
using RollingLinear = Rolling<DampedLinear>;

}  // namespace eigengrain::contact
