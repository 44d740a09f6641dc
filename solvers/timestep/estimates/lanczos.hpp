#pragma once

#include "eigengrain/assembly/linear_system.hpp"

#include "timestep/gaussian_start.hpp"

#include <cstdint>
#include <vector>

/// Lanczos' method with a fixed number of steps, and what its numbers say about λ_max.
namespace eigengrain::timestep {

/// The three-term recurrence A v_j = β_j v_{j+1} + α_j v_j + β_{j-1} v_{j-1} of A = M^-½ K M^-½, without
/// reorthogonalisation: it stops when a Ritz pair has converged, before which Lanczos vectors stay orthogonal
/// to rounding (Paige 1980).
struct LanczosRun {
  std::vector<double> alpha;    ///< [steps]
  std::vector<double> beta;     ///< [steps]
  double ritz = 0;              ///< θ, the largest eigenvalue of the tridiagonal matrix: never above λ_max
  double residual = 0;          ///< |A x - θ x| of its unit vector x: some eigenvalue is within it of θ
  std::int64_t components = 0;  ///< n, free components
  std::vector<double> vector;   ///< x [unknowns.size()]; empty if not asked for
};

/// start        [unknowns.size()], not zero, zero at masked components
/// with_vector  also x: keeps all vectors, `steps` times 8 bytes an unknown
///
/// One product with K a step. The same to the bit on any number of threads.
LanczosRun lanczos(const assembly::LinearSystem& system, int steps, std::vector<double> start,
                   bool with_vector = false);

/// The largest eigenvalue that a random start is compatible with: an upper bound of λ_max but for a
/// probability `failure` over Gaussian starts (van Dorsselaer, Hochstenbach and van der Vorst, SIAM J. Matrix
/// Anal. Appl. 22:837, 2000; docs/theory.md). Means nothing for a start that is not random.
double probable_bound(const LanczosRun& run, double failure);

/// The same from θ, n and the number of steps alone (Kuczynski and Wozniakowski, SIAM J. Matrix Anal. Appl.
/// 13:1094, 1992; constant and proof in docs/theory.md).
double gap_free_bound(const LanczosRun& run, double failure);

}  // namespace eigengrain::timestep
