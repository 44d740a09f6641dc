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

/// Diagonal of M_i^-½ of each body, zero where the component is fixed or does not exist.
std::vector<Vec6> scale_of_bodies(const LinearSystem& system) {
  const assembly::Unknowns& unknowns = system.unknowns;
  const std::vector<double> scale = system.inverse_sqrt_mass();
  std::vector<Vec6> result(static_cast<std::size_t>(unknowns.bodies()), Vec6::Zero());
  for (std::int32_t block = 0; block < unknowns.blocks(); ++block)
    result[unknowns.body(block)].segment<3>(unknowns.is_rotation(block) ? 3 : 0) =
        Eigen::Map<const Vec3>(&scale[std::size_t{3} * block]);
  return result;
}

/// The larger of both; not a number if b is not one.
double larger(double a, double b) {
  return std::isnan(b) || b > a ? b : a;
}

/// Not a number (an overflow in the scene) proves nothing.
double timestep_of(double lambda) {
  if (std::isnan(lambda)) return 0.0;
  return lambda > 0 ? 2.0 / std::sqrt(lambda) : std::numeric_limits<double>::infinity();
}

double elastic_estimate(const LinearSystem& system) {
  const std::vector<Vec6> scale = scale_of_bodies(system);
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
  double largest = 0;
  for (std::size_t i = 0; i < stiffness.size(); ++i)
    largest = std::max(largest, scale[i].cwiseAbs2().cwiseProduct(stiffness[i]).maxCoeff());
  return timestep_of(4 * largest);
}

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

double diagonal_estimate(const LinearSystem& system) {
  return system.damping.empty() ? elastic_estimate(system) : elastic_estimate(stiffened_by_dashpots(system));
}

BlockBound::BlockBound(const LinearSystem& system)
    : blocks_(std::make_unique<BodyBlocks>(system)),
      weight_(static_cast<std::size_t>(blocks_->bodies()), 1.0) {}
BlockBound::~BlockBound() = default;

double BlockBound::eigenvalue(std::int32_t body) const {
  return largest_eigenvalue(blocks_->block(body, weight_)) *
         (1 + rounding_of_block(std::ssize(blocks_->ends(body))));
}

double BlockBound::timestep() const {
  constexpr std::int64_t chunk_size = 1024;
  const auto bodies = static_cast<std::int64_t>(weight_.size());
  std::vector<double> largest_of_chunk(static_cast<std::size_t>((bodies + chunk_size - 1) / chunk_size), 0.0);
  for_chunks(bodies, chunk_size, [&](std::int64_t begin, std::int64_t end, std::int64_t chunk) {
    double& largest = largest_of_chunk[chunk];
    for (auto body = static_cast<std::int32_t>(begin); body < end; ++body)
      // Few bodies can hold the largest eigenvalue; the others need none.
      if (!(blocks_->bound(body, weight_) <= largest)) largest = larger(largest, eigenvalue(body));
  });
  double largest = 0;
  for (const double lambda : largest_of_chunk) largest = larger(largest, lambda);
  return timestep_of(largest);
}

std::vector<double> BlockBound::eigenvalues() const {
  std::vector<double> lambda(weight_.size());
  for_each_index(static_cast<std::int64_t>(lambda.size()),
                 [&](std::int64_t body) { lambda[body] = eigenvalue(static_cast<std::int32_t>(body)); });
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
