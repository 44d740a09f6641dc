#pragma once

#include "krylov.hpp"

namespace eigengrain::timestep {

/// The largest μ with (μ² - μ C - K) x = 0, C and K symmetric positive semidefinite, by the two-level Arnoldi
/// method for polynomial eigenproblems (TOAR; Lu, Su and Bai, SIAM J. Matrix Anal. Appl. 37:195, 2016), or
/// with dense matrices where it is small. The residual is |(μ² - μ C - K) x| / |μ² x|.
///
/// unit  a bound of μ: the problem is solved for μ/unit, so that all coefficients are of order one
Eigenpair largest_quadratic_eigenpair(assembly::StiffnessProduct& stiffness,
                                      assembly::StiffnessProduct& viscosity, std::span<const double> scale,
                                      double unit, const TruthOptions& options);

}  // namespace eigengrain::timestep
