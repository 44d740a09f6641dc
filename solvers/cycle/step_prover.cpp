#include "eigengrain/cycle/step_prover.hpp"

#include "eigengrain/base/largest_eigenvalue.hpp"
#include "eigengrain/base/parallel.hpp"

#include "body_blocks.hpp"

#include <Eigen/Cholesky>

#include <algorithm>
#include <cmath>
#include <limits>

namespace eigengrain::cycle {
namespace {

using contact::no_body;

/// A raise goes beyond what is needed by this, so that a small raise of a neighbour does not ask for another
/// one: without it the list is ten times as long. More of it spoils the last percent of what can be proven.
constexpr double beyond_need = 0.02;
/// Where raises run away there are far more of them than blocks that did not hold at first; where they do
/// not, three times as many at most, near the best that can be proven.
/// And where most blocks of a system do not hold (a lattice, where all are alike), no raise will help.
constexpr std::size_t raises_per_open_block = 3;
constexpr std::size_t raises_in_any_case = 64;

/// How far sharpen() goes at once.
constexpr double first_stride = 1.04;

std::vector<double> divisors(std::span<const double> local_damping) {
  std::vector<double> result(local_damping.begin(), local_damping.end());
  for (double& alpha : result) alpha += 1;
  return result;
}

/// Whether x - S is positive definite, on the safe side of rounding.
bool below(const Mat6& s, double x, double rounding) {
  const Mat6 shifted = x * (1 - rounding) * Mat6::Identity() - s;
  return Eigen::LLT<Mat6>(shifted).info() == Eigen::Success;
}

}  // namespace

StepProver::StepProver(const assembly::LinearSystem& system, std::span<const double> local_damping)
    : system_(system),
      blocks_(std::make_unique<BodyBlocks>(system, divisors(local_damping))),
      weight_(static_cast<std::size_t>(blocks_->bodies()), 1.0),
      ceiling_(weight_.size(), 0.0) {}
StepProver::StepProver(const assembly::LinearSystem& system, double local_damping)
    : StepProver(system, std::vector<double>(
                             local_damping > 0 ? static_cast<std::size_t>(system.unknowns.bodies()) : 0,
                             local_damping)) {}
StepProver::~StepProver() = default;

void StepProver::set_weights(std::vector<double> weights) {
  weight_ = std::move(weights);
  ceiling_mu_ = -1;
}

double StepProver::viscous(double mu) const {
  return !system_.has_dashpots() ? 0 : mu;
}

void StepProver::look_at_all(double mu) {
  for_chunks(std::ssize(weight_), BodyBlocks::chunk_size,
             [&](std::int64_t begin, std::int64_t end, std::int64_t) {
               for (auto body = static_cast<std::int32_t>(begin); body < end; ++body)
                 ceiling_[body] = blocks_->bound(body, weight_, viscous(mu));
             });
  ceiling_mu_ = !system_.has_dashpots() ? std::numeric_limits<double>::infinity() : mu;
  looked_at_ += std::ssize(weight_);
}

double StepProver::largest(double mu) {
  if (!(mu <= ceiling_mu_)) look_at_all(mu);
  return blocks_->largest(weight_, viscous(mu), [&](std::int32_t body) { return ceiling_[body]; });
}

double StepProver::bound() {
  double mu = std::sqrt(largest(0));
  if (!(mu > 0)) return std::isnan(mu) ? 0.0 : std::numeric_limits<double>::infinity();
  if (!system_.has_dashpots()) return 2 / mu;
  // The root of μ² = λ(μ), λ(μ) convex and rising: with λ beyond the last two points as a straight line
  // through them the root comes out too small, so this rises to it, and the last little is put on top.
  constexpr double content = 1e-12;
  const double elastic = mu * mu;
  double before = 0;
  double lambda_before = elastic;
  for (int iteration = 0; iteration < 40; ++iteration) {
    ceiling_mu_ = -1;
    const double lambda = largest(mu);
    const double slope = (lambda - lambda_before) / (mu - before);
    const double constant = lambda - slope * mu;
    const double root = 0.5 * (slope + std::sqrt(std::max(0.0, slope * slope + 4 * constant)));
    if (!(root > mu * (1 + content))) break;
    before = mu;
    lambda_before = lambda;
    mu = root;
  }
  for (double more = content; more < 1; more *= 2) {
    const double beyond = mu * (1 + more);
    ceiling_mu_ = -1;
    if (largest(beyond) <= beyond * beyond) return 2 / beyond;
  }
  return 0.0;
}

bool StepProver::holds(std::int32_t body, double mu) {
  const double sigma = mu * mu;
  ++looked_at_;
  // What is found here holds up to this μ only.
  if (system_.has_dashpots()) ceiling_mu_ = std::min(ceiling_mu_, mu);
  ceiling_[body] = blocks_->bound(body, weight_, viscous(mu));
  if (ceiling_[body] <= sigma) return true;
  if (!below(blocks_->block(body, weight_, viscous(mu)), sigma, blocks_->rounding(body))) return false;
  ceiling_[body] = sigma;
  return true;
}

bool StepProver::raise(std::int32_t body, double mu) {
  const double rounding = 2 * blocks_->rounding(body);
  const auto [own, others] = blocks_->parts(body, weight_, viscous(mu));
  const Mat6 room = mu * mu * (1 - rounding) * Mat6::Identity() - own;
  const Eigen::LLT<Mat6> root(room);
  if (root.info() != Eigen::Success) return false;  // no weight will do
  const Mat6 half = root.matrixL().solve(others);
  const Mat6 needed = root.matrixL().solve(half.transpose());
  const double least = largest_eigenvalue(needed);
  if (!std::isfinite(least)) return false;
  weight_[body] = std::max(weight_[body], least) * (1 + beyond_need);
  return true;
}

void StepProver::undo(std::span<const Change> changes, double mu) {
  for (std::size_t k = changes.size(); k-- > 0;) weight_[changes[k].body] = changes[k].weight;
  const auto renew = [&](std::int32_t body) { holds(body, mu); };
  for (const Change& change : changes) {
    renew(change.body);
    for (const std::int32_t end : blocks_->ends(change.body))
      if (blocks_->other(end) != no_body) renew(blocks_->other(end));
  }
}

bool StepProver::settle(std::vector<std::int32_t> open, double mu) {
  std::vector<char> queued(weight_.size(), 0);
  const std::size_t most =
      std::min(raises_per_open_block * open.size(), weight_.size() / 2) + raises_in_any_case;
  for (const std::int32_t body : open) queued[body] = 1;
  std::vector<Change> changes;
  for (std::size_t next = 0; next < open.size(); ++next) {
    const std::int32_t body = open[next];
    queued[body] = 0;
    if (holds(body, mu)) continue;
    const double before = weight_[body];
    if (changes.size() == most || !raise(body, mu)) {
      undo(changes, mu);
      return false;
    }
    changes.push_back({body, before});
    // Itself again, as what was computed as enough may not be to the last bit.
    const auto look = [&](std::int32_t other) {
      if (queued[other] != 0) return;
      queued[other] = 1;
      open.push_back(other);
    };
    look(body);
    for (const std::int32_t end : blocks_->ends(body))
      if (blocks_->other(end) != no_body) look(blocks_->other(end));
  }
  return true;
}

bool StepProver::prove(double dt) {
  const double mu = 2 / dt;
  if (!(mu > 0)) return false;
  if (!(mu <= ceiling_mu_)) look_at_all(mu);
  const double sigma = mu * mu;
  std::vector<std::int32_t> open;
  for (std::size_t i = 0; i < ceiling_.size(); ++i)
    if (!(ceiling_[i] <= sigma)) open.push_back(static_cast<std::int32_t>(i));
  std::erase_if(open, [&](std::int32_t body) { return holds(body, mu); });
  return settle(std::move(open), mu);
}

double StepProver::sharpen(double wished, double content) {
  double proven = bound();
  for (double stride = first_stride; proven < wished && std::isfinite(proven) && proven > 0;) {
    const double next = std::min(wished, stride * proven);
    if (prove(next))
      proven = next;
    else
      stride = std::sqrt(stride);
    if (stride < content) break;
  }
  return std::min(proven, wished);
}

void StepProver::set_damping(std::int32_t body, double local_damping) {
  blocks_->divide_mass(body, 1 + local_damping);
}

void StepProver::update(std::span<const std::int32_t> contacts) {
  if (ceiling_mu_ < 0) return;  // nothing is known anyway
  const double mu = !system_.has_dashpots() ? 0 : ceiling_mu_;
  const auto renew = [&](std::int32_t body) {
    if (body == no_body) return;
    ++looked_at_;
    ceiling_[body] = blocks_->bound(body, weight_, mu);
  };
  for (const std::int32_t contact : contacts) {
    const contact::ContactElement& element = system_.elements[static_cast<std::size_t>(contact)];
    renew(element.a);
    if (element.b != element.a) renew(element.b);
  }
}

}  // namespace eigengrain::cycle
