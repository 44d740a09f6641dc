#include "support/dense.hpp"

#include <Eigen/Eigenvalues>

namespace eigengrain::test {

double dense_truth(const assembly::LinearSystem& system) {
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> solver(assembly::dense_scaled_stiffness(system),
                                                              Eigen::EigenvaluesOnly);
  return 2 / std::sqrt(solver.eigenvalues().tail<1>()[0]);
}

double dense_limit(const assembly::LinearSystem& system, std::span<const double> local_damping) {
  Eigen::MatrixXd k = assembly::dense_scaled_stiffness(system);
  Eigen::MatrixXd c = assembly::dense_scaled_stiffness(assembly::with_viscosity(system, 1.0)) - k;
  const Eigen::Index n = k.rows();
  Eigen::VectorXd scale = Eigen::VectorXd::Ones(n);
  const std::vector<std::int32_t> free = system.unknowns.free_components();
  for (std::size_t i = 0; i < free.size() && !local_damping.empty(); ++i)
    scale[static_cast<Eigen::Index>(i)] =
        std::sqrt(1 + local_damping[static_cast<std::size_t>(system.unknowns.body(free[i] / 3))]);
  Eigen::MatrixXd companion = Eigen::MatrixXd::Zero(2 * n, 2 * n);  // of (x, μx)
  companion.topRightCorner(n, n).setIdentity();
  companion.bottomLeftCorner(n, n) = scale.asDiagonal() * k * scale.asDiagonal();
  companion.bottomRightCorner(n, n) = scale.asDiagonal() * c * scale.asDiagonal();
  return 2 / Eigen::EigenSolver<Eigen::MatrixXd>(companion, false).eigenvalues().real().maxCoeff();
}

}  // namespace eigengrain::test
