#pragma once

#include "eigengrain/base/vec.hpp"
#include "eigengrain/contact/geometry.hpp"
#include "eigengrain/contact/law.hpp"

#include <concepts>
#include <optional>

/// What bonds are, beyond contact laws: they are made once, hold at any distance, and break for good.
namespace eigengrain::contact {

/// Which strength was reached.
enum class BreakMode { tension, shear };

/// Two balls where a bond is made between them.
struct BondSite {
  ContactGeometry geometry;
  double radius_a = 0;  ///< m
  double radius_b = 0;  ///< m
  Quat orientation_a = Quat::Identity();
  Quat orientation_b = Quat::Identity();
};

/// A law whose contacts can be bonded. A bonded contact acts whatever its overlap is.
template <class L>
concept BondLaw = ContactLaw<L> &&
    requires(const L& law, const BondSite& site, const MotionOf<L>& motion, const typename L::State& state) {
  /// Whether the bond adds to another law on the same pair (a group of its own, which holds bonds only) or is
  /// that law (whose group holds bonded pairs and others).
  { L::additive } -> std::convertible_to<bool>;
  /// The state of a bond that is made here.
  { law.bond(site) } -> std::same_as<typename L::State>;
  { state.bonded() } -> std::same_as<bool>;
  /// How a bond breaks under the motion; nothing where it holds, or where there is none.
  { law.failure(motion, state) } -> std::same_as<std::optional<BreakMode>>;
  /// The same bond with strengths that nothing reaches: what it would do if it held.
  { law.unbreakable() } -> std::same_as<L>;
};

/// Whether contacts of a law are bonds that stand beside those of another law, between the same bodies.
template <class Law>
inline constexpr bool is_beside_law = false;
template <BondLaw Law>
inline constexpr bool is_beside_law<Law> = Law::additive;

}  // namespace eigengrain::contact
