#pragma once

#include "eigengrain/contact/bonds/cement.hpp"

#include <array>
#include <optional>
#include <span>

namespace eigengrain::contact {

/// Parallel bond in total form: a cemented disk whose force and moment follow from where its two ends are and
/// how they are turned against each other since it was made. They are the gradient of an energy that knows
/// nothing of the frame, so a rigid motion makes no force, whatever its size, momentum is conserved, and the
/// leapfrog cycle keeps the energy as it does with springs.
///
/// The bond is made force-free at the contact point x_C. p_a and p_b are the arms from the two centres to
/// x_C, carried by their bodies, and q the rotation of b against a since then.
///
///   stretch            d - d_0, of the centres; n = (x_b - x_a)/d
///   shear              s = (p_b - p_a) across n, what the arms miss each other by
///   twist and bending  ψ = 2 sin(φ/2) e = 2 vec(q), along n and across it; φ, e angle and axis of q
///   energy             ½ k_n (d - d_0)² + ½ k_s |s|² + ½ κ_s |ψ|² + ½ (κ_n - κ_s) (ψ·n)²
///   force on b         F = -k_n (d - d_0) n + [k_s ((p_b - p_a)·n) s - (κ_n - κ_s) (ψ·n) ψ_⊥]/d
///   moment on b        -p_b × k_s s - T,  T = w G + ½ ψ × G,  G = κ_s ψ + (κ_n - κ_s) (ψ·n) n,  w = cos(φ/2)
///
/// with k_n = k̄_n A, k_s = k̄_s A, κ_n = k̄_s J, κ_s = k̄_n I (PFC3D eq. 1.34). For small motions this is
/// K = BᵀDB; bending alone by φ makes a moment of κ_s sin φ. It breaks by PFC3D's rule (Cement::failure), F
/// and T taken apart along n and across it.
///
/// The normal is that of the centres and not one that the bodies carry: a bond under tension would turn away
/// from one of those where k_s is small, and a cluster that tumbles with k_s = 0 comes apart.
class ParallelBond {
 public:
  using Motion = ContactPose;
  static constexpr bool additive = true;

  struct State {
    double radius = 0;                 ///< R̄, m; 0: no bond
    double length = 0;                 ///< d_0, m
    Vec3 anchor_a = Vec3::Zero();      ///< p_a in the frame of body a, m
    Vec3 anchor_b = Vec3::Zero();      ///< p_b in the frame of body b, m
    Quat relative = Quat::Identity();  ///< orientation of b in the frame of a

    bool bonded() const { return radius > 0; }
  };
  static constexpr std::array<StateField, 5> state_fields{
      {{.name = "bond_radius", .unit = "m", .components = 1},
       {.name = "bond_length", .unit = "m", .components = 1},
       {.name = "anchor_a", .unit = "m", .components = 3},
       {.name = "anchor_b", .unit = "m", .components = 3},
       {.name = "relative_orientation", .unit = "", .components = 4}}};

  static constexpr auto name = Cement::name;
  static constexpr auto description = Cement::description;
  static constexpr auto& parameters = Cement::parameters;
  static bool serves(std::span<const double> values) { return values[5] == 0; }
  static ParallelBond from_values(std::span<const double> values) {
    return ParallelBond(Cement::from_values(values));
  }

  explicit ParallelBond(const Cement& cement) : cement_(cement) {}

  bool needs_rotation() const { return true; }
  static constexpr bool mid_step() { return false; }
  ParallelBond unbreakable() const { return ParallelBond(cement_.unbreakable()); }
  /// Touching makes no bond.
  State formed(const Vec3& /*n*/) const { return {}; }
  State bond(const BondSite& site) const;

  bool acts(const ContactMotion& /*motion*/, const State& old) const { return old.bonded(); }
  std::optional<BreakMode> failure(const ContactPose& pose, const State& old) const;
  ContactForce evaluate(const ContactPose& pose, const State& old, State& next) const;
  ContactStiffness stiffness(const ContactMotion& /*motion*/, const State& old) const {
    return cement_.stiffness(DiskSection(old.radius));
  }
  Mat12 tangent(const ContactPose& pose, const State& old) const;
  double energy(const ContactPose& pose, const State& old) const;

 private:
  struct Deformation;
  struct Load;

  std::optional<BreakMode> failure(const Deformation& now, const Load& load, const DiskSection& disk) const;

  Cement cement_;
};

}  // namespace eigengrain::contact
