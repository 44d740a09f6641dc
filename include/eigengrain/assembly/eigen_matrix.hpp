#pragma once

#include "eigengrain/assembly/unknowns.hpp"
#include "eigengrain/contact/element.hpp"

#include <Eigen/SparseCore>

#include <span>

namespace eigengrain::assembly {

/// K as an Eigen sparse matrix [unknowns.size() × unknowns.size()], both triangles; masked rows and columns
/// are empty. For small systems and tests: it goes through a list of triplets.
Eigen::SparseMatrix<double> stiffness_matrix(const Unknowns& unknowns,
                                             std::span<const contact::ContactElement> elements);

/// The symmetric matrix M^-½ K M^-½ on the free components only [free × free], dense; its eigenvalues are the
/// squared angular frequencies. Memory 8 free² bytes.
Eigen::MatrixXd dense_scaled_stiffness(const model::Bodies& bodies, const Unknowns& unknowns,
                                       std::span<const contact::ContactElement> elements);

}  // namespace eigengrain::assembly
