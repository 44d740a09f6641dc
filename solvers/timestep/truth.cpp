#include "eigengrain/timestep/truth.hpp"

#include "eigengrain/assembly/product.hpp"
#include "eigengrain/base/error.hpp"
#include "eigengrain/base/timer.hpp"
#include "eigengrain/cycle/bounds.hpp"
#include "eigengrain/cycle/step_prover.hpp"
#include "eigengrain/petsc/session.hpp"

#include "certificate.hpp"
#include "krylov.hpp"
#include "quadratic.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>
#include <vector>

namespace eigengrain::timestep {
namespace {

using assembly::LinearSystem;
using assembly::StiffnessProduct;

/// By how much of λ the proven σ may lie above it, before rounding: half of that in dt.
constexpr double margin = 1e-6;
constexpr double exact = 1e-11;

/// Start vectors that are tried where a proof says that something larger is there.
constexpr int attempts = 3;

constexpr double infinity = std::numeric_limits<double>::infinity();

/// A step and what was found out about it.
struct Found {
  double dt = infinity;
  double rate = 0;  ///< λ = (2/dt)²
  double residual = 0;
  std::vector<double> mode;
  Proof proof;
  std::int64_t products = 0;
};

/// The eigenproblem of a step dt = 2/μ: μ² x = A(μ) x, A(μ) = S (K + μC) S; without dashpots A does not
/// depend on μ.
struct Problem {
  const LinearSystem& system;
  std::vector<double> scale;   ///< S
  double largest_damping = 0;  ///< α, for bounds
  bool dashpots = false;

  /// What proves steps without the whole system.
  cycle::StepProver prover() const { return cycle::StepProver(system, largest_damping); }
};

Found search(const Problem& problem, const TruthOptions& options) {
  Found found;
  StiffnessProduct stiffness(problem.system.unknowns, problem.system.parts(), problem.scale);
  if (problem.dashpots) {
    const assembly::LinearSystem viscous = assembly::viscous_part(problem.system);
    StiffnessProduct viscosity(viscous.unknowns, viscous.parts(), problem.scale);
    const Eigenpair pair = largest_quadratic_eigenpair(stiffness, viscosity, problem.scale,
                                                       2 / problem.prover().bound(), options);
    found.rate = pair.value * pair.value;
    found.residual = pair.residual;
    found.mode = mode_of(pair.vector.get(), problem.scale);
    found.products = viscosity.products();
  } else {
    const Eigenpair pair = largest_eigenpair(stiffness, problem.scale, options);
    found.rate = pair.value;
    found.residual = pair.residual;
    found.mode = mode_of(pair.vector.get(), problem.scale);
  }
  found.products += stiffness.products();
  if (found.rate > 0) found.dt = 2 / std::sqrt(found.rate);
  return found;
}

/// Tries to prove what was found. False where something larger must be there.
bool prove(const Problem& problem, Found& found) {
  const Stopwatch watch;
  const double wanted = found.rate * (1 + margin);
  cycle::StepProver prover = problem.prover();
  for (const double more : {exact, margin})  // a bound that reaches the truth does so to rounding
    if (const double rate = found.rate * (1 + more), dt = 2 / std::sqrt(rate); prover.prove(dt)) {
      found.proof = {.by = ProofBy::bound, .dt = dt, .sigma = rate, .seconds = watch.seconds()};
      return true;
    }
  const double mu = std::sqrt(wanted);
  const auto below = [&](const assembly::LinearSystem& of) {
    return prove_below(of.unknowns, of.parts(), problem.scale, wanted);
  };
  const auto sigma =
      problem.dashpots ? below(assembly::with_viscosity(problem.system, mu)) : below(problem.system);
  if (!sigma) return false;
  // λ(μ), the largest eigenvalue of A(μ), is less than σ. At μ' = σ/μ it is less than μ'²: with K >= 0
  // A(μ') <= (μ'/μ) A(μ).
  const double dt = problem.dashpots ? 2 * mu / *sigma : 2 / std::sqrt(*sigma);
  found.proof = {.by = ProofBy::cholesky, .dt = dt, .sigma = 4 / (dt * dt), .seconds = watch.seconds()};
  return true;
}

/// The largest eigenvalue, proven where that is asked for.
Found solve(const Problem& problem, TruthOptions options) {
  const std::int64_t size = problem.system.unknowns.size();
  const bool certify =
      options.certify == Certify::always || (options.certify == Certify::small && size <= certified_unknowns);
  std::int64_t products = 0;
  double larger_than = 0;
  for (int attempt = 0; attempt < attempts; ++attempt, ++options.seed) {
    Found found = search(problem, options);
    found.products += products;
    products = found.products;
    if (found.rate == 0 || !certify || prove(problem, found)) return found;
    larger_than = std::max(larger_than, found.rate);
  }
  throw SolverError(fmt::format(
      "the eigensolver found {:.6e} s⁻² from {} start vectors, and a factorisation says that a larger "
      "eigenvalue is there; "
      "give the solver more vectors (--petsc \"-eps_ncv 100\" or \"-pep_ncv 100\")",
      larger_than, attempts));
}

/// √(1 + α) M^-½
std::vector<double> damped_scale(std::vector<double> scale, std::span<const double> alpha) {
  for (std::size_t k = 0; k < scale.size(); ++k) scale[k] *= std::sqrt(1 + alpha[k]);
  return scale;
}

/// α of all free components, where it is the same.
bool all_alike(std::span<const double> alpha, std::span<const double> scale, double& common) {
  bool first = true;
  for (std::size_t k = 0; k < scale.size(); ++k) {
    if (scale[k] == 0) continue;
    if (!first && alpha[k] != common) return false;
    common = alpha[k];
    first = false;
  }
  return true;
}

}  // namespace

std::string_view name_of(ProofBy by) {
  switch (by) {
    case ProofBy::none:
      return "none";
    case ProofBy::bound:
      return "bound";
    case ProofBy::cholesky:
      break;
  }
  return "cholesky";
}

Truth critical_timestep(const LinearSystem& system, std::span<const double> local_damping,
                        const TruthOptions& options) {
  Truth truth;
  truth.dt = truth.limit = infinity;
  const std::vector<double> scale = system.inverse_sqrt_mass();
  if (scale.empty()) return truth;
  petsc::start();

  const Stopwatch watch;
  Found undamped = solve({.system = system, .scale = scale}, options);
  if (undamped.rate == 0) return truth;  // contacts act, but only along components that are fixed
  truth.dt = undamped.dt;
  truth.lambda_max = undamped.rate;
  truth.residual = undamped.residual;
  truth.proof = undamped.proof;
  truth.products = undamped.products;
  truth.mode = std::move(undamped.mode);

  double alpha = 0;
  const bool alike = all_alike(local_damping, scale, alpha);
  if (alike && !system.has_dashpots()) {
    truth.limit = cycle::damped_timestep(truth.dt, alpha);
    truth.limit_residual = truth.residual;
    truth.limit_mode = truth.mode;
    for (double& x : truth.limit_mode) x *= std::sqrt(1 + alpha);
    truth.limit_proof = truth.proof;
    truth.limit_proof.dt = cycle::damped_timestep(truth.proof.dt, alpha);
    truth.limit_proof.sigma = truth.proof.sigma * (1 + alpha);
  } else {
    Found damped = solve({.system = system,
                          .scale = damped_scale(scale, local_damping),
                          .largest_damping = *std::ranges::max_element(local_damping),
                          .dashpots = system.has_dashpots()},
                         options);
    truth.limit = damped.dt;
    truth.limit_residual = damped.residual;
    truth.limit_proof = damped.proof;
    truth.products += damped.products;
    truth.limit_mode = std::move(damped.mode);
  }
  truth.certified = truth.proof.by != ProofBy::none && truth.limit_proof.by != ProofBy::none;
  truth.seconds = watch.seconds();
  return truth;
}

Truth critical_timestep(const LinearSystem& system, double local_damping, const TruthOptions& options) {
  return critical_timestep(system, std::vector<double>(system.mass.size(), local_damping), options);
}

}  // namespace eigengrain::timestep
