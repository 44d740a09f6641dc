#include "support/tangents.hpp"

namespace eigengrain::test {

Eigen::VectorXd force_vector(const assembly::Model& model, const assembly::Displacement& displacement) {
  const assembly::BodyForces f = assembly::contact_forces(model, displacement);
  Eigen::VectorXd v(6 * model.bodies.size());
  for (std::size_t i = 0; i < f.force.size(); ++i) {
    v.segment<3>(static_cast<Eigen::Index>(6 * i)) = f.force[i];
    v.segment<3>(static_cast<Eigen::Index>(6 * i + 3)) = f.moment[i];
  }
  return v;
}

Eigen::MatrixXd numerical_tangent(const assembly::Model& model, const assembly::Displacement& at, double h) {
  const int size = 6 * model.bodies.size();
  Eigen::MatrixXd k(size, size);
  for (int column = 0; column < size; ++column)
    k.col(column) = -(force_vector(model, with_number(at, column, h)) -
                      force_vector(model, with_number(at, column, -h))) /
                    (2 * h);
  return k;
}

Eigen::MatrixXd numerical_tangent(const assembly::Model& model) {
  return numerical_tangent(model, no_displacement(model), 1e-6);
}

}  // namespace eigengrain::test
