#pragma once

#include "eigengrain/assembly/ledger.hpp"
#include "eigengrain/assembly/state.hpp"

#include <string>
#include <vector>

/// The energy ledger: where energy is, where it came from and where it went (docs/theory.md, "Energy
/// ledger").
namespace eigengrain::measures {

/// Elastic energy of the contacts, J.
struct ElasticEnergy {
  double normal = 0;          ///< of the springs along n: what the overlaps alone would store
  double shear = 0;           ///< of those across n
  double rolling = 0;         ///< of those against rolling and twisting
  double bonds = 0;           ///< in parallel bonds; a contact bond has the springs of its contact
  double elements = 0;        ///< of deformable bodies
  bool has_elements = false;  ///< whether there are any

  double total() const { return normal + shear + rolling + bonds + elements; }
  ElasticEnergy& operator+=(const ElasticEnergy& other) {
    normal += other.normal;
    shear += other.shear;
    rolling += other.rolling;
    bonds += other.bonds;
    elements += other.elements;
    has_elements = has_elements || other.has_elements;
    return *this;
  }
};

/// Of the model as it stands. Summed in chunks of contacts.
ElasticEnergy elastic_energy(const assembly::Model& model);

/// What a ledger says at the time t of its state, J.
struct Ledger {
  /// ½ v₋·M (v₋ + Δt a), v₋ at t - ½Δt and a that of the coming kick. With the trapezoidal rule for the work
  /// of each step this form closes the balance exactly for linear contacts and a constant step; it may fall
  /// below zero by ⅛Δt² a·M a.
  double kinetic = 0;
  ElasticEnergy elastic;
  double gravitational = 0;             ///< -Σ m g·x, zero for a body at the origin; apart from the balance
  assembly::EnergyIntegrals integrals;  ///< up to t
  /// kinetic + elastic - (what they were) - (work done on the bodies) + (losses): of second order in the
  /// step.
  double balance_error = 0;
};

/// One number of a ledger, by the name that JSON gives it.
struct LedgerEntry {
  std::string name;
  double value = 0;  ///< J
};

/// All that a ledger says, in the order of tables and JSON.
std::vector<LedgerEntry> entries_of(const Ledger& ledger);

/// Begins the ledger of a state, or begins it anew: from here on the cycle keeps it. Throws InputError where
/// masses are scaled or the periodic cell deforms.
void begin_ledger(assembly::State& state);

/// The ledger of a state, which must have begun one. Cost: about one sum of forces.
Ledger ledger_of(const assembly::State& state);

}  // namespace eigengrain::measures
