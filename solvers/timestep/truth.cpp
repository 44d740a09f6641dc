#include "eigengrain/timestep/truth.hpp"

#include "eigengrain/assembly/product.hpp"
#include "eigengrain/base/error.hpp"
#include "eigengrain/base/timer.hpp"
#include "eigengrain/cycle/bounds.hpp"
#include "eigengrain/petsc/session.hpp"

#include "petsc/handles.hpp"

#include <fmt/format.h>

#include <cmath>
#include <limits>
#include <random>
#include <vector>

namespace eigengrain::timestep {
namespace {

using assembly::StiffnessProduct;

/// Basis vectors of the Krylov space. More of them save few products on packings (81 at 16 and at 40 vectors
/// for 10,000 balls) and cost orthogonalisation, which outweighs the products.
constexpr PetscInt krylov_vectors = 16;

/// With a residual r, λ errs by some r² of itself: far below what an estimate is judged by.
constexpr double largest_residual = 1e-8;

PetscErrorCode multiply(Mat matrix, Vec x, Vec y) {
  StiffnessProduct* product = nullptr;
  PetscCall(MatShellGetContext(matrix, &product));
  const PetscScalar* from = nullptr;
  PetscScalar* to = nullptr;
  PetscCall(VecGetArrayRead(x, &from));
  PetscCall(VecGetArrayWrite(y, &to));
  const auto size = static_cast<std::size_t>(product->size());
  product->apply({from, size}, {to, size});
  PetscCall(VecRestoreArrayRead(x, &from));
  PetscCall(VecRestoreArrayWrite(y, &to));
  return 0;
}

petsc::Matrix shell(StiffnessProduct& product) {
  const auto size = static_cast<PetscInt>(product.size());
  petsc::Matrix matrix;
  EIGENGRAIN_PETSC(MatCreateShell(PETSC_COMM_SELF, size, size, size, size, &product, matrix.put()));
  EIGENGRAIN_PETSC(MatShellSetOperation(matrix.get(), MATOP_MULT, reinterpret_cast<void (*)()>(multiply)));
  EIGENGRAIN_PETSC(MatSetOption(matrix.get(), MAT_SYMMETRIC, PETSC_TRUE));
  return matrix;
}

/// Gaussian numbers at free components, zeros at masked ones (where scale is zero).
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

petsc::Eigensolver largest_eigenvalue_solver(Mat matrix, Vec start, const TruthOptions& options) {
  petsc::Eigensolver solver;
  EIGENGRAIN_PETSC(EPSCreate(PETSC_COMM_SELF, solver.put()));
  EIGENGRAIN_PETSC(EPSSetOperators(solver.get(), matrix, nullptr));
  EIGENGRAIN_PETSC(EPSSetType(solver.get(), EPSKRYLOVSCHUR));
  EIGENGRAIN_PETSC(EPSSetConvergenceTest(solver.get(), EPS_CONV_REL));
  EIGENGRAIN_PETSC(EPSSetDimensions(solver.get(), 1, krylov_vectors, PETSC_DEFAULT));
  const auto restarts = static_cast<PetscInt>(2 * options.max_products / krylov_vectors) + 1;
  EIGENGRAIN_PETSC(EPSSetTolerances(solver.get(), options.tolerance, restarts));
  EIGENGRAIN_PETSC(EPSSetInitialSpace(solver.get(), 1, &start));
  EIGENGRAIN_PETSC(EPSSetFromOptions(solver.get()));
  // What is asked for is no option.
  EIGENGRAIN_PETSC(EPSSetProblemType(solver.get(), EPS_HEP));
  EIGENGRAIN_PETSC(EPSSetWhichEigenpairs(solver.get(), EPS_LARGEST_REAL));
  return solver;
}

/// |A x - λ x| / |λ x|, computed afresh, not the solver's own estimate.
double relative_residual(Mat matrix, Vec x, double lambda) {
  petsc::Vector r;
  EIGENGRAIN_PETSC(VecDuplicate(x, r.put()));
  EIGENGRAIN_PETSC(MatMult(matrix, x, r.get()));
  EIGENGRAIN_PETSC(VecAXPY(r.get(), -lambda, x));
  PetscReal residual = 0;
  PetscReal norm = 0;
  EIGENGRAIN_PETSC(VecNorm(r.get(), NORM_2, &residual));
  EIGENGRAIN_PETSC(VecNorm(x, NORM_2, &norm));
  return residual / (lambda * norm);
}

/// S y / |y|
std::vector<double> mode_of(Vec y, std::span<const double> scale) {
  EIGENGRAIN_PETSC(VecNormalize(y, nullptr));
  const PetscScalar* values = nullptr;
  EIGENGRAIN_PETSC(VecGetArrayRead(y, &values));
  std::vector<double> mode(scale.begin(), scale.end());
  for (std::size_t k = 0; k < mode.size(); ++k) mode[k] *= values[k];
  EIGENGRAIN_PETSC(VecRestoreArrayRead(y, &values));
  return mode;
}

/// A loose eigenpair must not pass for the truth.
void require_eigenpair(const Truth& truth) {
  if (!std::isfinite(truth.lambda_max) || truth.lambda_max < 0)
    throw SolverError(
        fmt::format("the largest eigenvalue came out as {}; stiffnesses and masses of the scene are "
                    "too far apart for double precision",
                    truth.lambda_max));
  if (!(truth.residual <= largest_residual))
    throw SolverError(
        fmt::format("the largest eigenvalue has a residual of {:.1e}, and {:.0e} is wanted; ask the "
                    "eigensolver for more (-eps_tol)",
                    truth.residual, largest_residual));
}

}  // namespace

Truth critical_timestep(const assembly::LinearSystem& system, double local_damping,
                        const TruthOptions& options) {
  Truth truth{.dt = std::numeric_limits<double>::infinity(),
              .limit = std::numeric_limits<double>::infinity()};
  const std::vector<double> scale = system.inverse_sqrt_mass();
  if (scale.empty()) return truth;
  petsc::start();

  const Stopwatch watch;
  StiffnessProduct product(system.unknowns, system.elements, scale);
  const petsc::Matrix matrix = shell(product);
  const petsc::Vector x = start_vector(matrix.get(), scale, options.seed);
  const petsc::Eigensolver solver = largest_eigenvalue_solver(matrix.get(), x.get(), options);
  EIGENGRAIN_PETSC(EPSSolve(solver.get()));
  PetscInt converged = 0;
  EIGENGRAIN_PETSC(EPSGetConverged(solver.get(), &converged));
  if (converged < 1)
    throw SolverError(
        fmt::format("the largest eigenvalue did not converge to a residual of {} in {} products with K; "
                    "ask for less, or give the solver more vectors (--petsc \"-eps_ncv 100\")",
                    options.tolerance, product.products()));
  EIGENGRAIN_PETSC(EPSGetEigenpair(solver.get(), 0, &truth.lambda_max, nullptr, x.get(), nullptr));
  if (truth.lambda_max == 0) return truth;  // contacts act, but only along components that are fixed
  truth.residual = relative_residual(matrix.get(), x.get(), truth.lambda_max);
  require_eigenpair(truth);
  truth.dt = 2.0 / std::sqrt(truth.lambda_max);
  truth.limit = system.damping.empty() ? cycle::damped_timestep(truth.dt, local_damping)
                                       : cycle::damped_block_bound(system, local_damping);
  truth.mode = truth.limit_mode = mode_of(x.get(), scale);
  for (double& value : truth.limit_mode) value *= std::sqrt(1 + local_damping);
  truth.products = product.products();
  truth.seconds = watch.seconds();
  return truth;
}

}  // namespace eigengrain::timestep
