#include "eigengrain/timestep/low_modes.hpp"

#include "eigengrain/assembly/eigen_matrix.hpp"
#include "eigengrain/assembly/product.hpp"
#include "eigengrain/base/error.hpp"
#include "eigengrain/petsc/session.hpp"

#include "krylov.hpp"
#include "memory.hpp"
#include "sparse_factor.hpp"

#include <Eigen/Eigenvalues>
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numeric>

namespace eigengrain::timestep {
namespace {

using assembly::LinearSystem;
using assembly::StiffnessProduct;

constexpr std::int64_t dense_low_modes = 300;

// Rounding disturbs λ/(λ + σ)² of zero modes by 1e-16 (λ_max/σ)²/λ_max, at the usual σ = 1e-6 λ_max a ten
// thousandth of 1/λ_max, at 1e-8 λ_max as much as the 1/λ of the fastest modes: both are far from those of
// the slowest ones.

/// λ over λ_max of what counts as not resisted: rounding of zeros, with room.
constexpr double floor_part = 1e-10;

constexpr double tolerance = 1e-9;
constexpr int most_restarts = 200;

/// y = (A + σ)⁻¹ A (A + σ)⁻¹ x
class SlowFirst {
 public:
  SlowFirst(const LinearSystem& system, std::span<const double> scale, double sigma)
      : product_(system.unknowns, system.parts(), scale) {
    const SparseMatrix matrix = shifted_stiffness(system.unknowns, system.parts(), scale, sigma, 1);
    factor_.analyzePattern(matrix);
    require_memory(factor_.numbers(), available_memory(), "the slowest modes",
                   "ask for a scene of fewer bodies");
    factor_.factorize(matrix);
    if (factor_.info() != Eigen::Success)
      throw SolverError("the matrix of the slowest modes could not be factored (CHOLMOD)");
    const auto size = static_cast<PetscInt>(product_.size());
    EIGENGRAIN_PETSC(MatCreateShell(PETSC_COMM_SELF, size, size, size, size, this, matrix_.put()));
    EIGENGRAIN_PETSC(MatShellSetOperation(matrix_.get(), MATOP_MULT, reinterpret_cast<void (*)()>(multiply)));
    EIGENGRAIN_PETSC(MatSetOption(matrix_.get(), MAT_SYMMETRIC, PETSC_TRUE));
  }

  Mat mat() const { return matrix_.get(); }
  StiffnessProduct& stiffness() { return product_; }

 private:
  static PetscErrorCode multiply(Mat matrix, Vec x, Vec y) {
    SlowFirst* self = nullptr;
    PetscCall(MatShellGetContext(matrix, &self));
    self->apply(x, y);
    return 0;
  }
  void apply(Vec x, Vec y) {
    const PetscScalar* from = nullptr;
    PetscScalar* to = nullptr;
    EIGENGRAIN_PETSC(VecGetArrayRead(x, &from));
    EIGENGRAIN_PETSC(VecGetArrayWrite(y, &to));
    const auto size = static_cast<Eigen::Index>(product_.size());
    const Eigen::VectorXd first = factor_.solve(Eigen::Map<const Eigen::VectorXd>(from, size));
    Eigen::VectorXd second(size);
    product_.apply({first.data(), static_cast<std::size_t>(size)},
                   {second.data(), static_cast<std::size_t>(size)});
    Eigen::Map<Eigen::VectorXd>(to, size) = factor_.solve(second);
    EIGENGRAIN_PETSC(VecRestoreArrayRead(x, &from));
    EIGENGRAIN_PETSC(VecRestoreArrayWrite(y, &to));
  }

  StiffnessProduct product_;
  SparseFactor factor_;
  petsc::Matrix matrix_;
};

LowModes dense_modes(const LinearSystem& system, int count, double floor, bool shapes) {
  LowModes result{.floor = floor};
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> all(
      assembly::dense_scaled_stiffness(system), shapes ? Eigen::ComputeEigenvectors : Eigen::EigenvaluesOnly);
  const std::vector<std::int32_t> free = system.unknowns.free_components();
  for (Eigen::Index k = 0; k < all.eigenvalues().size(); ++k) {
    const double lambda = all.eigenvalues()[k];
    if (static_cast<int>(result.lambda.size()) == count) break;
    if (lambda <= floor) continue;
    if (shapes) {
      std::vector<double>& shape = result.shape.emplace_back(system.mass.size(), 0.0);
      for (std::size_t i = 0; i < free.size(); ++i)
        shape[static_cast<std::size_t>(free[i])] = all.eigenvectors()(static_cast<Eigen::Index>(i), k) /
                                                   std::sqrt(system.mass[static_cast<std::size_t>(free[i])]);
    }
    result.lambda.push_back(lambda);
    result.residual.push_back(1e-16 * static_cast<double>(all.eigenvalues().size()) *
                              all.eigenvalues().maxCoeff() / lambda);
  }
  return result;
}

/// λ and its residual of a vector, with A itself; false where it is none of the modes.
bool judge(StiffnessProduct& stiffness, Vec x, LowModes& result) {
  const ProductShell a(stiffness);
  petsc::Vector image;
  EIGENGRAIN_PETSC(VecDuplicate(x, image.put()));
  EIGENGRAIN_PETSC(MatMult(a.mat(), x, image.get()));
  const double lambda = dot(x, image.get()) / dot(x, x);
  if (!(lambda > result.floor)) return false;
  EIGENGRAIN_PETSC(VecAXPY(image.get(), -lambda, x));
  result.lambda.push_back(lambda);
  result.residual.push_back(std::sqrt(dot(image.get(), image.get()) / dot(x, x)) / lambda);
  return true;
}

/// The least λ first.
LowModes sorted(const LowModes& modes) {
  std::vector<std::size_t> order(modes.lambda.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::ranges::stable_sort(order,
                           [&](std::size_t i, std::size_t j) { return modes.lambda[i] < modes.lambda[j]; });
  LowModes result{.floor = modes.floor};
  for (const std::size_t k : order) {
    result.lambda.push_back(modes.lambda[k]);
    result.residual.push_back(modes.residual[k]);
    if (!modes.shape.empty()) result.shape.push_back(modes.shape[k]);
  }
  return result;
}

}  // namespace

LowModes low_modes(const LinearSystem& system, int count, double largest, const LowModeOptions& options) {
  const auto free = static_cast<std::int64_t>(system.unknowns.free_components().size());
  const double floor = floor_part * largest;
  if (free == 0 || !(largest > 0)) return {};
  if (free <= dense_low_modes) return dense_modes(system, count, floor, options.shapes);
  petsc::start();
  const std::vector<double> scale = system.inverse_sqrt_mass();
  SlowFirst slow(system, scale, options.shift * largest);
  // A start in the range of the operator has nothing of the motions that nothing resists.
  const auto resisted = [&](std::uint64_t number) {
    const petsc::Vector random = start_vector(slow.mat(), scale, 1 + number);
    petsc::Vector start = like(random.get());
    EIGENGRAIN_PETSC(MatMult(slow.mat(), random.get(), start.get()));
    return start;
  };
  const petsc::Vector start = resisted(0);

  petsc::Eigensolver solver;
  Vec first = start.get();
  EIGENGRAIN_PETSC(EPSCreate(PETSC_COMM_SELF, solver.put()));
  EIGENGRAIN_PETSC(EPSSetOperators(solver.get(), slow.mat(), nullptr));
  EIGENGRAIN_PETSC(EPSSetProblemType(solver.get(), EPS_HEP));
  EIGENGRAIN_PETSC(EPSSetType(solver.get(), EPSKRYLOVSCHUR));
  EIGENGRAIN_PETSC(EPSSetWhichEigenpairs(solver.get(), EPS_LARGEST_REAL));
  EIGENGRAIN_PETSC(EPSSetDimensions(solver.get(), count, 2 * count + 20, PETSC_DEFAULT));
  EIGENGRAIN_PETSC(EPSSetTolerances(solver.get(), tolerance, most_restarts));
  EIGENGRAIN_PETSC(EPSSetInitialSpace(solver.get(), 1, &first));
  EIGENGRAIN_PETSC(EPSSolve(solver.get()));
  PetscInt converged = 0;
  EIGENGRAIN_PETSC(EPSGetConverged(solver.get(), &converged));
  if (converged < 1)
    throw SolverError(fmt::format("the slowest modes did not converge to a residual of {}", tolerance));
  std::vector<Eigenpair> pairs;
  for (PetscInt k = 0; k < std::min<PetscInt>(converged, count); ++k) {
    PetscScalar value = 0;
    Eigenpair& pair = pairs.emplace_back(Eigenpair{.vector = like(first)});
    EIGENGRAIN_PETSC(EPSGetEigenpair(solver.get(), k, &value, nullptr, pair.vector.get(), nullptr));
    pair.value = value;
  }
  solver = petsc::Eigensolver();  // its vectors are as many again
  if (count > 1 && converged >= count && count < free)
    find_left_out(slow.mat(), pairs, resisted, tolerance, most_restarts);
  LowModes result{.floor = floor};
  for (const Eigenpair& pair : pairs)
    if (judge(slow.stiffness(), pair.vector.get(), result) && options.shapes)
      result.shape.push_back(mode_of(pair.vector.get(), scale));
  // Vectors that converged to what nothing resists say that there are no more; else some are missing.
  if (converged < count && std::ssize(result.lambda) == converged)
    throw SolverError(
        fmt::format("only {} of the {} slowest modes converged to a residual of {}; ask for fewer", converged,
                    count, tolerance));
  return sorted(result);
}

}  // namespace eigengrain::timestep
