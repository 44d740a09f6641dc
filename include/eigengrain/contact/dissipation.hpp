#pragma once

#include "eigengrain/contact/law.hpp"

#include <concepts>

namespace eigengrain::contact {

/// Energy that contacts have turned into heat, J. Another way to lose energy is another field here, a term in
/// += and a row of assembly/ledger.hpp.
struct Dissipation {
  double slip = 0;        ///< by friction, and what shear springs hold where a contact opens
  double rolling = 0;     ///< the same of rolling and twisting resistance
  double viscous = 0;     ///< in dashpots
  double hysteresis = 0;  ///< by loading along one line and unloading along another
  double bonds = 0;       ///< released by bonds that broke

  Dissipation& operator+=(const Dissipation& other) {
    slip += other.slip;
    rolling += other.rolling;
    viscous += other.viscous;
    hysteresis += other.hysteresis;
    bonds += other.bonds;
    return *this;
  }
};

/// A law that dissipates says how much, from the old state to the one that `evaluate` has made of it.
/// Together with `energy` it accounts for the work of the force by the trapezoidal rule,
///
///     energy(next) - energy(old) + dissipation = -½ (F_old + F_next)·δ - ½ (M_old + M_next)·φ
///
/// exactly for linear springs at constant overlap and without rotation of the frame, to third order of the
/// step else. It is asked where the contact opens too: `next` is then the state of an open contact. A law
/// without the function dissipates nothing; what bonds release is found from outside
/// (assembly/dissipation.hpp).
template <class L>
concept DissipativeLaw = requires(const L& law, const ContactMotion& motion, const typename L::State& old,
                                  const typename L::State& next) {
  { law.dissipation(motion, old, next) } -> std::same_as<Dissipation>;
};

}  // namespace eigengrain::contact
