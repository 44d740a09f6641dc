#pragma once

#include "eigengrain/contact/law.hpp"

#include <concepts>

namespace eigengrain::contact {

/// Energy that contacts have turned into heat, J. Another way to lose energy (a dashpot, a bond that breaks)
/// is another field here, a term in += and a row of assembly/ledger.hpp.
struct Dissipation {
  double slip = 0;

  Dissipation& operator+=(const Dissipation& other) {
    slip += other.slip;
    return *this;
  }
};

/// A law that dissipates says how much, from the old state to the one that `evaluate` has made of it.
/// Together with `energy` it accounts for the work of the force by the trapezoidal rule: at constant overlap
/// and without rotation exactly,
///
///     energy(next) - energy(old) + dissipation = -½ (F_old + F_next)·δ
///
/// It is asked where the contact opens too. A law without the function dissipates nothing.
template <class L>
concept DissipativeLaw = requires(const L& law, const ContactMotion& motion, const typename L::State& old,
                                  const typename L::State& next) {
  { law.dissipation(motion, old, next) } -> std::same_as<Dissipation>;
};

}  // namespace eigengrain::contact
