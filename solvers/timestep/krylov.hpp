#pragma once

#include "eigengrain/assembly/product.hpp"
#include "eigengrain/timestep/truth.hpp"

#include "product_shell.hpp"

#include <functional>
#include <span>
#include <vector>

/// The largest eigenvalues of a symmetric product, by SLEPc.
namespace eigengrain::timestep {

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

/// The `count` largest ones, in decreasing order, each as often as it occurs; fewer where the free components
/// are fewer.
std::vector<Eigenpair> largest_eigenpairs(assembly::StiffnessProduct& product, std::span<const double> scale,
                                          int count, const TruthOptions& options);

/// Of equal eigenvalues a Krylov space has one vector, and rounding brings in the others late or never. Asks
/// beside the vectors that were found for one more, until it is none that was left out.
///
/// pairs    in decreasing order; stay as many
/// start    another vector for each number from 1 up, and another than that of the space
/// restarts at most, for each
void find_left_out(Mat matrix, std::vector<Eigenpair>& pairs,
                   const std::function<petsc::Vector(std::uint64_t)>& start, double tolerance,
                   PetscInt restarts);

/// A loose or meaningless eigenpair must not pass for the truth: throws SolverError.
///
/// what    the eigenvalue, for the message
/// option  of SLEPc, with which to ask for more
void require_eigenpair(const Eigenpair& pair, const char* what, const char* option);

}  // namespace eigengrain::timestep
