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

/// What one side of a Hertz contact adds in series: infinite for a rigid one.
template <class Modulus>
std::optional<double> elastic_side(const model::Material& material, const Modulus& modulus) {
  if (material.rigid) return std::numeric_limits<double>::infinity();
  if (!material.young || !material.poisson) return std::nullopt;
  return modulus(*material.young, *material.poisson);
}

}  // namespace detail

/// Hertz's contact of elastic spheres, with Mindlin's initial shear stiffness, incremental:
///
///   F_n = 4/3 E* √R* U^(3/2)      k_n = 2 E* √(R* U)      k_s = 8 G* √(R* U)
///   1/E* = Σ (1 - ν²)/E           1/G* = Σ (2 - ν)/G      G = E/2(1 + ν)
///
/// On unloading the shear force is first rescaled by k_s/k_s,old: at fixed F_s the energy ½ F_s²/k_s would
/// rise as k_s falls, and a contact sheared at a large overlap and released at a small one would give more
/// than it took (Elata and Berryman, Mech. Mater. 24:229, 1996). The normal energy is 8/15 E* √R* U^(5/2).
/// The shear part is a potential at constant overlap; where the overlap changes under shear the law
/// dissipates, both ways. For overlaps small against R*.
class HertzSprings {
 public:
  struct Params {
    double effective_young = 0;  ///< E*, Pa
    double effective_shear = 0;  ///< G*, Pa
    double friction = 0;         ///< μ
    ShearOptions shear{};
  };
  template <class Real>
  struct Memory {
    Real overlap = 0;  ///< U at the committed state, m
  };
  static constexpr std::array<StateField, 1> memory_fields{{{.name = "overlap", .unit = "m"}}};

  explicit HertzSprings(const Params& params)
      : young_(params.effective_young), shear_(params.friction > 0 ? params.effective_shear : 0.0) {}

  static constexpr bool tension() { return false; }
  bool has_shear() const { return shear_ > 0; }

  template <class Real>
  Real force(const MotionIn<Real>& motion, Memory<Real> old) const {
    return 2.0 / 3.0 * motion.overlap * tangent(motion, old);
  }
  template <class Real>
  Real tangent(const MotionIn<Real>& motion, Memory<Real> /*old*/) const {
    return 2 * young_ * root(motion);
  }
  static constexpr bool shear_follows_overlap = true;
  template <class Real>
  ShearSprings<Real> shear(const MotionIn<Real>& motion, Memory<Real> old) const {
    using std::sqrt;
    ShearSprings<Real> springs{.stiffness = 8 * shear_ * root(motion)};
    springs.stiffness_slope = springs.stiffness / (2 * motion.overlap);
    const MaskOf<Real> unloads = motion.overlap < old.overlap;
    const Real kept = sqrt(motion.overlap / old.overlap);
    springs.kept = select(unloads, kept, Real(1));
    // At the committed overlap the slope has a kink, and rounding must not decide on which side of it one is.
    springs.kept_slope = select(old.overlap - motion.overlap > overlap_rounding * motion.reduced_radius,
                                kept / (2 * motion.overlap), Real(0));
    return springs;
  }
  /// k_s at the overlap of the committed state.
  double old_shear_stiffness(const ContactMotion& motion, Memory<double> old) const {
    return 8 * shear_ * std::sqrt(motion.reduced_radius * old.overlap);
  }
  template <class Real>
  StiffnessIn<Real> stiffness(const MotionIn<Real>& motion, Memory<Real> old) const {
    return {.normal = tangent(motion, old), .shear = 8 * shear_ * root(motion)};
  }
  double energy(const ContactMotion& motion, Memory<double> old) const {
    return 0.4 * motion.overlap * force(motion, old);
  }
  template <class Real>
  Memory<Real> remembered(const MotionIn<Real>& motion, Memory<Real> /*old*/) const {
    return {motion.overlap};
  }

  /// β of the dashpot along n after which an impact leaves the part e of its velocity, where the dashpot may
  /// pull: with c = 2β√(m k_n), e = exp(-πb/√(1 - b²)), b = β√(6/5) (Tsuji et al., Powder Technol. 71:239,
  /// 1992, in closed form).
  static double damping_ratio(double restitution) {
    const double b = -std::log(restitution);
    return b / std::hypot(std::numbers::pi, b) / std::sqrt(1.2);
  }

  static constexpr std::string_view name = "hertz";
  static constexpr std::string_view description =
      "Hertz's normal force with Mindlin's shear stiffness and Coulomb slip; dashpots and rolling resistance "
      "on "
      "demand";
  static constexpr auto own_parameters = joined(
      std::array<ParameterDescription, 3>{{
          {.name = "effective_young",
           .unit = "Pa",
           .minimum = 0,
           .minimum_allowed = false,
           .description = "E* of the pair, 1/E* = sum of (1 - nu^2)/E",
           .of_material =
               [](const model::Material& m) {
                 return detail::elastic_side(m,
                                             [](double young, double nu) { return young / (1 - nu * nu); });
               },
           .material_keys = "young and poisson"},
          {.name = "effective_shear",
           .unit = "Pa",
           .minimum = 0,
           .description =
               "G* of the pair, 1/G* = sum of (2 - nu)/G, G = E/2(1 + nu); counts only where friction is "
               "positive",
           .of_material =
               [](const model::Material& m) {
                 return detail::elastic_side(
                     m, [](double young, double nu) { return young / (2 * (1 + nu) * (2 - nu)); });
               },
           .material_keys = "young and poisson"},
          friction_parameter,
      }},
      ShearOptions::parameters);
  static constexpr auto parameters =
      joined(joined(own_parameters, Dashpots::parameters), RollingSpring::parameters);

  static Params params(std::span<const double> values) {
    return {.effective_young = values[0],
            .effective_shear = values[1],
            .friction = values[2],
            .shear = ShearOptions::from_values(values.subspan(3))};
  }

 private:
  template <class Real>
  static Real root(const MotionIn<Real>& motion) {
    using std::sqrt;
    return sqrt(motion.reduced_radius * motion.overlap);
  }

  double young_;  // E*, Pa
  double shear_;  // G*, Pa
};

/// One class for Hertz's contacts with dashpots or without: beside the roots of the law dashpots cost little.
using Hertz = Damped<Frictional<HertzSprings>>;
using RollingHertz = Rolling<Hertz>;

}  // namespace eigengrain::contact
