#pragma once

#include "eigengrain/assembly/forces.hpp"
#include "eigengrain/contact/orientation.hpp"

#include "support/scenes.hpp"

#include <limits>
#include <numbers>
#include <random>

/// Scenes with bonds for tests, and derivatives of what bonded models do.
namespace eigengrain::test {

/// A parallel bond by the stiffness of a disk of radius 1: k_n = k̄_n A, k_s = k̄_s A.
struct Cemented {
  double kn = 1;
  double ks = 0.6;
  double tension = std::numeric_limits<double>::infinity();  ///< Pa
  double shear = std::numeric_limits<double>::infinity();    ///< Pa
  double radius = 1;                                         ///< λ
  bool incremental = false;
  double gap = 1e-9;

  model::BondRule rule() const {
    return {.kind = "parallel",
            .parameters = {radius, kn / std::numbers::pi, ks / std::numbers::pi, tension, shear,
                           incremental ? 1.0 : 0.0},
            .gap = gap};
  }
};

inline assembly::Displacement no_displacement(const assembly::Model& model) {
  const auto bodies = static_cast<std::size_t>(model.bodies.size());
  return {std::vector<Vec3>(bodies, Vec3::Zero()), std::vector<Vec3>(bodies, Vec3::Zero())};
}

/// A displacement of one number: column 6 i + k is u_k of body i, 6 i + 3 + k its θ_k.
inline assembly::Displacement one_number(const assembly::Model& model, int column, double value) {
  assembly::Displacement d = no_displacement(model);
  (column % 6 < 3 ? d.translation : d.rotation)[static_cast<std::size_t>(column / 6)][column % 3] = value;
  return d;
}

/// Forces and moments of all bodies [6 bodies] after a displacement.
inline Eigen::VectorXd force_vector(const assembly::Model& model,
                                    const assembly::Displacement& displacement) {
  const assembly::BodyForces f = assembly::contact_forces(model, displacement);
  Eigen::VectorXd v(6 * model.bodies.size());
  for (std::size_t i = 0; i < f.force.size(); ++i) {
    v.segment<3>(static_cast<Eigen::Index>(6 * i)) = f.force[i];
    v.segment<3>(static_cast<Eigen::Index>(6 * i + 3)) = f.moment[i];
  }
  return v;
}

/// -∂(forces, moments)/∂(u, θ) of all bodies by central differences.
inline Eigen::MatrixXd numerical_tangent(const assembly::Model& model, double h = 1e-6) {
  const int size = 6 * model.bodies.size();
  Eigen::MatrixXd k(size, size);
  for (int column = 0; column < size; ++column)
    k.col(column) = -(force_vector(model, one_number(model, column, h)) -
                      force_vector(model, one_number(model, column, -h))) /
                    (2 * h);
  return k;
}

/// A sink of tangents that adds to one dense matrix on (u, θ) of all bodies.
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

/// Moves and turns bodies where they stand, without a step.
inline void deform(assembly::Model& model, std::mt19937_64& random, double shift, double turn) {
  for (std::size_t i = 0; i < model.bodies.position.size(); ++i) {
    model.bodies.position[i] += shift * random_vector(random);
    model.bodies.orientation[i] = contact::turned(model.bodies.orientation[i], turn * random_vector(random));
  }
}

}  // namespace eigengrain::test
