#include "eigengrain/cycle/bounds.hpp"

#include "eigengrain/base/largest_eigenvalue.hpp"
#include "eigengrain/base/parallel.hpp"

#include "body_blocks.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>

namespace eigengrain::cycle {
namespace {

using assembly::LinearSystem;
using contact::ContactElement;
using contact::no_body;

/// Eq. 1.35: k/F(β)², F(β) = √(1 + β²) - β, along and across n.
LinearSystem stiffened_by_dashpots(const LinearSystem& system) {
  LinearSystem result = system;
  const auto factor = [](double beta) {
    const double root = std::sqrt(1 + beta * beta) + beta;  // 1/F(β)
    return root * root;
  };
  for (std::size_t e = 0; e < result.elements.size(); ++e) {
    result.elements[e].stiffness.normal *= factor(result.damping[e].beta_n);
    result.elements[e].stiffness.shear *= factor(result.damping[e].beta_s);
  }
  return result;
}

}  // namespace

double damped_timestep(double undamped_dt, double local_damping) {
  return undamped_dt / std::sqrt(1.0 + local_damping);
}

DiagonalEstimate elastic_diagonal_estimate(const LinearSystem& system) {
  const std::vector<Vec6> scale = system.inverse_sqrt_mass_of_bodies();
  std::vector<Vec6> stiffness(scale.size(), Vec6::Zero());
  const auto diagonal = [&](std::int32_t body, const Mat6& block) -> Vec6 {
    if (system.unknowns.axes(body) == nullptr) return block.diagonal();
    return system.unknowns.in_own_axes(body, body, block).diagonal();
  };
  for (const ContactElement& element : system.elements) {
    stiffness[element.a] += diagonal(element.a, contact::end_block(element, element.lever_a));
    if (element.b != no_body)
      stiffness[element.b] += diagonal(element.b, contact::end_block(element, element.lever_b));
  }
  // Of elements of n nodes n times the diagonal, not four times: the rule of four is one for contacts of two.
  for (std::size_t i = 0; i < system.nodal.bound.size(); ++i)
    stiffness[i] += 0.25 * diagonal(static_cast<std::int32_t>(i), system.nodal.bound[i]);
  Vec6 largest = Vec6::Zero();
  for (std::size_t i = 0; i < stiffness.size(); ++i)
    largest = largest.cwiseMax(scale[i].cwiseAbs2().cwiseProduct(stiffness[i]));
  return {.translation = step_of(4 * largest.head<3>().maxCoeff()),
          .rotation = step_of(4 * largest.tail<3>().maxCoeff())};
}

double diagonal_estimate(const LinearSystem& system) {
  const DiagonalEstimate parts =
      elastic_diagonal_estimate(!system.has_dashpots() ? system : stiffened_by_dashpots(system));
  return std::min(parts.translation, parts.rotation);
}

BlockBound::BlockBound(const LinearSystem& system)
    : blocks_(std::make_unique<BodyBlocks>(system)),
      weight_(static_cast<std::size_t>(blocks_->bodies()), 1.0) {}
BlockBound::~BlockBound() = default;

double BlockBound::timestep() const {
  return step_of(
      blocks_->largest(weight_, 0, [&](std::int32_t body) { return blocks_->bound(body, weight_); }));
}

std::vector<double> BlockBound::eigenvalues() const {
  std::vector<double> lambda(weight_.size());
  for_each_index(static_cast<std::int64_t>(lambda.size()), [&](std::int64_t body) {
    lambda[body] = blocks_->eigenvalue(static_cast<std::int32_t>(body), weight_);
  });
  return lambda;
}

void BlockBound::sweep() {
  std::vector<double> lambda(weight_.size());
  for_each_index(static_cast<std::int64_t>(lambda.size()), [&](std::int64_t body) {
    lambda[body] = largest_eigenvalue(blocks_->block(static_cast<std::int32_t>(body), weight_));
  });
  // d_i <- d_i λ_i. A body whose block is zero moves nothing; its weight must only stay positive.
  double largest = 0;
  for (std::size_t i = 0; i < weight_.size(); ++i) {
    if (lambda[i] > 0) weight_[i] *= lambda[i];
    largest = std::max(largest, weight_[i]);
  }
  for (double& d : weight_) d /= largest;
}

double block_bound(const LinearSystem& system) {
  return BlockBound(system).timestep();
}

double scaled_block_bound(const LinearSystem& system, int sweeps) {
  BlockBound bound(system);
  for (int sweep = 0; sweep < sweeps; ++sweep) bound.sweep();
  return bound.timestep();
}

}  // namespace eigengrain::cycle
