#pragma once

#include "eigengrain/assembly/linear_system.hpp"

#include <cstdint>
#include <memory>
#include <vector>

/// Cheap estimates of the critical timestep: sums over the contacts of each body, no eigenvalue of the
/// system. All are before any safety factor, and for the system without local damping where they do not take
/// it; where nothing moves they are infinite.
namespace eigengrain::cycle {

class BodyBlocks;

/// Largest stable step of the cycle with local damping α, from that of the undamped cycle (or a bound of it):
/// dt/√(1 + α). Exact where all bodies have the same α: in the half-cycle in which it opposes the resultant,
/// the damping acts like the mass M/(1 + α) (docs/theory.md).
double damped_timestep(double undamped_dt, double local_damping);

/// PFC3D's estimate (eq. 1.31): min over bodies and degrees of freedom of √(m/k), k the sum over the body's
/// contacts of the diagonal terms of their stiffness matrices; with dashpots, of k/F(β)², F(β) = √(1 + β²) -
/// β (eq. 1.35). Depends on the frame and is NOT a bound: up to 22% above the true critical step for two
/// spheres, more for clumps (rotations along their principal axes), up to √3 in principle. s.
double diagonal_estimate(const assembly::LinearSystem& system);

/// The two parts of it, without dashpots, s; the estimate is the smaller one.
struct DiagonalEstimate {
  double translation = 0;
  double rotation = 0;
};
DiagonalEstimate elastic_diagonal_estimate(const assembly::LinearSystem& system);

/// A proven lower bound of the true critical step, for any positive weights d of the bodies (docs/theory.md):
///
///   λ_max <= max_i λ_max(M_i^-½ [Σ_c (1 + d_j/d_i) K_c,ii] M_i^-½),     Δt >= 2/√λ_max
///
/// with the factor 1 for contacts with walls and fully fixed bodies, and the body's whole block where it
/// touches its own image. It follows from |p + q|² <= (1 + t)|p|² + (1 + 1/t)|q|² on every contact, and does
/// not depend on the frame. With d = 1 it is the block bound. Each sweep replaces d by the block eigenvalues
/// that d gives (Collatz-Wielandt), which can only improve it.
class BlockBound {
 public:
  /// Refers to the system, which must outlive it.
  explicit BlockBound(const assembly::LinearSystem& system);
  ~BlockBound();

  /// The bound with the present weights, s. Rounding is on the safe side. Cost O(contacts).
  double timestep() const;
  /// [bodies] The largest eigenvalue of each body's block with the present weights, rounded up; 0 where
  /// nothing resists it, 1/s².
  std::vector<double> eigenvalues() const;
  /// One Collatz-Wielandt sweep over all bodies. Cost O(contacts) and one 6×6 eigenvalue a body.
  void sweep();

 private:
  std::unique_ptr<BodyBlocks> blocks_;
  std::vector<double> weight_;  ///< [bodies] d
};

/// BlockBound with d = 1, s.
double block_bound(const assembly::LinearSystem& system);

/// BlockBound after some sweeps, s. Three prove 0.93-0.96 of the true step in dense packings.
double scaled_block_bound(const assembly::LinearSystem& system, int sweeps = 3);

}  // namespace eigengrain::cycle
