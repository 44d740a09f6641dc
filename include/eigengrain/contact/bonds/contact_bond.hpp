#pragma once

#include "eigengrain/contact/bonds/bond.hpp"
#include "eigengrain/contact/laws/linear.hpp"

#include <algorithm>
#include <array>
#include <limits>
#include <optional>
#include <span>
#include <string_view>
#include <vector>

namespace eigengrain::contact {

/// A law with springs that can be glued at a point: a contact bond (PFC3D). While it holds, the springs pull
/// as they push and do not slip (those of the law with its `tension`); it carries no moment. It breaks where
///
///   -F_n  reaches the tensile strength: the contact is open then, and forces are gone;
///   |F_s| reaches the shear strength: what is left is the unbonded contact,
///         which carries on with F_n and F_s, cut to the Coulomb
///         cone, if it is pressed.
///
/// F_n and F_s are those of the springs; dashpots do not count. F_n = k_n U as ever, so a bond over a gap
/// pulls from the start. k_s counts while the bond holds, and after that where friction is positive. One
/// group holds bonded pairs and the others of the rule.
template <class Base>
class Glued {
 public:
  static constexpr bool additive = false;

  struct State : Base::State {
    double bond = 0;  ///< 1: bonded

    bool bonded() const { return bond != 0; }
  };
  static constexpr auto state_fields =
      joined(Base::state_fields, std::array<StateField, 1>{{{.name = "bonded", .unit = ""}}});
  static constexpr bool asks_rate = contact::asks_rate<Base>;

  bool needs_rotation() const { return glued_.needs_rotation(); }
  bool mid_step() const { return glued_.mid_step(); }
  State formed(const Vec3& n) const { return with_bond(loose_.formed(n), 0); }
  State bond(const BondSite& site) const { return with_bond(glued_.formed(site.geometry.normal), 1); }

  bool acts(const ContactMotion& motion, const State& old) const {
    return old.bonded() || loose_.acts(motion, old);
  }

  std::optional<BreakMode> failure(const ContactMotion& motion, const State& old) const {
    if (!old.bonded()) return std::nullopt;
    State next;
    const Response<double> held = glued_.respond(motion, old, next);
    return failure(held, next);
  }

  ContactForce evaluate(const ContactMotion& motion, const State& old, State& next) const {
    if (old.bonded()) {
      const Response<double> held = glued_.respond(motion, old, next);
      next.bond = 1;
      if (!failure(held, next)) return held.force;
    }
    const ContactForce force = loose_.evaluate(motion, old, next);
    next.bond = 0;
    return force;
  }

  ContactStiffness stiffness(const ContactMotion& motion, const State& old) const {
    return old.bonded() ? glued_.stiffness(motion, old) : loose_.stiffness(motion, old);
  }
  ContactTangent tangent(const ContactMotion& motion, const State& old) const {
    if (holds(motion, old)) return glued_.tangent(motion, old);
    return loose_.acts(motion, old) ? loose_.tangent(motion, old) : ContactTangent{};
  }
  double energy(const ContactMotion& motion, const State& old) const {
    return holds(motion, old) ? glued_.energy(motion, old) : loose_.energy(motion, old);
  }
  Glued unbreakable() const {
    Glued result = *this;
    result.tension_ = result.shear_ = std::numeric_limits<double>::infinity();
    return result;
  }
  /// Of what the contact does beside its bond, which does not slip while it holds. In the step in which it
  /// breaks springs and slip are a part of what the bond releases.
  Dissipation dissipation(const ContactMotion& motion, const State& old, const State& next) const {
    if (!old.bonded()) return loose_.dissipation(motion, old, next);
    const Dissipation held = glued_.dissipation(motion, old, next);
    return {.viscous = held.viscous};
  }
  DampingRatios damping() const requires contact::asks_rate<Base> { return loose_.damping(); }

  // What scene files say.

  static constexpr std::string_view name = "contact";
  static constexpr std::string_view description =
      "a glued point of the linear law: it pulls and does not slip, carries no moment, and breaks into slip";
  static constexpr std::array<ParameterDescription, 2> parameters{{
      {.name = "tension",
       .unit = "N",
       .default_value = std::numeric_limits<double>::infinity(),
       .minimum = 0,
       .minimum_allowed = false,
       .description = "tensile strength; absent: it does not break so"},
      {.name = "shear",
       .unit = "N",
       .default_value = std::numeric_limits<double>::infinity(),
       .minimum = 0,
       .minimum_allowed = false,
       .description = "shear strength; absent: it does not break so"},
  }};
  /// values  all of the law, then those of the bond
  static bool serves(std::span<const double> values) {
    return Base::serves(values.first(Base::parameters.size()));
  }
  static Glued from_values(std::span<const double> values) { return Glued(values); }

 private:
  explicit Glued(std::span<const double> values)
      : loose_(Base::from_values(values.first(Base::parameters.size()))),
        glued_(with_tension(values.first(Base::parameters.size()))),
        tension_(values[Base::parameters.size()]),
        shear_(values[Base::parameters.size() + 1]) {}

  static Base with_tension(std::span<const double> values) {
    std::vector<double> pulling(values.begin(), values.end());
    for (std::size_t k = 0; k < pulling.size(); ++k)
      if (Base::parameters[k].name == "tension") pulling[k] = 1;
    return Base::from_values(pulling);
  }
  static State with_bond(const typename Base::State& contact, double bond) {
    State state;
    static_cast<typename Base::State&>(state) = contact;
    state.bond = bond;
    return state;
  }
  bool holds(const ContactMotion& motion, const State& old) const {
    return old.bonded() && !failure(motion, old);
  }
  std::optional<BreakMode> failure(const Response<double>& held, const State& at) const {
    const double tensile = -held.normal_force / tension_;
    const double sheared = at.shear.norm() / shear_;
    if (std::max(tensile, sheared) < 1) return std::nullopt;
    return tensile >= sheared ? BreakMode::tension : BreakMode::shear;
  }

  Base loose_;
  Base glued_;
  double tension_;  ///< N
  double shear_;    ///< N
};

using ContactBond = Glued<Linear>;
using DampedContactBond = Glued<DampedLinear>;

}  // namespace eigengrain::contact
