#pragma once

#include "eigengrain/contact/bonds/cement.hpp"
#include "eigengrain/contact/shear_transport.hpp"

#include <array>
#include <optional>
#include <span>

namespace eigengrain::contact {

/// Parallel bond in PFC3D's incremental form, for comparison with it: force and moment are carried with the
/// contact plane by its small-angle rotations (eqs. 1.11-1.12) and changed by
///
///   ΔF_n = -k̄_n A δ_n    ΔF_s = -k̄_s A δ_s    ΔM_n = -k̄_s J φ_n    ΔM_s = -k̄_n I φ_s
///
/// with the geometry of the end of the step. Rigid rotations leave spurious forces that add up
/// (docs/theory.md): ParallelBond has none. Strengths and stiffness are those of Cement.
///
///   energy   ½ F_n²/(k̄_n A) + ½ |F_s|²/(k̄_s A) + ½ M_n²/(k̄_s J) + ½ |M_s|²/(k̄_n I)
class IncrementalParallelBond {
 public:
  static constexpr bool additive = true;

  struct State {
    double radius = 0;            ///< R̄, m; 0: no bond
    Vec3 normal = Vec3::Zero();   ///< n at the committed state
    double normal_force = 0;      ///< F_n, N, compression positive
    Vec3 shear = Vec3::Zero();    ///< F_s, N, of the first side on the second
    double twist = 0;             ///< M_n, N m
    Vec3 bending = Vec3::Zero();  ///< M_s, N m

    bool bonded() const { return radius > 0; }
  };
  static constexpr std::array<StateField, 6> state_fields{
      {{.name = "bond_radius", .unit = "m", .components = 1},
       {.name = "normal", .unit = "", .components = 3},
       {.name = "bond_normal_force", .unit = "N", .components = 1},
       {.name = "bond_shear_force", .unit = "N", .components = 3},
       {.name = "bond_twist", .unit = "N m", .components = 1},
       {.name = "bond_bending", .unit = "N m", .components = 3}}};

  static constexpr auto name = Cement::name;
  static constexpr auto description = Cement::description;
  static constexpr auto& parameters = Cement::parameters;
  static bool serves(std::span<const double> values) { return values[5] != 0; }
  static IncrementalParallelBond from_values(std::span<const double> values) {
    return IncrementalParallelBond(Cement::from_values(values));
  }

  explicit IncrementalParallelBond(const Cement& cement) : cement_(cement) {}

  bool needs_rotation() const { return true; }
  static constexpr bool mid_step() { return false; }
  IncrementalParallelBond unbreakable() const { return IncrementalParallelBond(cement_.unbreakable()); }
  /// Touching makes no bond.
  State formed(const Vec3& /*n*/) const { return {}; }
  State bond(const BondSite& site) const {
    return {.radius = cement_.disk_radius(site), .normal = site.geometry.normal};
  }

  bool acts(const ContactMotion& /*motion*/, const State& old) const { return old.bonded(); }

  std::optional<BreakMode> failure(const ContactMotion& motion, const State& old) const {
    return old.bonded() ? failure(moved(motion, old)) : std::nullopt;
  }

  ContactForce evaluate(const ContactMotion& motion, const State& old, State& next) const {
    next = State{};
    if (!old.bonded()) return {};
    const State trial = moved(motion, old);
    if (failure(trial)) return {};
    next = trial;
    return {.force = trial.normal_force * trial.normal + trial.shear,
            .moment = trial.twist * trial.normal + trial.bending};
  }

  ContactStiffness stiffness(const ContactMotion& /*motion*/, const State& old) const {
    return cement_.stiffness(DiskSection(old.radius));
  }

  ContactTangent tangent(const ContactMotion& motion, const State& old) const {
    if (!old.bonded() || failure(motion, old)) return {};
    const ContactStiffness k = stiffness(motion, old);
    return {.translation = k.translation(motion.normal), .rotation = k.rotation(motion.normal)};
  }

  double energy(const ContactMotion& motion, const State& old) const {
    if (!old.bonded()) return 0.0;
    const State now = moved(motion, old);
    if (failure(now)) return 0.0;
    const ContactStiffness k = cement_.stiffness(DiskSection(now.radius));
    const auto stored = [](double squared, double stiffness) {
      return stiffness > 0 ? 0.5 * squared / stiffness : 0.0;
    };
    return stored(now.normal_force * now.normal_force, k.normal) + stored(now.shear.squaredNorm(), k.shear) +
           stored(now.twist * now.twist, k.twist) + stored(now.bending.squaredNorm(), k.bending);
  }

 private:
  State moved(const ContactMotion& motion, const State& old) const {
    const Vec3& n = motion.normal;
    const ContactStiffness k = cement_.stiffness(DiskSection(old.radius));
    const double stretch = motion.displacement.dot(n);
    const double twist = motion.rotation.dot(n);
    const auto carried = [&](const Vec3& v) {
      return carry_shear_small_angle(v, old.normal, n, motion.spin);
    };
    return {.radius = old.radius,
            .normal = n,
            .normal_force = old.normal_force - k.normal * stretch,
            .shear = carried(old.shear) - k.shear * (motion.displacement - stretch * n),
            .twist = old.twist - k.twist * twist,
            .bending = carried(old.bending) - k.bending * (motion.rotation - twist * n)};
  }

  std::optional<BreakMode> failure(const State& now) const {
    return cement_.failure(DiskSection(now.radius), {.normal = now.normal_force,
                                                     .shear = now.shear.norm(),
                                                     .twist = std::abs(now.twist),
                                                     .bending = now.bending.norm()});
  }

  Cement cement_;
};

}  // namespace eigengrain::contact
