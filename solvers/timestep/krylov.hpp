#pragma once

#include "eigengrain/assembly/product.hpp"
#include "eigengrain/timestep/truth.hpp"

#include "product_shell.hpp"

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

/// The `count` largest ones, in decreasing order; fewer where the free components are fewer. The iteration
/// takes them from one Krylov space.
std::vector<Eigenpair> largest_eigenpairs(assembly::StiffnessProduct& product, std::span<const double> scale,
                                          int count, const TruthOptions& options);

/// A loose or meaningless eigenpair must not pass for the truth: throws SolverError.
///
/// what    the eigenvalue, for the message
/// option  of SLEPc, with which to ask for more
void require_eigenpair(const Eigenpair& pair, const char* what, const char* option);

}  // namespace eigengrain::timestep
