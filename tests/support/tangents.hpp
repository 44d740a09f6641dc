#pragma once

#include "eigengrain/assembly/forces.hpp"
#include "eigengrain/assembly/tangent.hpp"

#include "support/scenes.hpp"

#include <vector>

/// The consistent tangent of a model as a dense matrix, and by central differences of its forces.
namespace eigengrain::test {

inline assembly::Displacement no_displacement(const assembly::Model& model) {
  const auto bodies = static_cast<std::size_t>(model.bodies.size());
  return {std::vector<Vec3>(bodies, Vec3::Zero()), std::vector<Vec3>(bodies, Vec3::Zero())};
}

/// A displacement and one number more: column 6 i + k is u_k of body i, 6 i + 3 + k its θ_k.
inline assembly::Displacement with_number(assembly::Displacement d, int column, double value) {
  (column % 6 < 3 ? d.translation : d.rotation)[static_cast<std::size_t>(column / 6)][column % 3] += value;
  return d;
}

/// That number alone.
inline assembly::Displacement one_number(const assembly::Model& model, int column, double value) {
  return with_number(no_displacement(model), column, value);
}

/// Forces and moments of all bodies [6 bodies] after a displacement.
Eigen::VectorXd force_vector(const assembly::Model& model, const assembly::Displacement& displacement);

/// A sink that adds to one dense matrix on (u, θ) of all bodies.
struct DenseTangent {
  explicit DenseTangent(const assembly::Model& model)
      : k(Eigen::MatrixXd::Zero(6 * model.bodies.size(), 6 * model.bodies.size())) {}
  void add(std::int32_t a, std::int32_t b, const Mat12& block) {
    k.block<6, 6>(6 * a, 6 * a) += block.topLeftCorner<6, 6>();
    if (b == contact::no_body) return;
    k.block<6, 6>(6 * a, 6 * b) += block.topRightCorner<6, 6>();
    k.block<6, 6>(6 * b, 6 * a) += block.bottomLeftCorner<6, 6>();
    k.block<6, 6>(6 * b, 6 * b) += block.bottomRightCorner<6, 6>();
  }
  Eigen::MatrixXd k;
};

/// Minus the derivative of (force, moment) of all bodies after a displacement from where they stand, by
/// central differences of h.
Eigen::MatrixXd numerical_tangent(const assembly::Model& model, const assembly::Displacement& at, double h);
Eigen::MatrixXd numerical_tangent(const assembly::Model& model);

}  // namespace eigengrain::test
