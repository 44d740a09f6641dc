#pragma once

#include "eigengrain/assembly/linear_system.hpp"
#include "eigengrain/timestep/truth.hpp"

#include <cstdint>
#include <span>
#include <vector>

/// The spectrum of M⁻¹K, and what it says of an assembly.
namespace eigengrain::spectrum {

/// Systems up to this size have all their modes computed (dense): 8 bytes for the square of it, three times
/// that with shapes.
inline constexpr std::int64_t dense_unknowns = 20000;

/// Eigenpairs of K x = λ M x on the free components.
struct Modes {
  std::vector<double> lambda;    ///< s⁻²; angular frequency √λ
  std::vector<double> residual;  ///< |A x - λ x| / |λ x| of A = M^-½ K M^-½; of zeros over λ_max
  /// [modes][unknowns.size()] x, with x·Mx = 1, zeros at fixed components; empty where they are not asked
  /// for.
  std::vector<std::vector<double>> shape;
};

/// The `count` largest, the largest first, by Krylov-Schur iteration on the matrix-free product (SLEPc).
/// Fewer where there are fewer. Throws SolverError where they do not converge.
Modes highest_modes(const assembly::LinearSystem& system, int count,
                    const timestep::TruthOptions& options = {});

/// The `count` least λ that something resists, the least first: rigid motions, rattlers and mechanisms (λ
/// below 1e-10 λ_max) are left out, however many they are (timestep::low_modes, with σ = 1e-8 λ_max). Fewer
/// where there are fewer. Throws SolverError where they do not converge, or the factor does not fit into
/// memory.
Modes lowest_modes(const assembly::LinearSystem& system, int count);

/// All of them, the least first, those of λ = 0 too (LAPACK). Throws InputError beyond dense_unknowns.
Modes all_modes(const assembly::LinearSystem& system, bool shapes);

/// How a mode is shared out.
struct Character {
  /// (Σ e_i)² / (N Σ e_i²) of the kinetic energies of the N bodies with unknowns: 1 where all move alike, 1/N
  /// where one moves alone.
  double participation = 0;
  double translation = 0;    ///< share of the kinetic energy in translations; the rest turns
  std::int32_t largest = 0;  ///< the body that has most of it (row)
  double largest_share = 0;  ///< and how much
};

Character character_of(const assembly::LinearSystem& system, std::span<const double> shape);

/// u (m), θ (rad, along the axes of space) and the share of the kinetic energy of each body [bodies]; of
/// clumps in the row of the holder. What io::write_modes draws.
struct BodyMotion {
  std::vector<Vec3> displacement, rotation;
  std::vector<double> energy;
};

BodyMotion motion_of_bodies(const assembly::LinearSystem& system, std::span<const double> shape);

}  // namespace eigengrain::spectrum
