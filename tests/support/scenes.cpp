#include "support/scenes.hpp"

#include <Eigen/Eigenvalues>

#include <algorithm>

namespace eigengrain::test {

Eigen::VectorXd System::spectrum() const {
  const Eigen::MatrixXd a = assembly::dense_scaled_stiffness(*this);
  return Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd>(a, Eigen::EigenvaluesOnly).eigenvalues();
}

Mat3 random_rotation(std::mt19937_64& random) {
  std::normal_distribution<double> gaussian;
  Eigen::Quaterniond q(gaussian(random), gaussian(random), gaussian(random), gaussian(random));
  return q.normalized().toRotationMatrix();
}

SceneBuilder random_cluster(std::mt19937_64& random, int balls, const Springs& springs, double spread,
                            double fixed) {
  std::uniform_real_distribution<double> uniform(0, 1);
  SceneBuilder builder(springs);
  std::vector<Vec3> centres;
  std::vector<double> radii;
  for (int i = 0; i < balls; ++i) {
    const double radius = std::pow(spread, uniform(random));
    Vec3 centre = Vec3::Zero();
    if (i > 0) {
      const auto host = static_cast<std::size_t>(uniform(random) * i);
      const double gap = -0.05 * uniform(random) * std::min(radius, radii[host]);
      centre = centres[host] + (radii[host] + radius + gap) * random_vector(random).normalized();
    }
    model::FixedComponents bits;
    if (uniform(random) < fixed)
      bits =
          uniform(random) < 0.5 ? fix_all : model::FixedComponents(static_cast<std::uint8_t>(random() % 64));
    builder.ball(centre, radius, radius * radius * radius, bits);
    centres.push_back(centre);
    radii.push_back(radius);
  }
  return builder;
}

}  // namespace eigengrain::test
