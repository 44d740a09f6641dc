#include "eigengrain/contact/element.hpp"
#include "eigengrain/contact/geometry.hpp"
#include "eigengrain/contact/kinematics.hpp"
#include "eigengrain/contact/shear_transport.hpp"

#include "support/scenes.hpp"

#include <Eigen/Eigenvalues>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <fstream>
#include <numbers>
#include <random>

namespace eigengrain::contact {
namespace {

ContactElement random_element(std::mt19937_64& random) {
  std::uniform_real_distribution<double> stiffness(0.1, 10);
  return {.a = 0,
          .b = 1,
          .normal = test::random_vector(random).normalized(),
          .lever_a = test::random_vector(random),
          .lever_b = test::random_vector(random),
          .stiffness = {stiffness(random), stiffness(random), stiffness(random), stiffness(random)}};
}

TEST(BallBall, GeometryOfEquations1_5To1_8) {
  const ContactGeometry g = ball_ball({1, 0, 0}, 1.0, {1, 0, 2.7}, 2.0);
  EXPECT_EQ(g.normal, Vec3(0, 0, 1));
  EXPECT_NEAR(g.overlap, 0.3, 1e-15);
  EXPECT_TRUE(g.lever_a.isApprox(Vec3(0, 0, 0.85), 1e-15));
  EXPECT_TRUE(g.lever_b.isApprox(Vec3(0, 0, -1.85), 1e-15));
}

TEST(BallBall, LeversMayEndAtTheSurfaces) {
  const ContactGeometry g = ball_ball({1, 0, 0}, 1.0, {1, 0, 2.7}, 2.0, to_surface);
  EXPECT_EQ(g.lever_a, Vec3(0, 0, 1));
  EXPECT_EQ(g.lever_b, Vec3(0, 0, -2));
  EXPECT_LT((g.branch() - Vec3(0, 0, 2.7)).norm(), 1e-15);
  EXPECT_LT((ball_ball({1, 0, 0}, 1.0, {1, 0, 2.7}, 2.0).branch() - Vec3(0, 0, 2.7)).norm(), 1e-15);
}

TEST(BallPlane, HoldsACentreThatHasCrossed) {
  const model::Plane plane{{0, 0, 1}, {0, 0, 1}, 0, ""};
  const ContactGeometry above = ball_plane({5, 5, 1.75}, 1.0, plane);
  EXPECT_EQ(above.normal, Vec3(0, 0, -1));
  EXPECT_DOUBLE_EQ(above.overlap, 0.25);
  EXPECT_EQ(above.lever_a, Vec3(0, 0, -0.875));
  const ContactGeometry behind = ball_plane({5, 5, 0.5}, 1.0, plane);
  EXPECT_EQ(behind.normal, Vec3(0, 0, -1));
  EXPECT_DOUBLE_EQ(behind.overlap, 1.5);
}

TEST(ContactMotion, RigidMotionMovesNothingAtTheContact) {
  // Two balls that turn together about the first centre by a small rotation θ: u_b = θ × (x_b - x_a).
  const ContactGeometry g = ball_ball(Vec3::Zero(), 1.0, {0, 1.9, 0}, 1.0);
  const Vec3 theta(0.3, -0.2, 0.5);
  const SideMotion a{Vec3(1, 2, 3), theta};
  const SideMotion b{Vec3(1, 2, 3) + theta.cross(Vec3(0, 1.9, 0)), theta};
  const ContactMotion motion = contact_motion(g, a, b);
  EXPECT_LT(motion.displacement.norm(), 1e-15);
  EXPECT_EQ(motion.rotation, Vec3(0, 0, 0));
  EXPECT_NEAR(motion.spin, theta.y(), 1e-15);  // about n
}

TEST(ShearTransport, ExactRotationKeepsLengthAndTangency) {
  std::mt19937_64 random(3);
  for (int k = 0; k < 1000; ++k) {
    const Vec3 n_old = test::random_vector(random).normalized();
    const Vec3 n = test::random_vector(random).normalized();
    const Vec3 shear = n_old.cross(test::random_vector(random));
    const Vec3 carried = carry_shear(shear, n_old, n, test::random_vector(random).x());
    // The shortest way between normals is the worse defined the nearer they are to opposite.
    const double tolerance = 4e-15 / (1 + n_old.dot(n)) * shear.norm();
    EXPECT_NEAR(carried.norm(), shear.norm(), tolerance);
    EXPECT_LT(std::abs(carried.dot(n)), tolerance);
  }
}

TEST(ShearTransport, TurnsWithARigidRotation) {
  // Carried through a rotation Q about any axis, with the spin of that rotation about n, F becomes Q F when
  // the steps are small; here in 1000 steps of one turn about an axis oblique to n.
  const Vec3 axis = Vec3(1, 2, -0.5).normalized();
  constexpr int steps = 1000;
  const Vec3 theta = 2 * std::numbers::pi / steps * axis;
  const Mat3 step = Eigen::AngleAxisd(theta.norm(), axis).toRotationMatrix();
  Vec3 n = Vec3(0.3, -1, 0.7).normalized();
  const Vec3 start = n.cross(Vec3(1, 0, 0));
  Vec3 exact = start;
  Vec3 small = start;
  for (int k = 0; k < steps; ++k) {
    const Vec3 next = (step * n).normalized();
    exact = carry_shear(exact, n, next, theta.dot(next));
    small = carry_shear_small_angle(small, n, next, theta.dot(next));
    n = next;
  }
  // Second order: the angle of the twist errs by O(θ³) a step.
  EXPECT_LT((exact - start).norm(), 50 / double(steps) / steps);
  EXPECT_NEAR(exact.norm(), start.norm(), 1e-12);
  // PFC3D's form grows by up to ½θ² a step: first order a turn, up to ½(2π)²/steps = 2%.
  EXPECT_GT(small.norm() - start.norm(), 0.002 * start.norm());
  EXPECT_LT(small.norm() - start.norm(), 0.02 * start.norm());
}

TEST(ShearTransport, SmallAngleFormErrsAsTheorySays) {
  // Eqs. 1.11-1.12 (docs/theory.md): for a tilt by θ across F, |F| grows by ½θ² of itself.
  const double theta = 1e-3;
  const Vec3 n_old(0, 0, 1);
  const Vec3 n(0, std::sin(theta), std::cos(theta));  // tilt about x
  const Vec3 shear(0, 1, 0);                          // across the rotation axis
  const Vec3 carried = carry_shear_small_angle(shear, n_old, n, 0.0);
  EXPECT_NEAR((carried.norm() - 1) / (0.5 * theta * theta), 1.0, 1e-5);
  EXPECT_LT(std::abs(carried.dot(n)), 0.51 * theta * theta * theta);
  EXPECT_GT(std::abs(carried.dot(n)), 0.1 * theta * theta * theta);
}

TEST(ContactElement, EqualsTheOracleOfPfc3dsTermList) {
  std::ifstream file(EIGENGRAIN_TEST_DATA "/contact_stiffness.json");
  const nlohmann::json oracle = nlohmann::json::parse(file);
  ASSERT_EQ(oracle.size(), 50U);
  const auto vec = [](const nlohmann::json& j) { return Vec3(j[0], j[1], j[2]); };
  for (const auto& entry : oracle) {
    const ContactElement element{.a = 0,
                                 .b = 1,
                                 .normal = vec(entry["n3"]),
                                 .lever_a = vec(entry["Ra"]),
                                 .lever_b = vec(entry["Rb"]),
                                 .stiffness = {entry["kn"], entry["ks"], entry["kappa_n"], entry["kappa_s"]}};
    const Mat12 k = stiffness_matrix(element);
    for (int i = 0; i < 12; ++i)
      for (int j = 0; j < 12; ++j)
        EXPECT_NEAR(k(i, j), double(entry["K"][static_cast<std::size_t>(12 * i + j)]), 1e-12);
  }
}

TEST(ContactElement, BlocksAreTheProductBtDB) {
  std::mt19937_64 random(5);
  for (int k = 0; k < 100; ++k) {
    const ContactElement element = random_element(random);
    const auto b = strain_displacement(element);
    const Mat12 product = b.transpose() * elasticity(element) * b;
    EXPECT_LT((stiffness_matrix(element) - product).cwiseAbs().maxCoeff(),
              1e-14 * product.cwiseAbs().maxCoeff());
  }
}

TEST(ContactElement, IsSymmetricSemidefiniteOfRankSix) {
  std::mt19937_64 random(6);
  for (int k = 0; k < 100; ++k) {
    const Mat12 matrix = stiffness_matrix(random_element(random));
    EXPECT_LT((matrix - matrix.transpose()).cwiseAbs().maxCoeff(), 1e-15 * matrix.trace());
    const Vec6 zero =
        Eigen::SelfAdjointEigenSolver<Mat12>(matrix, Eigen::EigenvaluesOnly).eigenvalues().head<6>();
    EXPECT_LT(zero.cwiseAbs().maxCoeff(), 1e-13 * matrix.trace());
  }
}

}  // namespace
}  // namespace eigengrain::contact
