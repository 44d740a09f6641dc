// K, its product and the bounds of the timestep with clumps: θ along their principal axes.
#include "eigengrain/assembly/block_diagonal.hpp"
#include "eigengrain/assembly/product.hpp"
#include "eigengrain/assembly/tangent.hpp"
#include "eigengrain/cycle/bounds.hpp"

#include "support/clumps.hpp"

#include <Eigen/Eigenvalues>
#include <gtest/gtest.h>

#include <cmath>
#include <random>

namespace eigengrain::test {
namespace {

/// Overlap over radius: the geometric part of the derivative, which K leaves out, is of this relative size.
constexpr double overlap = 1e-7;
/// A tenth of the overlap, so that no contact opens; positions of order one are known to 1e-16, so the
/// quotient is to some 1e-8 of the stiffness.
constexpr double step = 1e-8;
/// What both errors are ten times smaller than.
constexpr double accuracy = 1e-6;

constexpr std::array<Springs, 3> springs{
    Springs{.kn = 1, .ks = 0.6, .tension = false},  // sticking friction
    Springs{.kn = 1, .ks = 0, .tension = false},    // frictionless: clumps turn all the same
    Springs{.kn = 1, .ks = 0.6, .tension = true},   // linear springs
};

void expect_force_and_stiffness_agree(const SceneBuilder& builder, std::size_t contacts) {
  const System s(builder);
  ASSERT_EQ(s.elements.size(), contacts);
  const Eigen::MatrixXd k = assembly::stiffness_matrix(s);
  const Eigen::MatrixXd derivative = numerical_stiffness(s, step);
  EXPECT_LT((derivative - k).cwiseAbs().maxCoeff() / k.cwiseAbs().maxCoeff(), accuracy);
}

/// Two clumps of any orientation that touch with one pair of balls: the second is moved along the line of two
/// balls until they do.
model::ClumpStart touching(const model::ClumpShape& first, const model::ClumpStart& start,
                           const model::ClumpShape& second, const Quat& orientation, const Vec3& direction) {
  const auto farthest = [](const model::ClumpShape& shape, const Quat& q, const Vec3& way) {
    std::size_t best = 0;
    for (std::size_t k = 0; k < shape.place.size(); ++k)
      if ((q * shape.place[k]).dot(way) + shape.radius[k] >
          (q * shape.place[best]).dot(way) + shape.radius[best])
        best = k;
    return best;
  };
  const std::size_t a = farthest(first, start.orientation, direction);
  const std::size_t b = farthest(second, orientation, -direction);
  const double reach = (first.radius[a] + second.radius[b]) * (1 - 0.5 * overlap);
  return {.position = start.position + start.orientation * first.place[a] + reach * direction -
                      orientation * second.place[b],
          .orientation = orientation};
}

TEST(ClumpStiffness, IsTheDerivativeOfTheForcesBetweenBallAndClump) {
  std::mt19937_64 random(11);
  for (const Springs& s : springs) {
    const model::ClumpShape shape = odd_shape();
    const Quat q = random_orientation(random);
    SceneBuilder builder(s);
    const Vec3 direction = random_vector(random).normalized();
    const model::ClumpShape ball = given_shape({Vec3::Zero()}, {0.9}, 1, Vec3::Ones());
    const Vec3 at = touching(shape, {.orientation = q}, ball, Quat::Identity(), direction).position;
    builder.ball(at, 0.9, 2.0);
    builder.clump(shape, {.orientation = q});
    expect_force_and_stiffness_agree(builder, 1);
  }
}

TEST(ClumpStiffness, IsTheDerivativeOfTheForcesBetweenClumps) {
  std::mt19937_64 random(12);
  for (const Springs& s : springs)
    for (int k = 0; k < 3; ++k) {
      const model::ClumpShape first = odd_shape();
      const model::ClumpShape second = dumbbell();
      const model::ClumpStart start{.position = random_vector(random),
                                    .orientation = random_orientation(random)};
      SceneBuilder builder(s);
      builder.clump(first, start);
      builder.clump(second, touching(first, start, second, random_orientation(random),
                                     random_vector(random).normalized()));
      expect_force_and_stiffness_agree(builder, 1);
    }
}

TEST(ClumpStiffness, IsTheDerivativeOfTheForcesOnAWall) {
  std::mt19937_64 random(13);
  for (const Springs& s : springs) {
    // A dumbbell that lies on the floor with both balls, and leans on a wall with one.
    SceneBuilder builder(s);
    builder.clump(dumbbell(), {.position = {0, 0, 1 - overlap},
                               .orientation = Quat(Eigen::AngleAxisd(0.4, Vec3::UnitZ()))});
    builder.plane(Vec3::Zero(), Vec3::UnitZ());
    builder.plane({0, -1 - 0.7 * std::sin(0.4) + overlap, 0}, Vec3::UnitY());
    expect_force_and_stiffness_agree(builder, 3);
  }
}

TEST(ClumpStiffness, IsTheDerivativeThroughThePeriodicCell) {
  // A dumbbell that touches its own image, with the image of its other ball; and a ball across the cell.
  for (const Springs& s : springs) {
    SceneBuilder builder(s);
    builder.ball(Vec3(2.7, 0, 0) + (2 - overlap) * Vec3(-0.3, 0.9, 0.2).normalized(), 1, 1);
    builder.clump(dumbbell(), {.position = {0, 0, 0}});
    builder.periodic({3.4 - 2 * overlap, 20, 20}, {true, false, false});
    const System system(builder);
    ASSERT_EQ(system.elements.size(), 2U);
    const Eigen::MatrixXd k = assembly::stiffness_matrix(system);
    EXPECT_LT((numerical_stiffness(system, step) - k).cwiseAbs().maxCoeff() / k.cwiseAbs().maxCoeff(),
              accuracy);
  }
}

/// A pile of clumps and balls that overlap by some percent, here and there.
SceneBuilder pile(std::mt19937_64& random, const Springs& s, int bodies, double fixed = 0) {
  std::uniform_real_distribution<double> uniform(0, 1);
  SceneBuilder builder(s);
  std::vector<Vec3> centres;
  const double size = 1.6 * std::cbrt(bodies);
  for (int k = 0; k < bodies; ++k)
    centres.emplace_back(size * Vec3(uniform(random), uniform(random), uniform(random)));
  for (int k = 0; k < bodies / 3; ++k)
    builder.ball(centres[static_cast<std::size_t>(k)], 0.6, 0.5 + uniform(random));
  for (int k = bodies / 3; k < bodies; ++k) {
    model::ClumpStart start{.position = centres[static_cast<std::size_t>(k)],
                            .orientation = random_orientation(random)};
    if (uniform(random) < fixed) {
      const auto bits = static_cast<std::uint8_t>(random() % 8);
      start.fixed =
          model::FixedComponents(uniform(random) < 0.5 ? bits : static_cast<std::uint8_t>(bits | 56U));
    }
    builder.clump(k % 2 == 0 ? odd_shape() : dumbbell(), start);
  }
  return builder;
}

TEST(ClumpStiffness, OfEverySinkIsOneMatrix) {
  std::mt19937_64 random(14);
  for (const double ks : {0.0, 0.6})
    for (const double fixed : {0.0, 0.4}) {
      const System s(pile(random, {.kn = 1, .ks = ks}, 12, fixed));
      const Eigen::MatrixXd k = assembly::stiffness_matrix(s);
      ASSERT_GT(k.rows(), 30);
      EXPECT_LT((k - k.transpose()).norm(), 1e-14 * k.norm());
      // The product without a matrix, in its scaled form too.
      const std::vector<double> scale = s.inverse_sqrt_mass();
      for (const bool scaled : {false, true}) {
        assembly::StiffnessProduct product(
            s.unknowns, s.elements, scaled ? std::span<const double>(scale) : std::span<const double>());
        const Eigen::VectorXd x = Eigen::VectorXd::Random(k.rows());
        Eigen::VectorXd y(x.size());
        product.apply({x.data(), static_cast<std::size_t>(x.size())},
                      {y.data(), static_cast<std::size_t>(y.size())});
        const Eigen::Map<const Eigen::VectorXd> d(scale.data(), x.size());
        Eigen::VectorXd expected = k * x;  // masked columns are empty
        if (scaled) expected = d.cwiseProduct(k * d.cwiseProduct(x));
        EXPECT_LT((y - expected).norm(), 1e-13 * expected.norm()) << ks << ' ' << scaled;
      }
      // Blocks of bodies, which are along the axes of space.
      assembly::BlockDiagonal diagonal(s.model.bodies.size());
      for (const auto& element : s.elements) diagonal.add(element);
      for (std::int32_t body = 0; body < s.model.bodies.size(); ++body) {
        const std::int32_t block = s.unknowns.rotation(body);
        if (block == assembly::Unknowns::none) continue;
        const Mat6 own =
            s.unknowns.in_own_axes(body, body, diagonal.blocks()[static_cast<std::size_t>(body)]);
        EXPECT_LT((own.bottomRightCorner<3, 3>() - k.block<3, 3>(3 * block, 3 * block)).norm(), 1e-13);
      }
    }
}

TEST(ClumpStiffness, OnUnknownsOfSpaceHasTheSameSpectrum) {
  // M with whole tensors of inertia along the axes of space, and K without any turning, from the levers
  // alone.
  std::mt19937_64 random(15);
  const System s(pile(random, {.kn = 1, .ks = 0.6}, 9));
  const auto n = static_cast<Eigen::Index>(s.unknowns.size());
  Eigen::MatrixXd k = Eigen::MatrixXd::Zero(n, n);
  for (const contact::ContactElement& e : s.elements) {
    const Mat12 all = contact::stiffness_matrix(e);
    const std::array<std::int32_t, 4> block{s.unknowns.translation(e.a), s.unknowns.rotation(e.a),
                                            s.unknowns.translation(e.b), s.unknowns.rotation(e.b)};
    for (Eigen::Index i = 0; i < 4; ++i)
      for (Eigen::Index j = 0; j < 4; ++j)
        k.block<3, 3>(3 * block[static_cast<std::size_t>(i)], 3 * block[static_cast<std::size_t>(j)]) +=
            all.block<3, 3>(3 * i, 3 * j);
  }
  Eigen::MatrixXd m = Eigen::MatrixXd::Zero(n, n);
  for (std::int32_t block = 0; block < s.unknowns.blocks(); ++block) {
    Mat3 part = Eigen::Map<const Vec3>(&s.mass[static_cast<std::size_t>(3 * block)]).asDiagonal();
    const Mat3* axes = s.unknowns.axes(s.unknowns.body(block));
    if (s.unknowns.is_rotation(block) && axes != nullptr) part = *axes * part * axes->transpose();
    m.block<3, 3>(3 * block, 3 * block) = part;
  }
  const Eigen::VectorXd expected =
      Eigen::GeneralizedSelfAdjointEigenSolver<Eigen::MatrixXd>(k, m, Eigen::EigenvaluesOnly).eigenvalues();
  const Eigen::VectorXd found = s.spectrum();
  ASSERT_EQ(found.size(), expected.size());
  EXPECT_LT((found - expected).cwiseAbs().maxCoeff(), 1e-12 * expected.maxCoeff());
}

TEST(ClumpBounds, AreNeverAboveTheTruth) {
  std::mt19937_64 random(16);
  double sharpest = 0;
  for (int k = 0; k < 300; ++k) {
    const System s(pile(random, {.kn = 1, .ks = (k % 3) * 0.5}, 2 + k % 9, k % 2 == 0 ? 0.0 : 0.4));
    if (s.elements.empty() || s.unknowns.free_components().empty()) continue;
    const double lambda = s.spectrum().maxCoeff();
    if (!(lambda > 1e-9)) continue;
    const double truth = 2 / std::sqrt(lambda);
    EXPECT_LE(cycle::block_bound(s), truth) << k;
    const double scaled = cycle::scaled_block_bound(s);
    EXPECT_LE(scaled, truth) << k;
    sharpest = std::max(sharpest, scaled / truth);
    // The estimate is no bound, but never more than √3 off (docs/theory.md).
    EXPECT_LE(cycle::diagonal_estimate(s), std::sqrt(3.0) * truth * (1 + 1e-12)) << k;
  }
  EXPECT_GT(sharpest, 0.98);  // and no empty promise either
}

TEST(ClumpUnknowns, AreTheHoldersAndTurnWithoutShear) {
  SceneBuilder builder({.kn = 1, .ks = 0, .tension = false});
  builder.ball({0.7, 1.99, 0}, 1, 1);
  builder.clump(dumbbell(), {});
  builder.clump(dumbbell(), {.position = {100, 0, 0}});
  const System s(builder);
  EXPECT_EQ(s.unknowns.blocks(), 3);  // u of the ball, u and θ of the clump
  EXPECT_EQ(s.unknowns.rotations(), 1);
  EXPECT_EQ(s.unknowns.set_aside().size(), 1U);  // one body, not two balls
}

TEST(ClumpTangent, IsTheDerivativeAtLargeOverlaps) {
  // Overlaps of some percent of the radius: turning frames, moving points and the moving arms of the forces
  // on the balls of clumps all count. Differences of 1e-6: errors of 1e-10 by rounding, 1e-12 by curvature.
  std::mt19937_64 random(17);
  for (const Springs& spring : springs) {
    const System s(pile(random, spring, 8));
    ASSERT_GT(s.elements.size(), 8U);
    const auto bodies = static_cast<std::size_t>(s.model.bodies.size());
    const std::vector<Vec3> still(bodies, Vec3::Zero());
    UnknownTangent tangent(s.unknowns);
    assembly::assemble_tangent(s.model, {s.model.bodies.position, still, still, 1.0, {}}, tangent);
    const Eigen::MatrixXd derivative = numerical_stiffness(s, 1e-6);
    EXPECT_LT((derivative - tangent.k).cwiseAbs().maxCoeff(), 1e-8 * derivative.cwiseAbs().maxCoeff());
  }
}

}  // namespace
}  // namespace eigengrain::test
