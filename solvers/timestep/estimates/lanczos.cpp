#include "timestep/estimates/lanczos.hpp"

#include "eigengrain/assembly/product.hpp"
#include "eigengrain/base/error.hpp"
#include "eigengrain/base/parallel.hpp"

#include <Eigen/Eigenvalues>
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <span>
#include <utility>

namespace eigengrain::timestep {
namespace {

/// Relative residual at which a Ritz pair counts as converged. Until then vectors lose no more of their
/// orthogonality than some ε over this.
constexpr double converged = 1e-9;

constexpr std::int64_t chunk_size = 1 << 14;

/// Σ body(i), by chunks in their order.
template <class Body>
double sum_of(std::int64_t n, const Body& body) {
  std::vector<double> part(static_cast<std::size_t>((n + chunk_size - 1) / chunk_size), 0.0);
  for_chunks(n, chunk_size, [&](std::int64_t begin, std::int64_t end, std::int64_t chunk) {
    double sum = 0;
    for (std::int64_t i = begin; i < end; ++i) sum += body(i);
    part[chunk] = sum;
  });
  double sum = 0;
  for (const double p : part) sum += p;
  return sum;
}

struct Tridiagonal {
  Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> solver;
  explicit Tridiagonal(const LanczosRun& run) {
    const auto k = static_cast<Eigen::Index>(run.alpha.size());
    solver.computeFromTridiagonal(Eigen::Map<const Eigen::VectorXd>(run.alpha.data(), k),
                                  Eigen::Map<const Eigen::VectorXd>(run.beta.data(), k - 1));
    if (solver.info() != Eigen::Success)
      throw SolverError(fmt::format("the {} eigenvalues of Lanczos' small matrix were not found", k));
  }
  double largest() const { return solver.eigenvalues()[solver.eigenvalues().size() - 1]; }
  /// |A x - θ x| of the Ritz pair at an end: 0 the smallest, else the largest.
  double residual(double beta, bool of_largest) const {
    const Eigen::Index last = solver.eigenvalues().size() - 1;
    return beta * std::abs(solver.eigenvectors()(last, of_largest ? last : 0));
  }
};

/// Whether the Ritz pairs are to be looked at after a step. In small systems every step may be the last that
/// finds anything; later it is enough to look now and then, as eigenvalues of the small matrix cost as much
/// as a product on some thousand unknowns. A space that is whole has no next vector.
bool is_time_to_look(int step, int steps, const LanczosRun& run) {
  constexpr int always = 12;
  constexpr int every = 4;
  const double largest = *std::max_element(run.alpha.begin(), run.alpha.end());
  return step < always || step % every == every - 1 || step == steps - 1 ||
         !(run.beta.back() > converged * largest);
}

/// ln p_k(t) of the Lanczos polynomial, p_k(A) v_1 = v_{k+1}, right of its zeros.
double log_polynomial(const LanczosRun& run, double t) {
  double log = 0;
  double ratio = 1;  // p_j / p_{j-1}
  for (std::size_t j = 0; j < run.alpha.size(); ++j) {
    const double before = j > 0 ? run.beta[j - 1] / ratio : 0.0;
    ratio = (t - run.alpha[j] - before) / run.beta[j];
    if (!(ratio > 0)) return -std::numeric_limits<double>::infinity();
    log += std::log(ratio);
  }
  return log;
}

/// δ such that a component of a random unit vector in n dimensions is below it with the probability p: its
/// density is at most √((n - 1)/2π).
double least_component(double p, std::int64_t n) {
  return n > 1 ? p * std::sqrt(std::numbers::pi / (2 * static_cast<double>(n - 1))) : 1.0;
}

}  // namespace

LanczosRun lanczos(const assembly::LinearSystem& system, int steps, std::vector<double> start,
                   bool with_vector) {
  const std::vector<double> scale = system.inverse_sqrt_mass();
  LanczosRun run;
  for (const double s : scale) run.components += s > 0 ? 1 : 0;
  assembly::StiffnessProduct product(system.unknowns, system.parts(), scale);
  const auto n = static_cast<std::int64_t>(scale.size());
  std::vector<double> v = std::move(start);
  std::vector<double> before(v.size(), 0.0);
  std::vector<double> w(v.size());
  std::vector<std::vector<double>> basis;
  const double norm = std::sqrt(sum_of(n, [&](std::int64_t i) { return v[i] * v[i]; }));
  for_each_index(n, [&](std::int64_t i) { v[i] /= norm; });
  Eigen::VectorXd top;
  const auto advance = [&](double beta) {  // v_{j+1} = w / β_j
    for_each_index(n, [&](std::int64_t i) { w[i] /= beta; });
    std::swap(before, v);
    std::swap(v, w);
  };
  for (int step = 0; step < steps; ++step) {
    // w = A v_j - β_{j-1} v_{j-1} - α_j v_j
    product.apply(v, w);
    const double alpha = sum_of(n, [&](std::int64_t i) { return v[i] * w[i]; });
    const double beta_before = step > 0 ? run.beta.back() : 0.0;
    const double square = sum_of(n, [&](std::int64_t i) {
      w[i] -= alpha * v[i] + beta_before * before[i];
      return w[i] * w[i];
    });
    run.alpha.push_back(alpha);
    run.beta.push_back(std::sqrt(square));
    if (with_vector) basis.push_back(v);
    if (!is_time_to_look(step, steps, run)) {
      advance(run.beta.back());
      continue;
    }
    const Tridiagonal tridiagonal(run);
    run.ritz = tridiagonal.largest();
    run.residual = tridiagonal.residual(run.beta.back(), true);
    if (with_vector) top = tridiagonal.solver.eigenvectors().rightCols<1>();
    const double enough = converged * run.ritz;
    if (!(std::min({run.residual, tridiagonal.residual(run.beta.back(), false), run.beta.back()}) > enough))
      break;
    advance(run.beta.back());
  }
  if (with_vector) {
    run.vector.assign(scale.size(), 0.0);
    for (std::size_t j = 0; j < basis.size(); ++j)
      for (std::size_t i = 0; i < run.vector.size(); ++i)
        run.vector[i] += top[static_cast<Eigen::Index>(j)] * basis[j][i];
  }
  return run;
}

double probable_bound(const LanczosRun& run, double failure) {
  if (!(run.ritz > 0)) return 0.0;
  // With the component γ of the start along the eigenvector, |γ| p_k(λ_max) <= |p_k(A) v_1| = 1.
  const double wanted = -std::log(least_component(failure, run.components));
  double low = run.ritz;
  double high = 2 * run.ritz;
  while (log_polynomial(run, high) < wanted) high *= 2;
  for (int halving = 0; halving < 60 && high - low > 1e-14 * high; ++halving) {
    const double middle = 0.5 * (low + high);
    (log_polynomial(run, middle) < wanted ? low : high) = middle;
  }
  return high * (1 + 1e-12);
}

double gap_free_bound(const LanczosRun& run, double failure) {
  const double steps = 2 * static_cast<double>(run.alpha.size()) - 1;
  const double root = std::tanh(std::asinh(1 / least_component(failure, run.components)) / steps);
  return run.ritz / (1 - root * root);
}

}  // namespace eigengrain::timestep
