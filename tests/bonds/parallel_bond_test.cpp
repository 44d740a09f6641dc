// The parallel bond in total form: a gradient, blind to rigid motion, with the stiffness of eq. 1.34.
#include "eigengrain/assembly/bonds.hpp"
#include "eigengrain/assembly/tangent.hpp"

#include "support/bonds.hpp"

#include <gtest/gtest.h>

#include <random>

namespace eigengrain::test {
namespace {

using assembly::Model;

/// A bonded cluster of five balls of unequal size.
Model cluster(std::mt19937_64& random, const Cemented& cement) {
  return random_cluster(random, 5, {}).without_law().bonded(cement.rule()).build();
}

Eigen::MatrixXd tangent_of(const Model& model) {
  const assembly::Displacement d = no_displacement(model);
  DenseTangent sink(model);
  assembly::assemble_tangent(
      model, {model.bodies.position, d.translation, d.rotation, 1.0, model.bodies.orientation}, sink);
  return sink.k;
}

TEST(ParallelBond, IsForceFreeWhereItIsMade) {
  std::mt19937_64 random(1);
  const Model model = cluster(random, {});
  EXPECT_GE(assembly::count_bonds(model), 4);
  EXPECT_LT(force_vector(model, no_displacement(model)).cwiseAbs().maxCoeff(), 1e-15);
  EXPECT_LT(assembly::elastic_energy(model), 1e-30);
}

TEST(ParallelBond, MakesNoForceInARigidMotionOfAnySize) {
  std::mt19937_64 random(2);
  for (int scene = 0; scene < 50; ++scene) {
    Model model = cluster(random, {});
    const Mat3 q = random_rotation(random);
    const Vec3 shift = random_vector(random);
    for (Vec3& x : model.bodies.position) x = q * x + shift;
    for (Quat& orientation : model.bodies.orientation) orientation = Quat(q) * orientation;
    // Positions of order ten, rounded: ulps of 2e-15.
    EXPECT_LT(force_vector(model, no_displacement(model)).cwiseAbs().maxCoeff(), 1e-13);
  }
}

TEST(ParallelBond, TurnsItsForceWithTheFrame) {
  std::mt19937_64 random(3);
  Model model = cluster(random, {});
  deform(model, random, 0.1, 0.2);
  const Eigen::VectorXd before = force_vector(model, no_displacement(model));
  ASSERT_GT(before.cwiseAbs().maxCoeff(), 0.05);
  const Mat3 q = random_rotation(random);
  for (Vec3& x : model.bodies.position) x = q * x;
  for (Quat& orientation : model.bodies.orientation) orientation = Quat(q) * orientation;
  const Eigen::VectorXd after = force_vector(model, no_displacement(model));
  for (Eigen::Index k = 0; k < before.size(); k += 3)
    EXPECT_LT((after.segment<3>(k) - q * before.segment<3>(k)).norm(), 1e-14);
}

TEST(ParallelBond, KeepsMomentum) {
  std::mt19937_64 random(4);
  Model model = cluster(random, {});
  deform(model, random, 0.1, 0.2);
  const assembly::BodyForces f = assembly::contact_forces(model);
  Vec3 force = Vec3::Zero();
  Vec3 moment = Vec3::Zero();
  for (std::size_t i = 0; i < f.force.size(); ++i) {
    force += f.force[i];
    moment += f.moment[i] + model.bodies.position[i].cross(f.force[i]);
  }
  EXPECT_LT(force.norm(), 1e-15);
  EXPECT_LT(moment.norm(), 1e-14);
}

TEST(ParallelBond, ForceIsTheGradientOfItsEnergyAtLargeDeformation) {
  std::mt19937_64 random(5);
  for (const Cemented& cement : {Cemented{}, Cemented{.kn = 1, .ks = 0}, Cemented{.kn = 0.3, .ks = 1}}) {
    Model model = cluster(random, cement);
    deform(model, random, 0.2, 0.3);
    const Eigen::VectorXd force = force_vector(model, no_displacement(model));
    ASSERT_GT(force.cwiseAbs().maxCoeff(), 0.05);
    for (int column = 0; column < force.size(); ++column) {
      constexpr double h = 1e-4;
      const double plus = assembly::elastic_energy(model, one_number(model, column, h));
      const double minus = assembly::elastic_energy(model, one_number(model, column, -h));
      // h² of the third derivative, of order one; rounding makes 1e-12.
      EXPECT_NEAR(-(plus - minus) / (2 * h), force[column], 2e-8);
    }
  }
}

TEST(ParallelBond, TangentIsTheDerivativeOfTheForceAtLargeDeformation) {
  std::mt19937_64 random(6);
  for (int scene = 0; scene < 10; ++scene) {
    Model model = cluster(random, {.kn = 1, .ks = scene % 3 == 0 ? 0.0 : 0.6, .radius = 0.8});
    deform(model, random, 0.2, 0.3);
    // Forces of order one over 2e-6 make 1e-9 of rounding; h² is nothing.
    EXPECT_LT((tangent_of(model) - numerical_tangent(model)).cwiseAbs().maxCoeff(), 1e-8);
  }
}

TEST(ParallelBond, TangentIsSymmetricOnlyInTranslationsWhereItCarriesLoad) {
  // Rotation vectors do not commute, so moments about fixed axes have no symmetric derivative under load;
  // that of the positions is the Hessian.
  std::mt19937_64 random(7);
  Model model = cluster(random, {});
  EXPECT_LT((tangent_of(model) - tangent_of(model).transpose()).cwiseAbs().maxCoeff(), 1e-14);
  deform(model, random, 0.2, 0.3);
  const Eigen::MatrixXd k = tangent_of(model);
  for (int i = 0; i < k.rows(); i += 6)
    for (int j = 0; j < k.cols(); j += 6)
      EXPECT_LT((k.block<3, 3>(i, j) - k.block<3, 3>(j, i).transpose()).cwiseAbs().maxCoeff(), 1e-14);
  EXPECT_GT((k - k.transpose()).cwiseAbs().maxCoeff(), 1e-3);
}

TEST(ParallelBond, UnloadedItsTangentIsTheStiffnessOfTheElement) {
  std::mt19937_64 random(8);
  const Model model = cluster(random, {.radius = 0.7});
  DenseTangent sum(model);
  for (const contact::ContactElement& element : assembly::contact_elements(model))
    sum.add(element.a, element.b, contact::stiffness_matrix(element));
  EXPECT_LT((tangent_of(model) - sum.k).cwiseAbs().maxCoeff(), 1e-14);
}

TEST(ParallelBond, StiffnessIsThatOfPfc3d) {
  // Eq. 1.34 with R = λ min(R_a, R_b) = 0.5 · 2: A = π, I = π/4, J = π/2.
  SceneBuilder builder;
  builder.ball({0, 0, 0}, 2).ball({5, 0, 0}, 3).without_law();
  const Model model =
      builder.bonded({.kind = "parallel", .parameters = {0.5, 8, 4, 1e300, 1e300, 0}, .gap = 0}).build();
  const auto elements = assembly::contact_elements(model);
  ASSERT_EQ(elements.size(), 1U);
  const contact::ContactStiffness& k = elements[0].stiffness;
  EXPECT_DOUBLE_EQ(k.normal, 8 * std::numbers::pi);
  EXPECT_DOUBLE_EQ(k.shear, 4 * std::numbers::pi);
  EXPECT_DOUBLE_EQ(k.twist, 2 * std::numbers::pi);
  EXPECT_DOUBLE_EQ(k.bending, 2 * std::numbers::pi);
}

TEST(ParallelBond, AddsToTheLawOfItsPair) {
  SceneBuilder builder(Springs{.kn = 2, .tension = false});
  builder.ball({0, 0, 0}).ball({1.9, 0, 0});
  Model alone = builder.build();
  Model both = builder.bonded(Cemented{.kn = 3}.rule()).build();
  EXPECT_EQ(both.contacts.groups.size(), 2U);
  for (Model* model : {&alone, &both}) model->bodies.position[1].x() -= 0.01;
  // The bond is made where the balls are, 0.1 of overlap and all.
  EXPECT_NEAR(assembly::contact_forces(alone).force[1].x(), 2 * 0.11, 1e-14);
  EXPECT_NEAR(assembly::contact_forces(both).force[1].x(), 2 * 0.11 + 3 * 0.01, 1e-14);
}

TEST(ParallelBond, HoldsThroughPeriodicImages) {
  // One ball and its own image: the bond knows no rigid motion of the cell, only rotations of the ball.
  SceneBuilder builder;
  builder.ball({1, 1, 1}).without_law().periodic({2, 9, 9}, {true, false, false}).bonded(Cemented{}.rule());
  const Model model = builder.build();
  ASSERT_EQ(assembly::count_bonds(model), 1);
  EXPECT_LT((tangent_of(model) - numerical_tangent(model)).cwiseAbs().maxCoeff(), 1e-8);
  EXPECT_GT(tangent_of(model).cwiseAbs().maxCoeff(), 0.1);
}

}  // namespace
}  // namespace eigengrain::test
