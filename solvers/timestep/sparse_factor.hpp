#pragma once

#include "eigengrain/assembly/stiffness_parts.hpp"
#include "eigengrain/assembly/unknowns.hpp"

#include <Eigen/CholmodSupport>
#include <Eigen/SparseCore>

#include <span>

/// Sparse Cholesky factorisations of the scaled stiffness with a shift.
namespace eigengrain::timestep {

using SparseMatrix = Eigen::SparseMatrix<double, Eigen::ColMajor, SuiteSparse_long>;

/// The lower triangle of shift + factor · S K S.
///
/// scale  [unknowns.size()] the diagonal of S
SparseMatrix shifted_stiffness(const assembly::Unknowns& unknowns, const assembly::StiffnessParts& parts,
                               std::span<const double> scale, double shift, double factor);

/// A supernodal factor whose size is known before it is computed.
class SparseFactor : public Eigen::CholmodSupernodalLLT<SparseMatrix, Eigen::Lower> {
 public:
  SparseFactor();
  /// Numbers in the factor.
  double numbers() const;
  /// The most numbers in a row.
  double longest_row() const;
};

}  // namespace eigengrain::timestep
