#include "linear_solver.hpp"

#include "eigengrain/base/error.hpp"

#include <fmt/format.h>
#include <petscksp.h>

#include <algorithm>
#include <cmath>
#include <exception>
#include <optional>
#include <utility>

namespace eigengrain::relaxation {
namespace {

using petsc::Matrix;
using petsc::Vector;
using KrylovSolver = petsc::Owner<KSP, KSPDestroy>;
using NullSpace = petsc::Owner<MatNullSpace, MatNullSpaceDestroy>;
using Random = petsc::Owner<PetscRandom, PetscRandomDestroy>;

/// Unknowns up to which a sparse factor is no matter, fits into memory, and beyond which multigrid is said to
/// win over block ILU(0).
constexpr std::int64_t small = 3000;
constexpr std::int64_t most_factored = 200000;
constexpr std::int64_t least_for_multigrid = 20000000;
/// Where block ILU(0) begins to fail.
constexpr double high_contrast = 1e3;

/// Diagonals are raised by these parts where an incomplete factor of the matrix itself is not definite
/// (Manteuffel, Math. Comp. 34:473, 1980).
constexpr double raises[] = {0, 1e-3, 1e-2, 1e-1};

/// Where rounding made a method believe in more than it had, this much is let pass.
constexpr double drift = 10;

constexpr double symmetric_within = 1e-13;

bool is_factor(LinearMethod method) {
  return method == LinearMethod::cholmod || method == LinearMethod::mumps;
}
bool is_incomplete(LinearMethod method) {
  return method == LinearMethod::icc_cg || method == LinearMethod::ilu_bicgstab ||
         method == LinearMethod::ilu_gmres;
}
bool needs_scalars(LinearMethod method) {
  return is_factor(method) || method == LinearMethod::gamg || method == LinearMethod::hypre;
}
bool needs_symmetry(LinearMethod method) {
  return method == LinearMethod::icc_cg || method == LinearMethod::jacobi_cg ||
         method == LinearMethod::cholmod;
}

int most_iterations(LinearMethod method) {
  if (is_factor(method)) return 20;  // of refinement
  if (is_incomplete(method)) return 2000;
  return method == LinearMethod::jacobi_cg || method == LinearMethod::jacobi_gmres ? 20000 : 2000;
}

double norm_of(Vec x) {
  PetscReal norm = 0;
  EIGENGRAIN_PETSC(VecNorm(x, NORM_2, &norm));
  return norm;
}

Vector like(Vec x) {
  Vector copy;
  EIGENGRAIN_PETSC(VecDuplicate(x, copy.put()));
  return copy;
}

/// Whether x·Ay = y·Ax for one pair of random vectors.
bool is_symmetric(Mat matrix) {
  Vector x;
  EIGENGRAIN_PETSC(MatCreateVecs(matrix, x.put(), nullptr));
  const Vector y = like(x.get());
  const Vector image = like(x.get());
  Random random;
  EIGENGRAIN_PETSC(PetscRandomCreate(PETSC_COMM_SELF, random.put()));
  EIGENGRAIN_PETSC(PetscRandomSetSeed(random.get(), 1));
  EIGENGRAIN_PETSC(PetscRandomSeed(random.get()));
  EIGENGRAIN_PETSC(VecSetRandom(x.get(), random.get()));
  EIGENGRAIN_PETSC(VecSetRandom(y.get(), random.get()));
  PetscScalar left = 0;
  PetscScalar right = 0;
  EIGENGRAIN_PETSC(MatMult(matrix, y.get(), image.get()));
  EIGENGRAIN_PETSC(VecDot(x.get(), image.get(), &left));
  const double size = norm_of(image.get()) * norm_of(x.get());
  EIGENGRAIN_PETSC(MatMult(matrix, x.get(), image.get()));
  EIGENGRAIN_PETSC(VecDot(y.get(), image.get(), &right));
  return std::abs(left - right) <= symmetric_within * size;
}

/// Orthonormal combinations of some vectors; those that depend on others (of balls in a row) are left out.
std::vector<Vector> orthonormal(std::vector<Vector> vectors) {
  constexpr double dependent = 1e-10;
  std::vector<Vector> basis;
  for (Vector& x : vectors) {
    const double before = norm_of(x.get());
    for (int pass = 0; pass < 2; ++pass)
      for (const Vector& e : basis) {
        PetscScalar along = 0;
        EIGENGRAIN_PETSC(VecDot(x.get(), e.get(), &along));
        EIGENGRAIN_PETSC(VecAXPY(x.get(), -along, e.get()));
      }
    const double norm = norm_of(x.get());
    if (!(norm > dependent * before)) continue;
    EIGENGRAIN_PETSC(VecScale(x.get(), 1 / norm));
    basis.push_back(std::move(x));
  }
  return basis;
}

void set_near_null_space(Mat matrix, std::vector<Vector> motions) {
  const std::vector<Vector> basis = orthonormal(std::move(motions));
  std::vector<Vec> handles;
  for (const Vector& x : basis) handles.push_back(x.get());
  NullSpace space;
  EIGENGRAIN_PETSC(MatNullSpaceCreate(PETSC_COMM_SELF, PETSC_FALSE, static_cast<PetscInt>(handles.size()),
                                      handles.data(), space.put()));
  EIGENGRAIN_PETSC(MatSetNearNullSpace(matrix, space.get()));
}

}  // namespace

std::vector<LinearMethod> methods_for(const LinearTraits& traits) {
  using enum LinearMethod;
  const LinearMethod factor = traits.symmetric ? cholmod : mumps;
  std::vector<LinearMethod> methods;
  const auto add = [&](std::initializer_list<LinearMethod> more) {
    for (const LinearMethod method : more)
      if (std::find(methods.begin(), methods.end(), method) == methods.end()) methods.push_back(method);
  };
  const bool factored = traits.size <= most_factored;
  if (factored && (traits.contrast >= high_contrast || traits.size <= small)) add({factor});
  if (traits.size >= least_for_multigrid) add({gamg});
  if (traits.symmetric)
    add({icc_cg});
  else
    add({ilu_bicgstab, ilu_gmres});
  if (factored) add({factor, mumps});
  add({gamg, hypre, traits.symmetric ? jacobi_cg : jacobi_gmres});
  return methods;
}

/// One method, made when it is first asked.
class LinearSolver::Engine {
 public:
  Engine(LinearMethod method, Mat matrix, const Options& options, std::string prefix)
      : method_(method), matrix_(matrix), options_(options), prefix_(std::move(prefix)) {}

  LinearMethod method() const { return method_; }
  void matrix_changed() { current_ = false; }
  int iterations() const { return iterations_; }
  /// With the matrix, in so many iterations.
  int products() const { return (method_ == LinearMethod::ilu_bicgstab ? 2 : 1) * iterations_; }

  /// Empty where x solves the system, else why not.
  std::string solve(Vec b, Vec x, double tolerance) {
    iterations_ = 0;
    std::string why;
    do {
      prepare();
      why = try_once(b, x, tolerance);
    } while (!why.empty() && is_incomplete(method_) && raise());
    return why;
  }

 private:
  /// A greater share of the diagonal for the incomplete factor; whether there was one.
  bool raise() {
    if (raised_ + 1 >= std::size(raises)) return false;
    ++raised_;
    current_ = false;
    return true;
  }

  void prepare() {
    if (current_) return;
    if (!solver_.get()) create();
    Mat operators = matrix_;
    Mat preconditions = matrix_;
    if (needs_scalars(method_)) {
      const bool fresh = scalars_.get() == nullptr;
      Mat scalars = scalars_.get();
      EIGENGRAIN_PETSC(
          MatConvert(matrix_, MATSEQAIJ, fresh ? MAT_INITIAL_MATRIX : MAT_REUSE_MATRIX, &scalars));
      if (fresh) scalars_ = Matrix(scalars);
      if (needs_symmetry(method_)) {
        EIGENGRAIN_PETSC(MatSetOption(scalars_.get(), MAT_SYMMETRIC, PETSC_TRUE));
        EIGENGRAIN_PETSC(MatSetOption(scalars_.get(), MAT_SPD, PETSC_TRUE));
      }
      if (fresh && method_ == LinearMethod::gamg && options_.rigid_motions)
        set_near_null_space(scalars_.get(), options_.rigid_motions());
      operators = preconditions = scalars_.get();
    } else if (raises[raised_] > 0) {
      EIGENGRAIN_PETSC(MatDuplicate(matrix_, MAT_COPY_VALUES, raised_matrix_.put()));
      Vector diagonal;
      EIGENGRAIN_PETSC(MatCreateVecs(matrix_, diagonal.put(), nullptr));
      EIGENGRAIN_PETSC(MatGetDiagonal(matrix_, diagonal.get()));
      EIGENGRAIN_PETSC(VecScale(diagonal.get(), raises[raised_]));
      EIGENGRAIN_PETSC(MatDiagonalSet(raised_matrix_.get(), diagonal.get(), ADD_VALUES));
      preconditions = raised_matrix_.get();
    }
    EIGENGRAIN_PETSC(KSPSetOperators(solver_.get(), operators, preconditions));
    current_ = true;
  }

  void create() {
    EIGENGRAIN_PETSC(KSPCreate(PETSC_COMM_SELF, solver_.put()));
    KSP solver = solver_.get();
    if (!prefix_.empty()) EIGENGRAIN_PETSC(KSPSetOptionsPrefix(solver, prefix_.c_str()));
    PC preconditioner = nullptr;
    EIGENGRAIN_PETSC(KSPGetPC(solver, &preconditioner));
    const auto iterate_by = [&](KSPType type) {
      EIGENGRAIN_PETSC(KSPSetType(solver, type));
      if (std::string_view(type) == KSPGMRES || std::string_view(type) == KSPFGMRES)
        EIGENGRAIN_PETSC(KSPGMRESSetRestart(solver, 60));
      if (std::string_view(type) != KSPCG) EIGENGRAIN_PETSC(KSPSetPCSide(solver, PC_RIGHT));
      EIGENGRAIN_PETSC(KSPSetNormType(solver, KSP_NORM_UNPRECONDITIONED));
    };
    switch (method_) {
      case LinearMethod::icc_cg:  // of a symmetric matrix, ILU(0) is ICC(0)
      case LinearMethod::ilu_bicgstab:
      case LinearMethod::ilu_gmres:
        iterate_by(method_ == LinearMethod::icc_cg      ? KSPCG
                   : method_ == LinearMethod::ilu_gmres ? KSPGMRES
                                                        : KSPBCGS);
        EIGENGRAIN_PETSC(PCSetType(preconditioner, PCILU));
        break;
      case LinearMethod::jacobi_cg:
      case LinearMethod::jacobi_gmres:
        iterate_by(method_ == LinearMethod::jacobi_cg ? KSPCG : KSPGMRES);
        EIGENGRAIN_PETSC(PCSetType(preconditioner, PCPBJACOBI));
        break;
      case LinearMethod::gamg:
        iterate_by(KSPFGMRES);
        EIGENGRAIN_PETSC(PCSetType(preconditioner, PCGAMG));
        EIGENGRAIN_PETSC(PCGAMGSetNSmooths(preconditioner, 0));
        break;
      case LinearMethod::hypre:
        iterate_by(KSPFGMRES);
        EIGENGRAIN_PETSC(PCSetType(preconditioner, PCHYPRE));
        EIGENGRAIN_PETSC(PCHYPRESetType(preconditioner, "boomeramg"));
        break;
      case LinearMethod::cholmod:
        iterate_by(KSPGMRES);
        EIGENGRAIN_PETSC(PCSetType(preconditioner, PCCHOLESKY));
        EIGENGRAIN_PETSC(PCFactorSetMatSolverType(preconditioner, MATSOLVERCHOLMOD));
        break;
      case LinearMethod::mumps:
        iterate_by(KSPGMRES);
        EIGENGRAIN_PETSC(PCSetType(preconditioner, PCLU));
        EIGENGRAIN_PETSC(PCFactorSetMatSolverType(preconditioner, MATSOLVERMUMPS));
        break;
    }
    if (options_.interrupted)
      EIGENGRAIN_PETSC(KSPMonitorSet(solver, stop_if_interrupted, const_cast<Options*>(&options_), nullptr));
    if (!prefix_.empty()) EIGENGRAIN_PETSC(KSPSetFromOptions(solver));
  }

  static PetscErrorCode stop_if_interrupted(KSP /*solver*/, PetscInt, PetscReal, void* context) {
    return static_cast<const Options*>(context)->interrupted() ? PETSC_ERR_USER : 0;
  }

  std::string try_once(Vec b, Vec x, double tolerance) {
    EIGENGRAIN_PETSC(KSPSetTolerances(solver_.get(), tolerance, 0, PETSC_DEFAULT, most_iterations(method_)));
    EIGENGRAIN_PETSC(VecZeroEntries(x));
    EIGENGRAIN_PETSC(KSPSolve(solver_.get(), b, x));
    PetscInt iterations = 0;
    KSPConvergedReason reason = KSP_CONVERGED_ITERATING;
    EIGENGRAIN_PETSC(KSPGetIterationNumber(solver_.get(), &iterations));
    EIGENGRAIN_PETSC(KSPGetConvergedReason(solver_.get(), &reason));
    iterations_ += static_cast<int>(iterations);
    const Vector residual = like(b);
    EIGENGRAIN_PETSC(MatMult(matrix_, x, residual.get()));
    EIGENGRAIN_PETSC(VecAYPX(residual.get(), -1, b));
    const double left = norm_of(residual.get()) / norm_of(b);
    if (left <= (reason > 0 ? drift : 1) * tolerance) return {};
    return fmt::format("{} after {} iterations, residual {:.1e}", KSPConvergedReasons[reason], iterations,
                       left);
  }

  LinearMethod method_;
  Mat matrix_;
  const Options& options_;
  std::string prefix_;
  KrylovSolver solver_;
  Matrix scalars_;        ///< the same numbers in compressed rows
  Matrix raised_matrix_;  ///< with a greater diagonal, for the incomplete factor
  std::size_t raised_ = 0;
  bool current_ = false;
  int iterations_ = 0;
};

LinearSolver::LinearSolver(Mat matrix, Options options) : matrix_(matrix), options_(std::move(options)) {}
LinearSolver::~LinearSolver() = default;

LinearTraits LinearSolver::traits() const {
  PetscInt size = 0;
  EIGENGRAIN_PETSC(MatGetSize(matrix_, &size, nullptr));
  return {.size = size, .symmetric = symmetric_, .contrast = options_.contrast};
}

void LinearSolver::matrix_changed() {
  const bool symmetric = is_symmetric(matrix_);
  if (engines_.empty() || symmetric != symmetric_) {
    symmetric_ = symmetric;
    engines_.clear();
    first_ = 0;
    for (const LinearMethod method : options_.methods.empty() ? methods_for(traits()) : options_.methods)
      engines_.push_back(std::make_unique<Engine>(method, matrix_, options_,
                                                  engines_.empty() ? options_.prefix : std::string()));
  }
  for (const std::unique_ptr<Engine>& engine : engines_) engine->matrix_changed();
}

LinearOutcome LinearSolver::solve(Vec b, Vec x, double tolerance) {
  LinearOutcome outcome;
  if (engines_.empty()) matrix_changed();
  if (norm_of(b) == 0) {
    EIGENGRAIN_PETSC(VecZeroEntries(x));
    outcome.solved = true;
    outcome.method = engines_[first_]->method();
    return outcome;
  }
  for (std::size_t k = 0; k < engines_.size(); ++k) {
    const std::size_t which = (first_ + k) % engines_.size();
    Engine& engine = *engines_[which];
    std::string why;
    try {
      why = engine.solve(b, x, tolerance);
    } catch (const SolverError& error) {  // of a library that gave up, or found no memory
      if (options_.interrupted && options_.interrupted()) throw;
      why = error.what();
    }
    outcome.iterations += engine.iterations();
    outcome.products += engine.products();
    if (why.empty()) {
      first_ = which;
      outcome.solved = true;
      outcome.method = engine.method();
      return outcome;
    }
    outcome.failures.push_back(fmt::format("{}: {}", name_of(engine.method()), why));
  }
  EIGENGRAIN_PETSC(VecZeroEntries(x));
  return outcome;
}

}  // namespace eigengrain::relaxation
