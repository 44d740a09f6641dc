#include "krylov.hpp"

#include "eigengrain/base/error.hpp"

#include <Eigen/Eigenvalues>
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <random>
#include <string>
#include <utility>
#include <vector>

namespace eigengrain::timestep {
namespace {

using assembly::StiffnessProduct;

/// Basis vectors of the Krylov space. More of them save few products on packings (81 at 16 and at 40 vectors
/// for 10,000 balls) and cost orthogonalisation, which outweighs the products.
constexpr PetscInt krylov_vectors = 16;

/// Of the quadratic problem: 161, 156 and 161 products of each kind at 16, 24 and 40 vectors.
constexpr PetscInt toar_vectors = 24;

/// With a residual r, λ errs by some r² of itself: far below what an estimate is judged by.
constexpr double largest_residual = 1e-8;

/// Eigenvalues below this part of the largest one are zeros.
constexpr double zero_part = 1e-10;

PetscErrorCode multiply(Mat matrix, Vec x, Vec y) {
  ProductShell* shell = nullptr;
  PetscCall(MatShellGetContext(matrix, &shell));
  shell->multiply(x, y);
  return 0;
}

/// A loose eigenpair must not pass for the truth.
void require_eigenpair(const Eigenpair& pair, const char* what, const char* option) {
  if (!std::isfinite(pair.value) || pair.value < 0)
    throw SolverError(
        fmt::format("{} came out as {}; stiffnesses and masses of the scene are "
                    "too far apart for double precision",
                    what, pair.value));
  if (pair.value > 0 && !(pair.residual <= largest_residual))
    throw SolverError(
        fmt::format("{} has a residual of {:.1e}, and {:.0e} is wanted; ask the eigensolver for more ({})",
                    what, pair.residual, largest_residual, option));
}

double norm(Vec x) {
  PetscReal value = 0;
  EIGENGRAIN_PETSC(VecNorm(x, NORM_2, &value));
  return value;
}

petsc::Vector like(Vec x) {
  petsc::Vector vector;
  EIGENGRAIN_PETSC(VecDuplicate(x, vector.put()));
  return vector;
}

petsc::Eigensolver symmetric_solver(Mat matrix, Vec start, int count, const TruthOptions& options) {
  const PetscInt vectors = std::max<PetscInt>(krylov_vectors, 2 * count + 8);
  petsc::Eigensolver solver;
  EIGENGRAIN_PETSC(EPSCreate(PETSC_COMM_SELF, solver.put()));
  EIGENGRAIN_PETSC(EPSSetOperators(solver.get(), matrix, nullptr));
  EIGENGRAIN_PETSC(EPSSetType(solver.get(), EPSKRYLOVSCHUR));
  EIGENGRAIN_PETSC(EPSSetConvergenceTest(solver.get(), EPS_CONV_REL));
  EIGENGRAIN_PETSC(EPSSetDimensions(solver.get(), count, vectors, PETSC_DEFAULT));
  const auto restarts = static_cast<PetscInt>(2 * options.max_products / vectors) + 1;
  EIGENGRAIN_PETSC(EPSSetTolerances(solver.get(), options.tolerance, restarts));
  EIGENGRAIN_PETSC(EPSSetInitialSpace(solver.get(), 1, &start));
  EIGENGRAIN_PETSC(EPSSetFromOptions(solver.get()));
  // What is asked for is no option.
  EIGENGRAIN_PETSC(EPSSetProblemType(solver.get(), EPS_HEP));
  EIGENGRAIN_PETSC(EPSSetWhichEigenpairs(solver.get(), EPS_LARGEST_REAL));
  return solver;
}

/// A product as a dense matrix, column by column.
Eigen::MatrixXd dense(StiffnessProduct& product) {
  const auto size = static_cast<std::size_t>(product.size());
  Eigen::MatrixXd matrix = Eigen::MatrixXd::Identity(product.size(), product.size());
  std::vector<double> column(size);
  for (std::size_t k = 0; k < size; ++k) {
    const std::span<double> unit(matrix.col(static_cast<Eigen::Index>(k)).data(), size);
    product.apply(unit, column);
    std::ranges::copy(column, unit.begin());
  }
  return matrix;
}

/// The root of μ² = μ c + k that is not negative, c = x·Cx and k = x·Kx of a unit vector: never above the
/// largest μ, and off it by the square of the error of x.
double root(double c, double k) {
  return 0.5 * (c + std::sqrt(c * c + 4 * k));
}

/// The eigenvector of the largest μ: x of the largest eigenvalue of K + μC, μ the root of x, and so on (the
/// safeguarded iteration of Voss and Werner, Math. Meth. Appl. Sci. 4:415, 1982). μ rises to the largest one,
/// with an error that is squared each time.
Eigen::VectorXd dense_quadratic_vector(const Eigen::MatrixXd& k, const Eigen::MatrixXd& c) {
  Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> solver;
  Eigen::VectorXd x;
  double mu = 1;
  for (int step = 0; step < 20; ++step) {
    solver.compute(k + mu * c);
    x = solver.eigenvectors().rightCols<1>();
    const double before = mu;
    mu = root(x.dot(c * x), x.dot(k * x));
    if (std::abs(mu - before) <= 1e-12 * mu) break;
  }
  return x;
}

/// coefficients: -K, -C and the identity.
petsc::PolynomialEigensolver quadratic_solver(std::array<Mat, 3> coefficients, Vec start,
                                              const TruthOptions& options) {
  petsc::PolynomialEigensolver solver;
  EIGENGRAIN_PETSC(PEPCreate(PETSC_COMM_SELF, solver.put()));
  EIGENGRAIN_PETSC(PEPSetOperators(solver.get(), 3, coefficients.data()));
  EIGENGRAIN_PETSC(PEPSetType(solver.get(), PEPTOAR));
  EIGENGRAIN_PETSC(PEPSetConvergenceTest(solver.get(), PEP_CONV_REL));
  EIGENGRAIN_PETSC(PEPSetDimensions(solver.get(), 1, toar_vectors, PETSC_DEFAULT));
  const auto restarts = static_cast<PetscInt>(2 * options.max_products / toar_vectors) + 1;
  EIGENGRAIN_PETSC(PEPSetTolerances(solver.get(), options.tolerance, restarts));
  EIGENGRAIN_PETSC(PEPSetInitialSpace(solver.get(), 1, &start));
  // The leading coefficient is the identity, so nothing is to be factored.
  ST transform = nullptr;
  KSP identity = nullptr;
  PC none = nullptr;
  EIGENGRAIN_PETSC(PEPGetST(solver.get(), &transform));
  EIGENGRAIN_PETSC(STGetKSP(transform, &identity));
  EIGENGRAIN_PETSC(KSPSetType(identity, KSPPREONLY));
  EIGENGRAIN_PETSC(KSPGetPC(identity, &none));
  EIGENGRAIN_PETSC(PCSetType(none, PCNONE));
  EIGENGRAIN_PETSC(PEPSetFromOptions(solver.get()));
  EIGENGRAIN_PETSC(PEPSetProblemType(solver.get(), PEP_GENERAL));
  EIGENGRAIN_PETSC(PEPSetWhichEigenpairs(solver.get(), PEP_LARGEST_REAL));
  return solver;
}

void copy(const Eigen::VectorXd& from, Vec to) {
  PetscScalar* values = nullptr;
  EIGENGRAIN_PETSC(VecGetArrayWrite(to, &values));
  std::ranges::copy(from, values);
  EIGENGRAIN_PETSC(VecRestoreArrayWrite(to, &values));
}

/// The largest eigenpairs; x is where it starts.
std::vector<Eigenpair> iterate(Mat matrix, Vec x, int count, const TruthOptions& options) {
  const petsc::Eigensolver solver = symmetric_solver(matrix, x, count, options);
  EIGENGRAIN_PETSC(EPSSolve(solver.get()));
  PetscInt converged = 0;
  EIGENGRAIN_PETSC(EPSGetConverged(solver.get(), &converged));
  if (converged < count)
    throw SolverError(
        fmt::format("{} did not converge to a residual of {} in {} products with K; "
                    "ask for less, or give the solver more vectors (--petsc \"-eps_ncv 100\")",
                    count == 1 ? std::string("the largest eigenvalue")
                               : fmt::format("{} of the {} largest eigenvalues", count - converged, count),
                    options.tolerance, options.max_products));
  std::vector<Eigenpair> pairs;
  for (PetscInt k = 0; k < count; ++k) {
    PetscScalar value = 0;
    Eigenpair& pair = pairs.emplace_back(Eigenpair{.vector = like(x)});
    EIGENGRAIN_PETSC(EPSGetEigenpair(solver.get(), k, &value, nullptr, pair.vector.get(), nullptr));
    pair.value = value;
  }
  return pairs;
}

/// The same of a small product, as a dense matrix.
std::vector<Eigenpair> solve_dense(StiffnessProduct& product, Vec like_this, int count) {
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> solver(dense(product));
  std::vector<Eigenpair> pairs;
  for (int k = 1; k <= count; ++k) {
    const Eigen::Index column = solver.eigenvalues().size() - k;
    Eigenpair& pair =
        pairs.emplace_back(Eigenpair{.value = solver.eigenvalues()[column], .vector = like(like_this)});
    copy(solver.eigenvectors().col(column), pair.vector.get());
  }
  return pairs;
}

/// x becomes the eigenvector of the largest μ of (μ² + μ c + k) x = 0.
void iterate_quadratic(Mat k, Mat c, Vec x, const TruthOptions& options) {
  PetscInt size = 0;
  EIGENGRAIN_PETSC(VecGetSize(x, &size));
  petsc::Matrix identity;
  EIGENGRAIN_PETSC(MatCreateConstantDiagonal(PETSC_COMM_SELF, size, size, size, size, 1.0, identity.put()));
  const petsc::PolynomialEigensolver solver = quadratic_solver({k, c, identity.get()}, x, options);
  EIGENGRAIN_PETSC(PEPSolve(solver.get()));
  PetscInt converged = 0;
  EIGENGRAIN_PETSC(PEPGetConverged(solver.get(), &converged));
  if (converged < 1)
    throw SolverError(
        fmt::format("the limit of the damped cycle did not converge to a residual of {} in {} products; "
                    "ask for less, or give the solver more vectors (--petsc \"-pep_ncv 100\")",
                    options.tolerance, options.max_products));
  const petsc::Vector imaginary = like(x);  // zero: all of these eigenvalues are real
  PetscScalar value = 0;
  PetscScalar imaginary_value = 0;
  EIGENGRAIN_PETSC(PEPGetEigenpair(solver.get(), 0, &value, &imaginary_value, x, imaginary.get()));
}

}  // namespace

ProductShell::ProductShell(StiffnessProduct& product, double factor) : product_(product), factor_(factor) {
  const auto size = static_cast<PetscInt>(product.size());
  EIGENGRAIN_PETSC(MatCreateShell(PETSC_COMM_SELF, size, size, size, size, this, matrix_.put()));
  EIGENGRAIN_PETSC(MatShellSetOperation(mat(), MATOP_MULT, reinterpret_cast<void (*)()>(timestep::multiply)));
  EIGENGRAIN_PETSC(MatSetOption(mat(), MAT_SYMMETRIC, PETSC_TRUE));
}

void ProductShell::multiply(Vec x, Vec y) {
  const PetscScalar* from = nullptr;
  PetscScalar* to = nullptr;
  EIGENGRAIN_PETSC(VecGetArrayRead(x, &from));
  EIGENGRAIN_PETSC(VecGetArrayWrite(y, &to));
  const auto size = static_cast<std::size_t>(product_.size());
  product_.apply({from, size}, {to, size});
  EIGENGRAIN_PETSC(VecRestoreArrayRead(x, &from));
  EIGENGRAIN_PETSC(VecRestoreArrayWrite(y, &to));
  if (factor_ != 1) EIGENGRAIN_PETSC(VecScale(y, factor_));
}

bool is_dense(std::int64_t unknowns) {
  return unknowns <= dense_unknowns;
}

petsc::Vector start_vector(Mat matrix, std::span<const double> scale, std::uint64_t seed) {
  petsc::Vector vector;
  EIGENGRAIN_PETSC(MatCreateVecs(matrix, vector.put(), nullptr));
  PetscScalar* values = nullptr;
  EIGENGRAIN_PETSC(VecGetArrayWrite(vector.get(), &values));
  std::mt19937_64 random(seed);
  std::normal_distribution<double> gaussian;
  for (std::size_t k = 0; k < scale.size(); ++k) values[k] = scale[k] > 0 ? gaussian(random) : 0.0;
  EIGENGRAIN_PETSC(VecRestoreArrayWrite(vector.get(), &values));
  return vector;
}

double dot(Vec x, Vec y) {
  PetscScalar value = 0;
  EIGENGRAIN_PETSC(VecDot(x, y, &value));
  return value;
}

std::vector<double> mode_of(Vec y, std::span<const double> scale) {
  const PetscScalar* values = nullptr;
  EIGENGRAIN_PETSC(VecGetArrayRead(y, &values));
  std::vector<double> mode(scale.begin(), scale.end());
  const double length = std::sqrt(dot(y, y));
  for (std::size_t k = 0; k < mode.size(); ++k) mode[k] *= values[k] / length;
  EIGENGRAIN_PETSC(VecRestoreArrayRead(y, &values));
  return mode;
}

std::vector<Eigenpair> largest_eigenpairs(StiffnessProduct& product, std::span<const double> scale, int count,
                                          const TruthOptions& options) {
  const auto free = std::ranges::count_if(scale, [](double s) { return s > 0; });
  count = static_cast<int>(std::min<std::int64_t>(count, std::max<std::int64_t>(1, free)));
  const ProductShell matrix(product);
  const petsc::Vector start = start_vector(matrix.mat(), scale, options.seed);
  std::vector<Eigenpair> pairs = is_dense(product.size())
                                     ? solve_dense(product, start.get(), count)
                                     : iterate(matrix.mat(), start.get(), count, options);
  const double largest = pairs.front().value;
  for (Eigenpair& pair : pairs) {
    Vec x = pair.vector.get();
    if (pair.value > 0) {
      const petsc::Vector r = like(x);
      EIGENGRAIN_PETSC(MatMult(matrix.mat(), x, r.get()));
      EIGENGRAIN_PETSC(VecAXPY(r.get(), -pair.value, x));
      pair.residual = norm(r.get()) / (pair.value * norm(x));
    }
    // Beyond the first there may be zeros, which come out as rounding of it.
    if (&pair == pairs.data() || pair.value > zero_part * largest)
      require_eigenpair(pair, "the largest eigenvalue", "-eps_tol");
    else
      pair.value = 0;
  }
  return pairs;
}

Eigenpair largest_eigenpair(StiffnessProduct& product, std::span<const double> scale,
                            const TruthOptions& options) {
  return std::move(largest_eigenpairs(product, scale, 1, options).front());
}

Eigenpair largest_quadratic_eigenpair(StiffnessProduct& stiffness, StiffnessProduct& viscosity,
                                      std::span<const double> scale, double unit,
                                      const TruthOptions& options) {
  const ProductShell k(stiffness, -1 / (unit * unit));
  const ProductShell c(viscosity, -1 / unit);
  Eigenpair pair{.vector = start_vector(k.mat(), scale, options.seed)};
  Vec x = pair.vector.get();
  if (is_dense(stiffness.size())) {
    copy(dense_quadratic_vector(dense(stiffness) / (unit * unit), dense(viscosity) / unit), x);
  } else {
    iterate_quadratic(k.mat(), c.mat(), x, options);
  }
  const petsc::Vector kx = like(x);
  const petsc::Vector cx = like(x);
  EIGENGRAIN_PETSC(MatMult(k.mat(), x, kx.get()));
  EIGENGRAIN_PETSC(MatMult(c.mat(), x, cx.get()));
  const double square = dot(x, x);
  const double mu = root(-dot(x, cx.get()) / square, -dot(x, kx.get()) / square);
  if (mu > 0) {
    EIGENGRAIN_PETSC(VecAXPBYPCZ(kx.get(), mu * mu, mu, 1, x, cx.get()));
    pair.residual = norm(kx.get()) / (mu * mu * std::sqrt(square));
  }
  pair.value = mu * unit;
  require_eigenpair(pair, "the limit of the damped cycle", "-pep_tol");
  return pair;
}

}  // namespace eigengrain::timestep
