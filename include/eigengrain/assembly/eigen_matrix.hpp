#pragma once

#include "eigengrain/assembly/linear_system.hpp"

#include <Eigen/SparseCore>

namespace eigengrain::assembly {

/// K as an Eigen sparse matrix [unknowns.size() × unknowns.size()], both triangles; masked rows and columns
/// are empty. For small systems and tests: it goes through a list of triplets.
Eigen::SparseMatrix<double> stiffness_matrix(const LinearSystem& system);

/// The symmetric matrix M^-½ K M^-½ on the free components only [free × free], dense; its eigenvalues are the
/// squared angular frequencies. Memory 8 free² bytes.
Eigen::MatrixXd dense_scaled_stiffness(const LinearSystem& system);

}  // namespace eigengrain::assembly
