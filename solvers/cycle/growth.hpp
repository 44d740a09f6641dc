#pragma once

#include "eigengrain/assembly/state.hpp"

namespace eigengrain::cycle {

/// The change of radii in a step, from t to t + dt: contacts at t + dt are those of the new radii. Kicks of
/// the step are by the masses at t.
///
/// Its energy, where a ledger is kept, is what springs along n would gain if radii alone changed, in the mean
/// of the places at t and at t + dt, and what the masses gain in kinetic energy: with the trapezoidal rule
/// for all other works this is exact for linear contacts that stay closed (docs/theory.md).
class Growth {
 public:
  /// Before bodies move. Where no radius changes in the step nothing else of it does anything.
  Growth(assembly::State& state, double dt);

  bool any() const { return any_; }
  /// After the bodies have moved: new radii, masses and moments, and the growth noted in the near list.
  void apply();
  /// After a new near list, if there is one, and before contacts commit: counts the energy.
  void count();

 private:
  /// Energy along normals with the radii of the end of the step less that with those of its beginning, J.
  double elastic_gain();

  assembly::State& state_;
  bool any_;
  double end_;                  ///< of the step, s
  std::vector<double> before_;  ///< [bodies] radii, where a ledger is kept, m
  double gain_ = 0;             ///< at the places of t, J
};

}  // namespace eigengrain::cycle
