#include "krylov.hpp"

#include "eigengrain/base/error.hpp"

#include <Eigen/Eigenvalues>
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>
#include <vector>

namespace eigengrain::timestep {
namespace {

using assembly::StiffnessProduct;

/// Basis vectors of the Krylov space. More of them save few products on packings (81 at 16 and at 40 vectors
/// for 10,000 balls) and cost orthogonalisation, which outweighs the products.
constexpr PetscInt krylov_vectors = 16;

/// With a residual r, λ errs by some r² of itself: far below what an estimate is judged by.
constexpr double largest_residual = 1e-8;

/// Eigenvalues below this part of the largest one are zeros.
constexpr double zero_part = 1e-10;

PetscInt restarts_of(const TruthOptions& options, PetscInt vectors) {
  return static_cast<PetscInt>(2 * options.max_products / vectors) + 1;
}

petsc::Eigensolver symmetric_solver(Mat matrix, Vec start, int count, const TruthOptions& options) {
  const PetscInt vectors = std::max<PetscInt>(krylov_vectors, 2 * count + 8);
  petsc::Eigensolver solver;
  EIGENGRAIN_PETSC(EPSCreate(PETSC_COMM_SELF, solver.put()));
  EIGENGRAIN_PETSC(EPSSetOperators(solver.get(), matrix, nullptr));
  EIGENGRAIN_PETSC(EPSSetType(solver.get(), EPSKRYLOVSCHUR));
  EIGENGRAIN_PETSC(EPSSetConvergenceTest(solver.get(), EPS_CONV_REL));
  EIGENGRAIN_PETSC(EPSSetDimensions(solver.get(), count, vectors, PETSC_DEFAULT));
  EIGENGRAIN_PETSC(EPSSetTolerances(solver.get(), options.tolerance, restarts_of(options, vectors)));
  EIGENGRAIN_PETSC(EPSSetInitialSpace(solver.get(), 1, &start));
  EIGENGRAIN_PETSC(EPSSetFromOptions(solver.get()));
  // What is asked for is no option.
  EIGENGRAIN_PETSC(EPSSetProblemType(solver.get(), EPS_HEP));
  EIGENGRAIN_PETSC(EPSSetWhichEigenpairs(solver.get(), EPS_LARGEST_REAL));
  return solver;
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

/// The largest eigenpair in the space across those that were found. Throws SolverError where it does not
/// converge to a residual of `residual` (absolute, so that zeros do at once).
Eigenpair largest_beside(Mat matrix, const std::vector<Eigenpair>& found, Vec start, double residual,
                         PetscInt restarts) {
  petsc::Eigensolver solver;
  EIGENGRAIN_PETSC(EPSCreate(PETSC_COMM_SELF, solver.put()));
  EIGENGRAIN_PETSC(EPSSetOperators(solver.get(), matrix, nullptr));
  EIGENGRAIN_PETSC(EPSSetType(solver.get(), EPSKRYLOVSCHUR));
  EIGENGRAIN_PETSC(EPSSetDimensions(solver.get(), 1, krylov_vectors, PETSC_DEFAULT));
  EIGENGRAIN_PETSC(EPSSetFromOptions(solver.get()));
  // What is asked for is no option.
  EIGENGRAIN_PETSC(EPSSetProblemType(solver.get(), EPS_HEP));
  EIGENGRAIN_PETSC(EPSSetWhichEigenpairs(solver.get(), EPS_LARGEST_REAL));
  EIGENGRAIN_PETSC(EPSSetConvergenceTest(solver.get(), EPS_CONV_ABS));
  EIGENGRAIN_PETSC(EPSSetTolerances(solver.get(), residual, restarts));
  std::vector<Vec> across;
  for (const Eigenpair& pair : found) across.push_back(pair.vector.get());
  EIGENGRAIN_PETSC(EPSSetDeflationSpace(solver.get(), static_cast<PetscInt>(across.size()), across.data()));
  EIGENGRAIN_PETSC(EPSSetInitialSpace(solver.get(), 1, &start));
  EIGENGRAIN_PETSC(EPSSolve(solver.get()));
  PetscInt converged = 0;
  EIGENGRAIN_PETSC(EPSGetConverged(solver.get(), &converged));
  if (converged < 1)
    throw SolverError(fmt::format(
        "whether {} eigenvalues are all there are of theirs was not found out in {} restarts; ask for "
        "fewer, or give the solver more vectors (--petsc \"-eps_ncv 100\")",
        found.size(), restarts));
  PetscScalar value = 0;
  Eigenpair pair{.vector = like(start)};
  EIGENGRAIN_PETSC(EPSGetEigenpair(solver.get(), 0, &value, nullptr, pair.vector.get(), nullptr));
  pair.value = value;
  return pair;
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

}  // namespace

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

void find_left_out(Mat matrix, std::vector<Eigenpair>& pairs,
                   const std::function<petsc::Vector(std::uint64_t)>& start, double tolerance,
                   PetscInt restarts) {
  // With a residual r a value errs by r at most, in the midst of others, so one that lies below by more than
  // that is of no interest.
  constexpr double loose = 1e-6;
  constexpr double greater = 1e-9;  // of itself
  const double largest = pairs.front().value;
  if (!(largest > 0)) return;
  for (std::uint64_t number = 1; number <= 2 * pairs.size(); ++number) {
    const double least = std::max(pairs.back().value, zero_part * largest);
    const petsc::Vector first = start(number);
    Eigenpair more = largest_beside(matrix, pairs, first.get(), loose * least, restarts);
    if (more.value + loose * least <= (1 + greater) * least) return;
    const petsc::Vector close = std::move(more.vector);
    more = largest_beside(matrix, pairs, close.get(), tolerance * least, restarts);
    if (more.value <= (1 + greater) * least) return;
    const auto at =
        std::ranges::find_if(pairs, [&](const Eigenpair& pair) { return pair.value < more.value; });
    pairs.insert(at, std::move(more));
    pairs.pop_back();
  }
  throw SolverError(fmt::format(
      "{} eigenvalues were not all found: there were ever more of them; ask for fewer", pairs.size()));
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
  if (!is_dense(product.size()) && count > 1 && count < free)
    find_left_out(
        matrix.mat(), pairs,
        [&](std::uint64_t number) { return start_vector(matrix.mat(), scale, options.seed + number); },
        options.tolerance, restarts_of(options, krylov_vectors));
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

}  // namespace eigengrain::timestep
