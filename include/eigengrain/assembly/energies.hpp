#pragma once

#include "eigengrain/assembly/state.hpp"

namespace eigengrain::assembly {

/// Mechanical energy of a state, J. The cycle has velocities at t - dt/2 and t + dt/2 but positions at t. In
/// a cell that deforms v is what bodies move by beyond its flow.
struct Energies {
  double kinetic = 0;        ///< at t - dt/2: ½ v₋·M v₋, never negative
  double elastic = 0;        ///< stored in contacts at t
  double gravitational = 0;  ///< -Σ m g·x at t; zero for a body at the origin
  /// ½ v₋·M v₊, with the undamped v₊ of the next step of the same length. ½ v₋·M v₊ + elastic is what
  /// undamped leapfrog conserves exactly in a linear system.
  double kinetic_product = 0;
};

Energies energies_of(const State& state);

}  // namespace eigengrain::assembly
