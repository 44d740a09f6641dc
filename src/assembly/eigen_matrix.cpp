#include "eigengrain/assembly/eigen_matrix.hpp"

#include "eigengrain/assembly/mass.hpp"
#include "eigengrain/assembly/scatter.hpp"

namespace eigengrain::assembly {

Eigen::SparseMatrix<double> stiffness_matrix(const Unknowns& unknowns,
                                             std::span<const contact::ContactElement> elements) {
  std::vector<Eigen::Triplet<double, std::int64_t>> triplets;
  triplets.reserve(elements.size() * 144);
  for (const contact::ContactElement& element : elements)
    scatter(element, unknowns, [&](std::int32_t row, std::int32_t column, const Mat3& block) {
      for (int i = 0; i < 3; ++i)
        for (int j = 0; j < 3; ++j)
          triplets.emplace_back(std::int64_t{3} * row + i, std::int64_t{3} * column + j, block(i, j));
    });
  Eigen::SparseMatrix<double> matrix(unknowns.size(), unknowns.size());
  matrix.setFromTriplets(triplets.begin(), triplets.end());
  return matrix;
}

Eigen::MatrixXd dense_scaled_stiffness(const model::Bodies& bodies, const Unknowns& unknowns,
                                       std::span<const contact::ContactElement> elements) {
  const Eigen::MatrixXd k = Eigen::MatrixXd(stiffness_matrix(unknowns, elements));
  const std::vector<double> scale = inverse_sqrt_mass(bodies, unknowns);
  const std::vector<std::int32_t> free = unknowns.free_components();
  Eigen::MatrixXd result(free.size(), free.size());
  for (std::size_t i = 0; i < free.size(); ++i)
    for (std::size_t j = 0; j < free.size(); ++j)
      result(static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(j)) =
          scale[static_cast<std::size_t>(free[i])] * k(free[i], free[j]) *
          scale[static_cast<std::size_t>(free[j])];
  return result;
}

}  // namespace eigengrain::assembly
