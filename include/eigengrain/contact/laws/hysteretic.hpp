#pragma once

#include "eigengrain/base/pack.hpp"
#include "eigengrain/contact/laws/frictional.hpp"

#include <array>
#include <span>
#include <string_view>

namespace eigengrain::contact {

/// Linear loading and stiffer linear unloading (Walton and Braun, J. Rheol. 30:949, 1986): a contact that
/// yields as it is pressed together and springs back along a steeper line,
///
///   loading, U at its largest    F_n = k_1 U
///   below the largest U_m        F_n = max(0, k_2 (U - U_0)),  U_0 = (1 - k_1/k_2) U_m
///
/// so that a head-on impact without other losses has the restitution e = √(k_1/k_2) at any velocity. What is
/// stored is ½ F_n²/k_2; the rest of the work of loading is lost. An open contact forgets its largest
/// overlap. The elastic stiffness (timestep, modes) is that of unloading.
class HystereticSprings {
 public:
  struct Params {
    double kn = 0;           ///< k_1, N/m
    double restitution = 1;  ///< e
    double ks = 0;           ///< N/m
    double friction = 0;     ///< μ
    ShearOptions shear{};
  };
  template <class Real>
  struct Memory {
    Real largest = 0;  ///< U_m at the committed state, m
  };
  static constexpr std::array<StateField, 1> memory_fields{{{.name = "largest_overlap", .unit = "m"}}};

  explicit HystereticSprings(const Params& params)
      : loading_(params.kn),
        unloading_(params.kn / (params.restitution * params.restitution)),
        ks_(params.friction > 0 ? params.ks : 0.0) {}

  static constexpr bool tension() { return false; }
  bool has_shear() const { return ks_ > 0; }

  template <class Real>
  Real force(const MotionIn<Real>& motion, Memory<Real> old) const {
    const Real unloading = loading_ * old.largest - unloading_ * (old.largest - motion.overlap);
    return select(motion.overlap >= old.largest, loading_ * motion.overlap,
                  select(unloading > 0.0, unloading, Real(0)));
  }
  double tangent(const ContactMotion& motion, Memory<double> old) const {
    if (!(old.largest - motion.overlap > overlap_rounding * motion.reduced_radius)) return loading_;
    return force(motion, old) > 0 ? unloading_ : 0.0;
  }
  static constexpr bool shear_follows_overlap = false;
  template <class Real>
  ShearSprings<Real> shear(const MotionIn<Real>& /*motion*/, Memory<Real> /*old*/) const {
    return {.stiffness = ks_};
  }
  double old_shear_stiffness(const ContactMotion& /*motion*/, Memory<double> /*old*/) const { return ks_; }
  template <class Real>
  StiffnessIn<Real> stiffness(const MotionIn<Real>& /*motion*/, Memory<Real> /*old*/) const {
    return {.normal = unloading_, .shear = ks_};
  }
  double energy(const ContactMotion& motion, Memory<double> old) const {
    const double f = force(motion, old);
    return 0.5 * f * f / unloading_;
  }
  /// Of the work of loading ½ k_1 U_m² the part that is not stored, ½ (k_1 U_m)²/k_2.
  double lost(Memory<double> memory) const {
    return 0.5 * loading_ * (1 - loading_ / unloading_) * memory.largest * memory.largest;
  }
  template <class Real>
  Memory<Real> remembered(const MotionIn<Real>& motion, Memory<Real> old) const {
    return {select(motion.overlap > old.largest, motion.overlap, old.largest)};
  }

  static constexpr std::string_view name = "hysteretic";
  static constexpr std::string_view description =
      "a linear spring that unloads along a steeper line, for impacts of a given restitution; linear shear "
      "spring "
      "with Coulomb slip";
  static constexpr auto own_parameters = joined(
      std::array<ParameterDescription, 4>{{
          {.name = "kn",
           .unit = "N/m",
           .minimum = 0,
           .minimum_allowed = false,
           .description = "normal stiffness of the pair while it is loaded"},
          {.name = "restitution",
           .unit = "",
           .minimum = 0,
           .minimum_allowed = false,
           .maximum = 1,
           .description =
               "the part of the normal velocity that a head-on impact leaves; unloading has the stiffness "
               "kn/restitution^2"},
          {.name = "ks",
           .unit = "N/m",
           .default_value = 0,
           .minimum = 0,
           .description = "shear stiffness of the pair; counts only where friction is positive"},
          friction_parameter,
      }},
      ShearOptions::parameters);
  static constexpr auto& parameters = own_parameters;

  static Params params(std::span<const double> values) {
    return {.kn = values[0],
            .restitution = values[1],
            .ks = values[2],
            .friction = values[3],
            .shear = ShearOptions::from_values(values.subspan(4))};
  }

 private:
  double loading_;    // k_1, N/m
  double unloading_;  // k_2, N/m
  double ks_;
};

using Hysteretic = Frictional<HystereticSprings>;

}  // namespace eigengrain::contact
