#include "quadratic.hpp"

#include "eigengrain/base/error.hpp"

#include <Eigen/Eigenvalues>
#include <fmt/format.h>

#include <array>
#include <cmath>

namespace eigengrain::timestep {
namespace {

using assembly::StiffnessProduct;

/// Basis vectors: 161, 156 and 161 products of each kind at 16, 24 and 40 vectors.
constexpr PetscInt toar_vectors = 24;

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
