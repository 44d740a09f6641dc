#pragma once

#include "eigengrain/assembly/linear_system.hpp"

#include <cstdint>
#include <memory>
#include <span>
#include <vector>

namespace eigengrain::cycle {

class BodyBlocks;

/// Proves that steps of the cycle are stable, with local damping and dashpots, as the scaled block bound does
/// (cycle/bounds.hpp): Δt = 2/μ is proven where for some weights d > 0 of the bodies every block
///
///   μ² M_i/(1 + α_i) - Σ_c (1 + d_j/d_i) (K + μC)_c,ii      is positive definite
///
/// (docs/theory.md). Instead of sweeping over all bodies it raises d only where a block is not, to the least
/// that will do, and looks again at the neighbours: a few percent of the bodies in a dense packing. As d only
/// rises and every raise is needed, what can be proven is found unless raises run away or too many are
/// needed, in which case the step counts as not proven and d is as it was.
class StepProver {
 public:
  /// Refers to the system, which must outlive it. Its stiffnesses and geometry may change if update() is told
  /// of it; its bodies and which of them contacts are between may not.
  ///
  /// local_damping  [bodies] α of each, or empty where none is damped
  explicit StepProver(const assembly::LinearSystem& system, std::span<const double> local_damping = {});
  /// The same with one α for all.
  StepProver(const assembly::LinearSystem& system, double local_damping);
  ~StepProver();

  /// The largest step that the present weights prove, to rounding, s: with those of a new prover the block
  /// bound. Infinite where nothing resists.
  double bound();
  /// Whether a step is proven, by the present weights or by raising some.
  bool prove(double dt);
  /// Proves as large a step as it can up to `wished`, and returns the largest that it has proven, s. Begins
  /// with bound() and goes on by 4%, then less, until a step larger by `content` or less cannot be proven: so
  /// it needs to know nothing of the truth.
  double sharpen(double wished, double content = 1.004);
  /// Contacts (indices of elements) that are others than they were; the next proof looks at their bodies.
  void update(std::span<const std::int32_t> contacts);
  /// Another α for a body. Counts once update() is told of its contacts.
  void set_damping(std::int32_t body, double local_damping);

  /// [bodies] d. Those of an earlier proof of nearly the same contacts save work; any that are positive will
  /// do.
  const std::vector<double>& weights() const { return weight_; }
  void set_weights(std::vector<double> weights);
  /// Blocks looked at so far, for measuring.
  std::int64_t blocks_looked_at() const { return looked_at_; }

 private:
  struct Change {
    std::int32_t body;
    double weight;
  };
  /// μ where there are dashpots that it matters for, else zero.
  double viscous(double mu) const;
  void look_at_all(double mu);
  double largest(double mu);
  bool holds(std::int32_t body, double mu);
  bool raise(std::int32_t body, double mu);
  bool settle(std::vector<std::int32_t> open, double mu);
  void undo(std::span<const Change> changes, double mu);

  const assembly::LinearSystem& system_;
  std::unique_ptr<BodyBlocks> blocks_;
  std::vector<double> weight_;
  /// [bodies] No eigenvalue of the body's block is larger, for any μ up to ceiling_mu_, 1/s².
  std::vector<double> ceiling_;
  double ceiling_mu_ = -1;  ///< 1/s; negative where ceilings are not known
  std::int64_t looked_at_ = 0;
};

}  // namespace eigengrain::cycle
