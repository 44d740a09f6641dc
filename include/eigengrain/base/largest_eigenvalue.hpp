#pragma once

#include "eigengrain/base/vec.hpp"

namespace eigengrain {

/// Largest eigenvalue of a symmetric positive semidefinite 6×6 matrix (lower triangle read); 0 for a zero
/// diagonal, not a number for a matrix that is not finite. The relative error is a few ulps, on the safe
/// side: the result is checked to be an upper bound of the tridiagonal form by a Cholesky test, and raised
/// where it is not.
///
/// Householder tridiagonalisation (Eigen), then Laguerre's iteration on the characteristic polynomial from
/// the right of all roots, where it descends monotonically. Cheaper than all six eigenvalues, and the bounds
/// of the timestep need one for every body.
double largest_eigenvalue(const Mat6& matrix);

}  // namespace eigengrain
