#pragma once

#include "eigengrain/assembly/linear_system.hpp"

#include <cstdint>
#include <vector>

/// The true critical timestep: an eigenvalue of the whole system.
namespace eigengrain::timestep {

struct TruthOptions {
  double tolerance = 1e-10;  ///< wished relative residual of the eigenpair
  std::uint64_t seed = 1;    ///< of the random start vector
  std::int64_t max_products = 20000;
};

struct Truth {
  double dt = 0;  ///< 2/√λ_max, undamped, s; infinite where nothing resists
  /// Of the cycle with the local damping in use, s; with dashpots a proven bound of it
  /// (cycle::damped_block_bound).
  double limit = 0;
  double lambda_max = 0;   ///< largest eigenvalue of M⁻¹K, s⁻²
  double residual = 0;     ///< |A x - λ x| / |λ x| of the symmetric form A = M^-½ K M^-½
  bool certified = false;  ///< whether λ_max is proven; an eigenpair with its residual proves that λ is an
                           ///< eigenvalue, not that it is the largest
  double seconds = 0;      ///< without start-up of libraries
  std::int64_t products = 0;  ///< products with K
  /// [unknowns.size()] the eigenvectors x of K x = λ M x and of (μ² M' - μ C - K) x = 0, with x·Mx or x·M'x =
  /// 1; empty where nothing resists. With dashpots the second is the first, as long as the limit is a bound.
  std::vector<double> mode{}, limit_mode{};
};

/// λ_max by Krylov-Schur iteration (SLEPc) on the matrix-free product, from a random Gaussian start vector.
/// The same to the bit on any number of threads. Throws SolverError when it does not converge.
///
/// local_damping  α of the cycle; see cycle::damped_timestep
Truth critical_timestep(const assembly::LinearSystem& system, double local_damping = 0.0,
                        const TruthOptions& options = {});

}  // namespace eigengrain::timestep
