#pragma once

#include "eigengrain/assembly/model.hpp"
#include "eigengrain/cycle/lift.hpp"
#include "eigengrain/timestep/low_modes.hpp"
#include "eigengrain/timestep/truth.hpp"

#include <span>
#include <string>
#include <vector>

/// Which bodies to make heavier, and by how much, for a longer step; and what that costs.
namespace eigengrain::timestep {

/// How many of the slowest modes are compared.
inline constexpr int compared_modes = 6;

struct SelectiveLift {
  double wished = 0;        ///< step of the cycle, damping included, s
  double limit_before = 0;  ///< its true limit with the present masses, s
  cycle::Lift lift;
  /// Whether the lift is one whose true limit is what is wished; else it is what the weights alone prove.
  bool by_eigenvalue = false;
  Truth after;      ///< of the lifted system
  double mass = 0;  ///< of all bodies that can move, kg
  /// What the same step costs otherwise, kg: with the weights of the bodies as the only proof; each body by
  /// its own block (`differential`); all by one factor, by the true limit (`uniform`).
  double added_by_weights = 0, added_differential = 0, added_uniform = 0;
  /// The slowest modes before and after; empty beyond low_mode_unknowns
  LowModes low_before, low_after;
  std::string low_left_out{};  ///< why, or empty
  double seconds = 0;
};

/// The least mass, on the fewest bodies, that weights of the bodies find (cycle/lift.hpp), for a step of the
/// cycle that is the true limit of the lifted system: what the bound proves less than is true is not paid
/// for. Steps below the wished one are lifted to, until the true limit is the wished one, from above, to
/// 1e-3; the last is proven as `options` say (by factorisation where that is affordable or asked for,
/// otherwise it is what the weights alone prove that is handed back). Of the contacts that act now.
///
/// Throws InputError where the step is not finite and positive, or not longer than what is true without.
SelectiveLift lift_step(const assembly::Model& model, double wished, const TruthOptions& options = {});

}  // namespace eigengrain::timestep
