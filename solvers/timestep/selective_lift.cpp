#include "eigengrain/timestep/selective_lift.hpp"

#include "eigengrain/assembly/linear_system.hpp"
#include "eigengrain/assembly/local_damping.hpp"
#include "eigengrain/assembly/product.hpp"
#include "eigengrain/base/error.hpp"
#include "eigengrain/base/timer.hpp"
#include "eigengrain/cycle/bounds.hpp"
#include "eigengrain/petsc/session.hpp"

#include "krylov.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

namespace eigengrain::timestep {
namespace {

using assembly::LinearSystem;

/// The search ends where the true limit of the lifted system is above the wished step by less than this.
constexpr double close_enough = 1e-3;
/// And not closer than this, which is what a factorisation leaves unproven, and some.
constexpr double proof_margin = 1e-5;
constexpr int most_tries = 8;

std::vector<double> damping_of_bodies(const assembly::Model& model) {
  std::vector<double> alpha;
  for (std::size_t row = 0; row < model.bodies.position.size(); ++row)
    alpha.push_back(assembly::damping_of(model, row));
  return alpha;
}

/// A lift and the true limit with it.
struct Attempt {
  cycle::Lift lift;
  double limit = 0;
};

class Lifter {
 public:
  Lifter(const assembly::Model& model, const LinearSystem& system, const TruthOptions& options)
      : model_(model),
        system_(system),
        alpha_(damping_of_bodies(model)),
        alpha_of_unknowns_(assembly::damping_of_unknowns(model, system.unknowns)),
        options_(options) {}

  Truth truth(const LinearSystem& system, Certify certify) const {
    TruthOptions options = options_;
    options.certify = certify;
    return critical_timestep(system, alpha_of_unknowns_, options);
  }
  cycle::Lift lift(double dt) const { return cycle::lift(system_, model_.bodies.mass, alpha_, dt); }
  Attempt attempt(double dt) const {
    Attempt result{.lift = lift(dt)};
    result.limit = truth(cycle::lifted(system_, result.lift.factor), Certify::never).limit;
    return result;
  }

  /// The lift with the least mass whose true limit is not below the wished step.
  Attempt search(double wished, const Attempt& by_weights) const {
    Attempt best = by_weights;
    double ratio = by_weights.limit / wished;  // of the limit to what was lifted to
    double least = 0;                          // lifts to less do not suffice
    double most = wished;
    for (int k = 0; k < most_tries && best.limit > wished * (1 + close_enough); ++k) {
      double next = wished / ratio * (1 + 0.3 * close_enough);
      if (!(next > least && next < most)) next = 0.5 * (least + most);
      if (!(next < most * (1 - 1e-6)) || next <= 0) break;
      Attempt found = attempt(next);
      ratio = found.limit / next;
      if (found.limit < wished * (1 + proof_margin)) {
        least = next;
        continue;
      }
      most = next;
      if (found.lift.added < best.lift.added) best = std::move(found);
    }
    return best;
  }

  /// Σ (max(1, λ_i/μ²) - 1) m_i of the blocks themselves.
  double differential(double wished) const {
    return cycle::lift_of_weights(system_, model_.bodies.mass, alpha_, wished,
                                  std::vector<double>(alpha_.size(), 1.0))
        .added;
  }
  /// (λ(μ)/μ² - 1) Σ m, λ(μ) the largest eigenvalue of M'⁻¹(K + μC).
  double uniform(double wished, double mass) const {
    const double mu = 2 / wished;
    const LinearSystem whole = !system_.has_dashpots() ? system_ : assembly::with_viscosity(system_, mu);
    std::vector<double> scale = system_.inverse_sqrt_mass();
    for (std::size_t k = 0; k < scale.size(); ++k) scale[k] *= std::sqrt(1 + alpha_of_unknowns_[k]);
    assembly::StiffnessProduct product(whole.unknowns, whole.parts(), scale);
    const double lambda = largest_eigenpairs(product, scale, 1, options_).front().value;
    return std::max(0.0, lambda / (mu * mu) - 1) * mass;
  }

 private:
  const assembly::Model& model_;
  const LinearSystem& system_;
  std::vector<double> alpha_;
  std::vector<double> alpha_of_unknowns_;
  TruthOptions options_;
};

double moving_mass(const assembly::Model& model) {
  double sum = 0;
  for (std::int32_t row = 0; row < model.bodies.size(); ++row)
    if (model.bodies.clumps.owner(row) == row && !model.bodies.fixed[static_cast<std::size_t>(row)].all())
      sum += model::inertial_mass(model.bodies, static_cast<std::size_t>(row));
  return sum;
}

void require_longer(double wished, double limit) {
  if (!(wished > 0) || !std::isfinite(wished))
    throw InputError(fmt::format(
        "--lift: {} s is no step; write a time above {:.6e} s, the limit of this scene", wished, limit));
  if (!std::isfinite(limit))
    throw InputError("--lift: nothing resists a motion here, so every step is stable; leave it out");
  if (wished <= limit)
    throw InputError(
        fmt::format("--lift: {:.6e} s is within the true limit of this scene as it is, {:.6e} s: no mass is "
                    "needed for it; write a longer step, or leave it out",
                    wished, limit));
}

void compare_low_modes(const LinearSystem& before, const LinearSystem& after, SelectiveLift& result,
                       double largest) {
  if (before.unknowns.size() > low_mode_unknowns) {
    result.low_left_out = fmt::format("more than {} unknowns", low_mode_unknowns);
    return;
  }
  result.low_before = low_modes(before, compared_modes, largest);
  result.low_after = low_modes(after, compared_modes, largest);
}

}  // namespace

SelectiveLift lift_step(const assembly::Model& model, double wished, const TruthOptions& options) {
  petsc::start();
  const Stopwatch watch;
  const LinearSystem system(model);
  const Lifter lifter(model, system, options);
  const Truth before = lifter.truth(system, Certify::never);
  require_longer(wished, before.limit);

  SelectiveLift result;
  result.wished = wished;
  result.limit_before = before.limit;
  result.mass = moving_mass(model);
  const Attempt by_weights = lifter.attempt(wished);
  result.added_by_weights = by_weights.lift.added;
  result.added_differential = lifter.differential(wished);
  result.added_uniform = lifter.uniform(wished, result.mass);

  result.lift = lifter.search(wished, by_weights).lift;
  LinearSystem after = cycle::lifted(system, result.lift.factor);
  result.after = lifter.truth(after, options.certify);
  result.by_eigenvalue = result.after.certified && result.after.limit_proof.dt >= wished;
  if (!result.by_eigenvalue) {  // what nothing has proven is left to the weights
    result.lift = by_weights.lift;
    after = cycle::lifted(system, result.lift.factor);
    result.after = lifter.truth(after, options.certify);
  }
  compare_low_modes(system, after, result, before.lambda_max);
  result.seconds = watch.seconds();
  return result;
}

}  // namespace eigengrain::timestep
