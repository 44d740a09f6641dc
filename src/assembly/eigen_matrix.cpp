#include "eigengrain/assembly/eigen_matrix.hpp"

#include "eigengrain/assembly/scatter.hpp"

namespace eigengrain::assembly {

Eigen::SparseMatrix<double> stiffness_matrix(const LinearSystem& system) {
  const Unknowns& unknowns = system.unknowns;
  std::vector<Eigen::Triplet<double, std::int64_t>> triplets;
  triplets.reserve(system.elements.size() * 144);
  for (const contact::ContactElement& element : system.elements)
    scatter(element, unknowns, [&](std::int32_t row, std::int32_t column, const Mat3& block) {
      for (int i = 0; i < 3; ++i)
        for (int j = 0; j < 3; ++j)
          triplets.emplace_back(std::int64_t{3} * row + i, std::int64_t{3} * column + j, block(i, j));
    });
  for_each_block(system.nodal.k, [&](std::int32_t row, std::int32_t column, const Mat3& block) {
    for (int i = 0; i < 3; ++i)
      for (int j = 0; j < 3; ++j)
        triplets.emplace_back(std::int64_t{3} * row + i, std::int64_t{3} * column + j, block(i, j));
  });
  Eigen::SparseMatrix<double> matrix(unknowns.size(), unknowns.size());
  matrix.setFromTriplets(triplets.begin(), triplets.end());
  return matrix;
}

Eigen::MatrixXd dense_scaled_stiffness(const LinearSystem& system) {
  const Eigen::MatrixXd k = Eigen::MatrixXd(stiffness_matrix(system));
  const std::vector<double> scale = system.inverse_sqrt_mass();
  const std::vector<std::int32_t> free = system.unknowns.free_components();
  Eigen::MatrixXd result(free.size(), free.size());
  for (std::size_t i = 0; i < free.size(); ++i)
    for (std::size_t j = 0; j < free.size(); ++j)
      result(static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(j)) =
          scale[static_cast<std::size_t>(free[i])] * k(free[i], free[j]) *
          scale[static_cast<std::size_t>(free[j])];
  return result;
}

}  // namespace eigengrain::assembly
