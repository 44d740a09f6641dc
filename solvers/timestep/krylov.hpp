#pragma once

#include "eigengrain/assembly/product.hpp"
#include "eigengrain/timestep/truth.hpp"

#include "petsc/handles.hpp"

#include <span>
#include <vector>

/// The eigensolvers of SLEPc on matrix-free products. All vectors are [unknowns.size()] with zeros at masked
/// components.
namespace eigengrain::timestep {

/// What SLEPc sees of a product: y = factor · S K S x. Refers to the product; the same place for life, as
/// PETSc keeps a pointer to it.
class ProductShell {
 public:
  explicit ProductShell(assembly::StiffnessProduct& product, double factor = 1);
  ProductShell(const ProductShell&) = delete;
  ProductShell& operator=(const ProductShell&) = delete;

  Mat mat() const { return matrix_.get(); }
  void multiply(Vec x, Vec y);

 private:
  assembly::StiffnessProduct& product_;
  double factor_;
  petsc::Matrix matrix_;
};

/// Gaussian numbers at free components, zeros at masked ones (where scale is zero).
petsc::Vector start_vector(Mat matrix, std::span<const double> scale, std::uint64_t seed);

double dot(Vec x, Vec y);

struct Eigenpair {
  double value = 0;
  petsc::Vector vector;
  double residual = 0;  ///< |A x - λ x| / |λ x|, computed afresh, not the solver's own estimate
};

/// The largest eigenvalue of a symmetric positive semidefinite product, by Krylov-Schur iteration from a
/// random start, or as a dense matrix (LAPACK) where it is small. Throws SolverError where it does not come
/// out well.
Eigenpair largest_eigenpair(assembly::StiffnessProduct& product, std::span<const double> scale,
                            const TruthOptions& options);

/// The `count` largest ones, in decreasing order; fewer where the free components are fewer. The iteration
/// takes them from one Krylov space.
std::vector<Eigenpair> largest_eigenpairs(assembly::StiffnessProduct& product, std::span<const double> scale,
                                          int count, const TruthOptions& options);

/// S y / |y|: the mode that belongs to a vector of the scaled problem.
std::vector<double> mode_of(Vec y, std::span<const double> scale);

/// The largest μ with (μ² - μ C - K) x = 0, C and K symmetric positive semidefinite, by the two-level Arnoldi
/// method for polynomial eigenproblems (TOAR; Lu, Su and Bai, SIAM J. Matrix Anal. Appl. 37:195, 2016), or
/// with dense matrices where it is small. The residual is |(μ² - μ C - K) x| / |μ² x|.
///
/// unit  a bound of μ: the problem is solved for μ/unit, so that all coefficients are of order one
Eigenpair largest_quadratic_eigenpair(assembly::StiffnessProduct& stiffness,
                                      assembly::StiffnessProduct& viscosity, std::span<const double> scale,
                                      double unit, const TruthOptions& options);

/// Whether a system of so many unknowns is solved as a dense matrix.
bool is_dense(std::int64_t unknowns);

}  // namespace eigengrain::timestep
