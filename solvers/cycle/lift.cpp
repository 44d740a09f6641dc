#include "eigengrain/cycle/lift.hpp"

#include "eigengrain/base/parallel.hpp"
#include "eigengrain/cycle/step_prover.hpp"

#include "body_blocks.hpp"

#include <Eigen/Eigenvalues>

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

namespace eigengrain::cycle {
namespace {

using contact::no_body;

constexpr std::int64_t chunk_size = 256;

/// The first proof, from whose weights the sweeps start, need not be sharp.
constexpr double content = 1.02;

/// Width over which the kink of max(1, λ/μ²) is rounded off, in the first sweep and in the last.
constexpr double first_width = 0.03;
constexpr double last_width = 0.002;
/// No weight changes by more than this in a sweep, first and last (of its logarithm).
constexpr double first_stride = 0.2;
constexpr double last_stride = 0.005;
/// Bodies that carry less than this part of the slope take no part in a sweep.
constexpr double negligible = 1e-3;

/// A lift by less than this is tried to be done without, by raising weights.
constexpr std::array smallest_lifts{0.1, 0.03, 0.01, 0.003};

/// So that what holds exactly does not fail by rounding.
constexpr double beyond_rounding = 1e-9;

/// What a sweep finds out.
struct Sweep {
  double added = 0;             ///< kg, by the weights as they were
  std::vector<double> changes;  ///< [bodies] of log d
};

class Lifting {
 public:
  Lifting(const assembly::LinearSystem& system, std::span<const double> mass, std::span<const double> divisor,
          double wished)
      : blocks_(system, divisor),
        mass_(mass),
        mu_(!system.has_dashpots() ? 0 : 2 / wished),
        sigma_(4 / (wished * wished)),
        flow_(2 * system.elements.size(), 0.0) {}

  /// λ/μ² of a body's block, on the safe side of rounding.
  double ratio(std::int32_t body, std::span<const double> weight) const {
    const double ceiling = blocks_.bound(body, weight, mu_) / sigma_;
    return ceiling <= 1 ? ceiling : blocks_.eigenvalue(body, weight, mu_) / sigma_;
  }

  Lift result(std::vector<double> weight) const {
    Lift lift{.factor = std::vector<double>(weight.size(), 1.0), .weight = std::move(weight)};
    for_chunks(blocks_.bodies(), chunk_size, [&](std::int64_t begin, std::int64_t end, std::int64_t) {
      for (auto body = static_cast<std::int32_t>(begin); body < end; ++body)
        lift.factor[body] = std::max(1.0, ratio(body, lift.weight));
    });
    for (std::size_t i = 0; i < lift.factor.size(); ++i) {
      if (lift.factor[i] == 1) continue;
      ++lift.heavier;
      lift.added += (lift.factor[i] - 1) * mass_[i];
      lift.largest = std::max(lift.largest, lift.factor[i]);
    }
    return lift;
  }

  /// Slopes at these weights, and where to go from there.
  Sweep sweep(std::span<const double> weight, double width, double stride) {
    const std::int64_t bodies = blocks_.bodies();
    std::ranges::fill(flow_, 0.0);
    std::vector<double> added((static_cast<std::size_t>(bodies) + chunk_size - 1) / chunk_size, 0.0);
    for_chunks(bodies, chunk_size, [&](std::int64_t begin, std::int64_t end, std::int64_t chunk) {
      for (auto body = static_cast<std::int32_t>(begin); body < end; ++body)
        added[chunk] += flows_of(body, weight, width);
    });
    Sweep result{.changes = std::vector<double>(weight.size(), 0.0)};
    for (const double part : added) result.added += part;
    for_chunks(bodies, chunk_size, [&](std::int64_t begin, std::int64_t end, std::int64_t) {
      for (auto body = static_cast<std::int32_t>(begin); body < end; ++body)
        result.changes[body] = change_of(body, stride);
    });
    return result;
  }

 private:
  /// What the mass of a body changes by with log d_j of its neighbours, and with -log d of its own. Each end
  /// has its own place. Returns the mass that is added to the body.
  double flows_of(std::int32_t body, std::span<const double> weight, double width) {
    const auto beyond = [&](double lambda) { return lambda / sigma_ - 1; };
    const double slack = width * std::log(negligible);
    if (beyond(blocks_.bound(body, weight, mu_)) < slack) return 0;
    const Eigen::SelfAdjointEigenSolver<Mat6> pairs(blocks_.block(body, weight, mu_));
    const double excess = beyond(pairs.eigenvalues()[5]);
    const double slope = 1 / (1 + std::exp(-excess / width));
    if (slope < negligible) return 0;
    const Vec6 top = pairs.eigenvectors().col(5);
    for (const std::int32_t end : blocks_.ends(body)) {
      const std::int32_t j = blocks_.other(end);
      if (j == no_body) continue;
      flow_[end] = slope * mass_[body] * weight[j] / weight[body] * blocks_.energy(body, end, top, mu_);
    }
    return std::max(0.0, excess) * mass_[body];
  }

  double change_of(std::int32_t body, double stride) const {
    double out = 0;
    double in = 0;
    for (const std::int32_t end : blocks_.ends(body)) {
      out += flow_[end];
      if (blocks_.other(end) != no_body) in += flow_[end ^ 1];
    }
    if (out == in) return 0;
    if (in == 0) return stride;
    if (out == 0) return -stride;
    // Half of Osborne's ½ log, as all bodies change at once.
    return std::clamp(0.25 * std::log(out / in), -stride, stride);
  }

  BodyBlocks blocks_;
  std::span<const double> mass_;
  double mu_;     ///< of dashpots, 1/s
  double sigma_;  ///< μ², 1/s²
  /// [ends] change of the added mass of the end's body with log d of the other
  std::vector<double> flow_;
};

/// Weights with which fewer bodies are lifted: small lifts are taken away, and what then does not hold is
/// raised.
Lift with_fewer(const assembly::LinearSystem& system, const Lifting& lifting, std::span<const double> divisor,
                double wished, Lift best) {
  for (const double smallest : smallest_lifts) {
    std::vector<double> damping(divisor.begin(), divisor.end());
    for (std::size_t i = 0; i < damping.size(); ++i) {
      const double c = best.factor[i] - 1 < smallest ? 1.0 : best.factor[i] * (1 + beyond_rounding);
      damping[i] = damping[i] / c - 1;  // 1 + α is what the prover divides masses by
    }
    StepProver prover(system, damping);
    prover.set_weights(best.weight);
    if (!prover.prove(wished)) continue;
    Lift fewer = lifting.result(prover.weights());
    if (fewer.heavier < best.heavier && fewer.added <= best.added) best = std::move(fewer);
  }
  return best;
}

std::vector<double> divisors(const assembly::LinearSystem& system, std::span<const double> local_damping) {
  std::vector<double> divisor(static_cast<std::size_t>(system.unknowns.bodies()), 1.0);
  for (std::size_t i = 0; i < local_damping.size(); ++i) divisor[i] += local_damping[i];
  return divisor;
}

}  // namespace

Lift lift_of_weights(const assembly::LinearSystem& system, std::span<const double> mass,
                     std::span<const double> local_damping, double wished, std::vector<double> weights) {
  return Lifting(system, mass, divisors(system, local_damping), wished).result(std::move(weights));
}

Lift lift(const assembly::LinearSystem& system, std::span<const double> mass,
          std::span<const double> local_damping, double wished, const LiftOptions& options) {
  const std::vector<double> divisor = divisors(system, local_damping);
  StepProver prover(system, local_damping);
  prover.sharpen(wished, content);
  Lifting lifting(system, mass, divisor, wished);
  Lift best = lifting.result(prover.weights());
  if (best.heavier == 0) return best;
  Lift by_blocks = lifting.result(std::vector<double>(divisor.size(), 1.0));
  if (by_blocks.added < best.added) best = std::move(by_blocks);

  std::vector<double> weight = best.weight;
  std::vector<double> best_weight = weight;
  double least = best.added;
  for (int k = 0; k < options.sweeps; ++k) {
    const double done = static_cast<double>(k) / std::max(1, options.sweeps - 1);
    const double width = first_width * std::pow(last_width / first_width, done);
    const double stride = first_stride * std::pow(last_stride / first_stride, done);
    const Sweep sweep = lifting.sweep(weight, width, stride);
    if (sweep.added < least) {
      least = sweep.added;
      best_weight = weight;
    }
    for (std::size_t i = 0; i < weight.size(); ++i) weight[i] *= std::exp(sweep.changes[i]);
  }
  best = lifting.result(std::move(best_weight));
  return with_fewer(system, lifting, divisor, wished, std::move(best));
}

assembly::LinearSystem lifted(assembly::LinearSystem system, std::span<const double> factor) {
  for (std::int32_t block = 0; block < system.unknowns.blocks(); ++block)
    for (std::int32_t k = 0; k < assembly::Unknowns::block_size; ++k)
      system.mass[static_cast<std::size_t>(assembly::Unknowns::block_size * block + k)] *=
          factor[static_cast<std::size_t>(system.unknowns.body(block))];
  return system;
}

}  // namespace eigengrain::cycle
