// The consistent tangent is the derivative of the contact forces, all of it: slip, the turning of the contact
// frame and the moving contact point, at overlaps where they are not small.
#include "support/scenes.hpp"
#include "support/tangents.hpp"

#include <gtest/gtest.h>

#include <random>

namespace eigengrain::test {
namespace {

using assembly::Displacement;
using assembly::Model;
using assembly::Trial;

/// Moves the bodies by small random steps and commits each, so that contacts carry shear and some slip.
void shake(Model& model, std::mt19937_64& random, double size) {
  for (int step = 0; step < 3; ++step) {
    Displacement d = no_displacement(model);
    for (Vec3& u : d.translation) u = size * random_vector(random);
    for (Vec3& theta : d.rotation) theta = size * random_vector(random);
    for (std::size_t i = 0; i < d.translation.size(); ++i) model.bodies.position[i] += d.translation[i];
    assembly::BodyForces sum;
    assembly::ContactForceSum(model, true)
        .advance(model, Trial{model.bodies.position, d.translation, d.rotation, 1.0}, sum);
  }
}

void expect_exact(Model& model) {
  const Displacement d = no_displacement(model);
  DenseTangent tangent(model);
  assembly::assemble_tangent(model, Trial{model.bodies.position, d.translation, d.rotation, 1.0}, tangent);
  const Eigen::MatrixXd expected = numerical_tangent(model);
  // Forces of order one over 2e-6: 1e-9 of rounding, h² of curvature; a term left out would be of order U =
  // 1e-2.
  EXPECT_LT((tangent.k - expected).cwiseAbs().maxCoeff(), 2e-8);
}

TEST(ConsistentTangent, IsTheDerivativeOfTheForcesWhileContactsStick) {
  std::mt19937_64 random(1);
  for (int scene = 0; scene < 20; ++scene) {
    // With tension nothing slips or opens, and the spring carries what it is given.
    SceneBuilder builder = random_cluster(random, 6, {.kn = 1, .ks = 0.6, .tension = true});
    builder.plane({0, 0, -3}, {0.2, 0.1, 1});
    Model model = builder.build();
    shake(model, random, 1e-3);
    expect_exact(model);
  }
}

// Levers that do not meet at one point: the moving of each is a term of its own.
TEST(ConsistentTangent, IsTheDerivativeOfTheForcesWithLeversToTheSurface) {
  std::mt19937_64 random(3);
  for (int scene = 0; scene < 10; ++scene) {
    SceneBuilder builder = random_cluster(random, 6, {.kn = 1, .ks = 0.6, .tension = true});
    builder.plane({0, 0, -3}, {0.2, 0.1, 1});
    builder.scene().full_levers = true;
    Model model = builder.build();
    shake(model, random, 1e-3);
    expect_exact(model);
  }
}

TEST(ConsistentTangent, IsTheDerivativeOfTheForcesWhereContactsSlip) {
  std::mt19937_64 random(2);
  int slipping = 0;
  for (int scene = 0; scene < 40; ++scene) {
    const Vec3 n = random_vector(random).normalized();
    SceneBuilder builder({.kn = 1, .ks = 0.6, .tension = false});
    builder.ball(Vec3::Zero()).ball(1.95 * n).plane(-0.96 * n, n);
    Model model = builder.build();
    shake(model, random, 2e-2);
    DenseTangent tangent(model);
    const Displacement d = no_displacement(model);
    assembly::assemble_tangent(model, Trial{model.bodies.position, d.translation, d.rotation, 1.0}, tangent);
    if ((tangent.k - tangent.k.transpose()).cwiseAbs().maxCoeff() > 0.05) ++slipping;
    // On the cone exactly, a small step sticks in one direction and slips in the other; move off it.
    Displacement nudge = no_displacement(model);
    for (Vec3& u : nudge.translation) u = 5e-3 * random_vector(random);
    for (std::size_t i = 0; i < nudge.translation.size(); ++i)
      model.bodies.position[i] += nudge.translation[i];
    DenseTangent moved(model);
    const Trial trial{model.bodies.position, nudge.translation, nudge.rotation, 1.0};
    assembly::assemble_tangent(model, trial, moved);
    // Away from the committed state it is exact up to the increment over the radius.
    constexpr double h = 1e-6;
    for (int column = 0; column < moved.k.cols(); ++column) {
      const auto forces = [&](double step) {
        Displacement at = nudge;
        (column % 6 < 3 ? at.translation : at.rotation)[static_cast<std::size_t>(column / 6)][column % 3] +=
            step;
        std::vector<Vec3> position = model.bodies.position;
        for (std::size_t i = 0; i < position.size(); ++i)
          position[i] += at.translation[i] - nudge.translation[i];
        assembly::BodyForces sum;
        assembly::ContactForceSum(model, true)
            .evaluate(model, Trial{position, at.translation, at.rotation, 1.0}, sum);
        Eigen::VectorXd v(moved.k.rows());
        for (std::size_t i = 0; i < sum.force.size(); ++i) {
          v.segment<3>(static_cast<Eigen::Index>(6 * i)) = sum.force[i];
          v.segment<3>(static_cast<Eigen::Index>(6 * i + 3)) = sum.moment[i];
        }
        return v;
      };
      const Eigen::VectorXd expected = -(forces(h) - forces(-h)) / (2 * h);
      EXPECT_LT((moved.k.col(column) - expected).cwiseAbs().maxCoeff(), 0.03) << "scene " << scene;
    }
  }
  EXPECT_GT(slipping, 5);
}

}  // namespace
}  // namespace eigengrain::test
