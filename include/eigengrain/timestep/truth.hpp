#pragma once

#include "eigengrain/assembly/linear_system.hpp"

#include <cstdint>
#include <span>
#include <string_view>
#include <vector>

/// The true critical timestep: an eigenvalue of the whole system.
namespace eigengrain::timestep {

/// Systems up to this size are solved as dense matrices: 43 µs against 120 at 24 unknowns, 130 against 170 at
/// 48, and 730 against 180 at 72.
inline constexpr std::int64_t dense_unknowns = 48;

/// Systems up to this size are proven where nothing else is asked for, in a quarter of a second in a periodic
/// packing (half a second at 16,000 unknowns, 7 s at 48,000); in an open box, with few contacts across any
/// cut, it is faster (1.3 s at 60,000).
inline constexpr std::int64_t certified_unknowns = 10000;

/// When to prove that nothing larger than the computed eigenvalue exists.
enum class Certify { small, always, never };

struct TruthOptions {
  double tolerance = 1e-10;  ///< wished relative residual of the eigenpair
  std::uint64_t seed = 1;    ///< of the random start vector
  std::int64_t max_products = 20000;
  Certify certify = Certify::small;
};

/// What proves a step.
enum class ProofBy {
  none,
  bound,    ///< the scaled block bound reaches the truth
  cholesky  ///< σ - M^-½ K M^-½ is positive definite, by a sparse factorisation
};

std::string_view name_of(ProofBy by);

/// That the critical step is not less than some dt, rounding included.
struct Proof {
  ProofBy by = ProofBy::none;
  double dt = 0;     ///< proven step, within the margin of the truth, s; 0 where nothing is proven
  double sigma = 0;  ///< every eigenvalue is proven to be less, s⁻²
  double seconds = 0;
};

struct Truth {
  double dt = 0;  ///< 2/√λ_max, undamped, s; infinite where nothing resists
  /// Of the cycle with the dashpots and the local damping in use: 2/μ, μ the largest root of
  /// det(μ² M' - μ C - K) = 0, M' = M/(1 + α) component by component, s.
  double limit = 0;
  double lambda_max = 0;      ///< largest eigenvalue of M⁻¹K, s⁻²
  double residual = 0;        ///< |A x - λ x| / |λ x| of the symmetric form A = M^-½ K M^-½
  double limit_residual = 0;  ///< the same of the eigenpair that `limit` comes from
  /// Whether both dt and limit are proven, within the margin that the proofs state. An eigenpair with its
  /// residual proves that λ is an eigenvalue, not that it is the largest.
  bool certified = false;
  Proof proof;        ///< of dt
  Proof limit_proof;  ///< of limit
  /// [unknowns.size()] the eigenvectors x of K x = λ M x and of (μ² M' - μ C - K) x = 0, with x·Mx or x·M'x =
  /// 1; empty where nothing resists.
  std::vector<double> mode, limit_mode;
  double seconds = 0;         ///< without start-up of libraries, proofs included
  std::int64_t products = 0;  ///< products with K, and with C
};

/// λ_max by Krylov-Schur iteration (SLEPc) on the matrix-free product, from a random Gaussian start vector,
/// and the limit of the damped cycle by SLEPc's polynomial eigensolver where it is no multiple of it. The
/// same to the bit on any number of threads. Throws SolverError when it does not converge, and when a proof
/// that was asked for does not fit into memory.
///
/// local_damping  [unknowns.size()] α of each component (assembly::damping_of_unknowns)
Truth critical_timestep(const assembly::LinearSystem& system, std::span<const double> local_damping,
                        const TruthOptions& options = {});

/// The same with one α for all.
Truth critical_timestep(const assembly::LinearSystem& system, double local_damping = 0.0,
                        const TruthOptions& options = {});

}  // namespace eigengrain::timestep
