#pragma once

#include "petsc/handles.hpp"

#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

namespace eigengrain::relaxation {

/// Ways to solve A x = b.
enum class LinearMethod : std::uint8_t {
  icc_cg,        ///< conjugate gradients with block ICC(0) on the 3×3 blocks; A symmetric
  ilu_bicgstab,  ///< BiCGStab with block ILU(0)
  ilu_gmres,     ///< GMRES(60) with block ILU(0)
  jacobi_cg,     ///< conjugate gradients with the inverses of the diagonal blocks; A symmetric
  jacobi_gmres,  ///< GMRES(60) with these
  gamg,          ///< algebraic multigrid of PETSc that knows the rigid motions
  hypre,         ///< BoomerAMG of hypre
  cholmod,       ///< sparse Cholesky of CHOLMOD; A symmetric
  mumps          ///< sparse LU of MUMPS
};
inline constexpr std::string_view name_of(LinearMethod method) {
  constexpr std::string_view names[] = {"icc-cg", "ilu-bicgstab", "ilu-gmres", "jacobi-cg", "jacobi-gmres",
                                        "gamg",   "hypre",        "cholmod",   "mumps"};
  return names[static_cast<std::size_t>(method)];
}

/// What a method is chosen by.
struct LinearTraits {
  std::int64_t size = 0;   ///< unknowns
  bool symmetric = false;  ///< A to rounding
  double contrast = 1;     ///< largest over smallest normal stiffness of the contacts
};

/// The methods for such a matrix, in the order in which they are tried. Block ILU(0) is hard to beat up to
/// millions of unknowns; where stiffnesses differ a thousandfold a factorisation is, as long as there is
/// memory for it.
std::vector<LinearMethod> methods_for(const LinearTraits& traits);

struct LinearOutcome {
  bool solved = false;
  LinearMethod method{};              ///< that found the solution
  int iterations = 0;                 ///< of all methods that were tried
  int products = 0;                   ///< with the matrix, of these
  std::vector<std::string> failures;  ///< of methods that broke down: "icc-cg: ..."
};

/// Solves A x = b for one matrix after another of the same pattern. A method that breaks down, or does not
/// converge, hands over to the next one, and the next matrix begins with the one that did it.
class LinearSolver {
 public:
  struct Options {
    double contrast = 1;  ///< of the stiffnesses
    /// Instead of methods_for; empty: those.
    std::vector<LinearMethod> methods{};
    /// The six rigid motions in the unknowns, for methods that ask; empty: none.
    std::function<std::vector<petsc::Vector>()> rigid_motions{};
    /// Asked at every iteration: whether to give up; may be empty.
    std::function<bool()> interrupted{};
    /// Of PETSc's options, which govern the method that comes first: "relax_" for -relax_ksp_type and others.
    std::string prefix{};
  };

  /// matrix  BAIJ with blocks of 3; it must live as long as this
  LinearSolver(Mat matrix, Options options);
  ~LinearSolver();
  LinearSolver(const LinearSolver&) = delete;
  LinearSolver& operator=(const LinearSolver&) = delete;

  /// After the numbers of the matrix have changed.
  void matrix_changed();
  /// To |b - A x| <= tolerance |b|, which is tested on x itself. x is zero where nothing solved the system.
  LinearOutcome solve(Vec b, Vec x, double tolerance);

 private:
  class Engine;
  LinearTraits traits() const;

  Mat matrix_;
  Options options_;
  std::vector<std::unique_ptr<Engine>> engines_;  ///< in the order in which they are tried
  std::size_t first_ = 0;                         ///< that solved the last system
  bool symmetric_ = false;
};

}  // namespace eigengrain::relaxation
