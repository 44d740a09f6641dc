#pragma once

#include "eigengrain/assembly/linear_system.hpp"

#include <cstdint>
#include <vector>

namespace eigengrain::timestep {

/// Beyond this many unknowns a sparse factor takes minutes (83 s at 600,000 in an open box).
inline constexpr std::int64_t low_mode_unknowns = 100000;

/// The slowest motions that something resists.
struct LowModes {
  std::vector<double> lambda{};    ///< eigenvalues of M⁻¹K, the least first, s⁻²
  std::vector<double> residual{};  ///< |A x - λ x| / |λ x| of A = M^-½ K M^-½
  double floor = 0;                ///< what is below it counts as not resisted, s⁻²
  /// [modes][unknowns.size()] eigenvectors x of K x = λ M x with x·Mx = 1, where they are asked for.
  std::vector<std::vector<double>> shape{};
};

struct LowModeOptions {
  bool shapes = false;
  /// σ over λ_max: modes far below it may be missed, and rounding disturbs shapes by 1e-16 over it.
  double shift = 1e-6;
};

/// The `count` least eigenvalues λ > 0 of K x = λ M x. Rigid motions, rattlers and mechanisms have λ = 0, and
/// as many of them as there may be do not disturb: SLEPc's Krylov-Schur iteration is given
///
///   (A + σ)⁻¹ A (A + σ)⁻¹,   of the eigenvalues λ/(λ + σ)²,
///
/// which are largest for the least λ beyond σ, and zero for λ = 0. (A + σ) is factored once
/// (CHOLMOD). Up to 300 unknowns all eigenvalues are computed (dense).
///
/// largest  λ_max, or a bound of it, s⁻²
/// Throws SolverError where the factor does not fit into memory or the iteration does not converge.
LowModes low_modes(const assembly::LinearSystem& system, int count, double largest,
                   const LowModeOptions& options = {});

}  // namespace eigengrain::timestep
