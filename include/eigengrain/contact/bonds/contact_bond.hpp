#pragma once

#include "eigengrain/contact/bonds/bond.hpp"
#include "eigengrain/contact/laws/linear.hpp"

#include <algorithm>
#include <array>
#include <limits>
#include <optional>
#include <span>

namespace eigengrain::contact {

/// Linear springs with a contact bond (PFC3D): a point that is glued. While it holds, the springs pull as
/// they push and do not slip; it carries no moment. It breaks where
///
///   -F_n  reaches the tensile strength: the contact is open then, and forces are gone;
///   |F_s| reaches the shear strength: what is left is the unbonded contact, which carries on with F_n and
///   F_s,
///         cut to the Coulomb cone, if it is pressed.
///
/// F_n = k_n U as ever, so a bond over a gap pulls from the start. k_s counts while the bond holds, and after
/// that where friction is positive. One group holds bonded pairs and the others of the rule.
class ContactBond {
 public:
  static constexpr bool additive = false;

  struct Strength {
    double tension = std::numeric_limits<double>::infinity();  ///< N
    double shear = std::numeric_limits<double>::infinity();    ///< N
  };
  struct State {
    Linear::State contact;
    double bond = 0;  ///< 1: bonded

    bool bonded() const { return bond != 0; }
  };
  static constexpr std::array<StateField, 3> state_fields{Linear::state_fields[0], Linear::state_fields[1],
                                                          StateField{.name = "bonded", .unit = ""}};

  /// springs  of the rule; without its `tension`
  ContactBond(Linear::Params springs, const Strength& strength)
      : loose_(springs), glued_(with_tension(springs)), strength_(strength) {}

  bool needs_rotation() const { return glued_.needs_rotation(); }
  bool mid_step() const { return glued_.mid_step(); }
  State formed(const Vec3& n) const { return {.contact = loose_.formed(n)}; }
  State bond(const BondSite& site) const {
    return {.contact = glued_.formed(site.geometry.normal), .bond = 1};
  }

  bool acts(const ContactMotion& motion, const State& old) const {
    return old.bonded() || loose_.acts(motion, old.contact);
  }

  std::optional<BreakMode> failure(const ContactMotion& motion, const State& old) const {
    if (!old.bonded()) return std::nullopt;
    Linear::State next;
    const ContactForce held = glued_.evaluate(motion, old.contact, next);
    return failure(held, next, motion.normal);
  }

  ContactForce evaluate(const ContactMotion& motion, const State& old, State& next) const {
    next.bond = 0;
    if (old.bonded()) {
      const ContactForce held = glued_.evaluate(motion, old.contact, next.contact);
      if (!failure(held, next.contact, motion.normal)) {
        next.bond = 1;
        return held;
      }
    }
    return loose_.evaluate(motion, old.contact, next.contact);
  }

  ContactStiffness stiffness(const ContactMotion& motion, const State& old) const {
    return old.bonded() ? glued_.stiffness(motion, old.contact) : loose_.stiffness(motion, old.contact);
  }
  ContactTangent tangent(const ContactMotion& motion, const State& old) const {
    if (holds(motion, old)) return glued_.tangent(motion, old.contact);
    return loose_.acts(motion, old.contact) ? loose_.tangent(motion, old.contact) : ContactTangent{};
  }
  double energy(const ContactMotion& motion, const State& old) const {
    return holds(motion, old) ? glued_.energy(motion, old.contact) : loose_.energy(motion, old.contact);
  }

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
  static bool serves(std::span<const double> /*values*/) { return true; }
  /// values  of the linear law, then of the bond
  static ContactBond from_values(std::span<const double> values) {
    constexpr std::size_t springs = Linear::parameters.size();
    return {Linear::params_from(values.first(springs)),
            {.tension = values[springs], .shear = values[springs + 1]}};
  }

 private:
  static Linear::Params with_tension(Linear::Params springs) {
    springs.tension = true;
    return springs;
  }
  bool holds(const ContactMotion& motion, const State& old) const {
    return old.bonded() && !failure(motion, old);
  }
  std::optional<BreakMode> failure(const ContactForce& held, const Linear::State& at, const Vec3& n) const {
    const double tensile = -held.force.dot(n) / strength_.tension;
    const double sheared = at.shear.norm() / strength_.shear;
    if (std::max(tensile, sheared) < 1) return std::nullopt;
    return tensile >= sheared ? BreakMode::tension : BreakMode::shear;
  }

  Linear loose_;
  Linear glued_;
  Strength strength_;
};

}  // namespace eigengrain::contact
