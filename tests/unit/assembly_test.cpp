#include "eigengrain/assembly/block_diagonal.hpp"
#include "eigengrain/assembly/eigen_matrix.hpp"
#include "eigengrain/assembly/forces.hpp"
#include "eigengrain/assembly/product.hpp"
#include "eigengrain/base/error.hpp"
#include "eigengrain/base/parallel.hpp"

#include "support/scenes.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <random>

namespace eigengrain::assembly {
namespace {

using test::fix_all;
using test::SceneBuilder;
using test::System;

/// Three balls in a row along x that overlap by 0.1, the third one apart from them.
SceneBuilder two_and_one(const test::Springs& springs) {
  return SceneBuilder(springs).ball({0, 0, 0}).ball({1.9, 0, 0}).ball({9, 0, 0});
}

TEST(Unknowns, SetsAsideWhatNothingTouches) {
  const System s(two_and_one({.kn = 1, .ks = 1}));
  EXPECT_EQ(s.unknowns.blocks(), 4);
  ASSERT_EQ(s.unknowns.set_aside().size(), 1U);
  EXPECT_EQ(s.model.bodies.identity[static_cast<std::size_t>(s.unknowns.set_aside()[0])], 2);
}

TEST(Unknowns, HaveRotationsOnlyWhereAContactResistsThem) {
  EXPECT_EQ(System(two_and_one({.kn = 1, .ks = 0})).unknowns.rotations(), 0);
  EXPECT_EQ(System(two_and_one({.kn = 1, .ks = 1})).unknowns.rotations(), 2);
  // Friction decides whether ks counts.
  EXPECT_EQ(System(two_and_one({.kn = 1, .ks = 1, .tension = false})).unknowns.rotations(), 2);
}

TEST(Unknowns, DropFixedVectorsAndMaskPartlyFixedOnes) {
  SceneBuilder builder({.kn = 1, .ks = 1});
  builder.ball({0, 0, 0}, 1, 1, fix_all)
      .ball({1.9, 0, 0}, 1, 1, model::FixedComponents(0b000101))
      .ball({3.8, 0, 0}, 1, 1, model::FixedComponents(0b111000));
  const System s(builder);
  const auto row = [&](std::int64_t identity) {
    const auto& ids = s.model.bodies.identity;
    return static_cast<std::int32_t>(std::find(ids.begin(), ids.end(), identity) - ids.begin());
  };
  EXPECT_EQ(s.unknowns.translation(row(0)), Unknowns::none);
  EXPECT_EQ(s.unknowns.rotation(row(0)), Unknowns::none);
  for (int k = 0; k < 3; ++k) {
    EXPECT_EQ(s.unknowns.is_fixed(s.unknowns.translation(row(1)), k), k != 1);
    EXPECT_FALSE(s.unknowns.is_fixed(s.unknowns.rotation(row(1)), k));
  }
  EXPECT_NE(s.unknowns.translation(row(2)), Unknowns::none);
  EXPECT_EQ(s.unknowns.rotation(row(2)), Unknowns::none);
  EXPECT_EQ(s.unknowns.size(), 9);
  EXPECT_EQ(s.unknowns.free_components().size(), 7U);  // 9 less the two fixed ones
  EXPECT_TRUE(s.unknowns.set_aside().empty());
  for (std::int32_t block = 0; block < s.unknowns.blocks(); ++block) {
    const std::int32_t body = s.unknowns.body(block);
    EXPECT_EQ(block,
              s.unknowns.is_rotation(block) ? s.unknowns.rotation(body) : s.unknowns.translation(body));
  }
}

TEST(BuildModel, NamesBothBallsAtOnePlace) {
  SceneBuilder builder;
  builder.ball({1, 2, 3}).ball({9, 9, 9}).ball({1, 2, 3});
  try {
    builder.build();
    FAIL();
  } catch (const InputError& error) {
    EXPECT_THAT(error.what(), testing::HasSubstr("balls 0 and 2 have the same centre (1, 2, 3)"));
  }
}

TEST(BuildModel, NamesTheMaterialsWithoutARule) {
  SceneBuilder builder;
  builder.ball({0, 0, 0}).ball({1.9, 0, 0});
  builder.scene().contacts.clear();
  try {
    builder.build();
    FAIL();
  } catch (const InputError& error) {
    EXPECT_THAT(error.what(), testing::HasSubstr("between: [grain, grain]"));
  }
}

TEST(BuildModel, FrictionlessContactsKeepNoHistory) {
  const Model model = two_and_one({.kn = 1, .ks = 1, .tension = false}).build();
  ASSERT_EQ(model.contacts.groups.size(), 1U);
  SceneBuilder frictionless = two_and_one({.kn = 1, .ks = 1, .tension = false});
  frictionless.scene().contacts[0].parameters[2] = 0;
  const Model without = frictionless.build();
  EXPECT_TRUE((std::holds_alternative<contact::ContactGroup<contact::BallBall, contact::LinearFrictionless>>(
      without.contacts.groups.at(0))));
  EXPECT_TRUE((std::holds_alternative<contact::ContactGroup<contact::BallBall, contact::Linear>>(
      model.contacts.groups.at(0))));
}

TEST(BuildModel, TouchesThroughSeveralImages) {
  // A cell of 1.9 × 4 × 4 with one ball of radius 1: it touches itself across x. With two along y, each pair
  // touches within the cell and through the boundary.
  SceneBuilder alone({.kn = 1});
  alone.ball({0.5, 2, 2}).periodic({1.9, 4, 4});
  EXPECT_EQ(alone.build().contacts.size(), 1);
  SceneBuilder pair({.kn = 1});
  pair.ball({2, 1, 2}).ball({2, 2.9, 2}).periodic({4, 3.8, 4});
  EXPECT_EQ(pair.build().contacts.size(), 2);
}

TEST(ContactForces, BalanceAndAreWhatThePaperSays) {
  // Two balls overlapping by 0.1 along x on a floor at z = -0.95, so by 0.05: F = kn U on each.
  const Model model =
      SceneBuilder({.kn = 100}).ball({0, 0, 0}).ball({1.9, 0, 0}).plane({0, 0, -0.95}, {0, 0, 1}).build();
  const BodyForces f = contact_forces(model);
  const std::size_t left = model.bodies.position[0].x() < 1 ? 0 : 1;
  EXPECT_TRUE(f.force[left].isApprox(Vec3(-10, 0, 5), 1e-12));
  EXPECT_TRUE(f.force[1 - left].isApprox(Vec3(10, 0, 5), 1e-12));
}

TEST(ContactForces, MomentsBalanceUnderShear) {
  std::mt19937_64 random(11);
  const Model model = test::random_cluster(random, 30, {.kn = 1, .ks = 0.7}).build();
  Displacement d{{}, {}};
  for (std::int32_t i = 0; i < model.bodies.size(); ++i) {
    d.translation.push_back(0.01 * test::random_vector(random));
    d.rotation.push_back(0.01 * test::random_vector(random));
  }
  const BodyForces f = contact_forces(model, d);
  Vec3 force = Vec3::Zero();
  Vec3 moment = Vec3::Zero();
  for (std::size_t i = 0; i < f.force.size(); ++i) {
    force += f.force[i];
    moment += f.moment[i] + (model.bodies.position[i] + d.translation[i]).cross(f.force[i]);
  }
  EXPECT_LT(force.norm(), 1e-13);
  EXPECT_LT(moment.norm(), 1e-12);
}

/// K x by the assembled matrix, for comparison with the product.
Eigen::VectorXd by_matrix(const System& s, const Eigen::VectorXd& x) {
  return stiffness_matrix(s) * x;
}

Eigen::VectorXd random_numbers(std::int64_t n, std::mt19937_64& random) {
  std::normal_distribution<double> gaussian;
  Eigen::VectorXd x(n);
  for (Eigen::Index i = 0; i < n; ++i) x[i] = gaussian(random);
  return x;
}

double relative_difference(const System& s, std::mt19937_64& random) {
  const Eigen::VectorXd x = random_numbers(s.unknowns.size(), random);
  Eigen::VectorXd y(x.size());
  StiffnessProduct product(s.unknowns, s.elements);
  product.apply({x.data(), static_cast<std::size_t>(x.size())},
                {y.data(), static_cast<std::size_t>(y.size())});
  const Eigen::VectorXd expected = by_matrix(s, x);
  return (y - expected).norm() / expected.norm();
}

TEST(StiffnessProduct, EqualsTheAssembledMatrix) {
  std::mt19937_64 random(12);
  for (const double ks : {0.0, 0.5})       // the two compact kinds of record
    for (const int balls : {2, 40, 3000})  // one chunk, and several with contacts between them
      for (const double fixed : {0.0, 0.3}) {
        const System s(test::random_cluster(random, balls, {.kn = 1, .ks = ks}, 2, fixed));
        if (s.unknowns.size() == 0) continue;
        EXPECT_LT(relative_difference(s, random), 1e-14) << ks << ' ' << balls << ' ' << fixed;
      }
}

TEST(StiffnessProduct, TakesAnyLeversAndRotationalStiffness) {
  std::mt19937_64 random(13);
  std::uniform_real_distribution<double> stiffness(0.1, 2);
  System s(test::random_cluster(random, 50, {.kn = 1, .ks = 0.5}));
  for (std::size_t c = 0; c < s.elements.size(); c += 2) {  // every other contact, so that kinds are mixed
    s.elements[c].lever_a = test::random_vector(random);
    s.elements[c].lever_b = test::random_vector(random);
    s.elements[c].stiffness.twist = stiffness(random);
    s.elements[c].stiffness.bending = stiffness(random);
  }
  EXPECT_LT(relative_difference(s, random), 1e-14);
}

TEST(StiffnessProduct, KnowsWallsAndImages) {
  std::mt19937_64 random(14);
  const System walls(
      SceneBuilder({.kn = 2, .ks = 1}).ball({0, 0, 0.9}).ball({1.9, 0, 0.9}).plane({0, 0, 0}, {0, 0, 1}));
  EXPECT_EQ(walls.elements.size(), 3U);
  EXPECT_LT(relative_difference(walls, random), 1e-14);
  const System images(
      SceneBuilder({.kn = 2, .ks = 1}).ball({0.1, 0.2, 0.3}).ball({1.1, 0.7, 1.4}).periodic({1.9, 1.8, 2.2}));
  EXPECT_GT(images.elements.size(), 4U);
  EXPECT_LT(relative_difference(images, random), 1e-14);
}

TEST(StiffnessProduct, IsTheSameToTheBitOnAnyNumberOfThreads) {
  std::mt19937_64 random(15);
  const System s(test::random_cluster(random, 5000, {.kn = 1, .ks = 0.5}, 3));
  const Eigen::VectorXd x = random_numbers(s.unknowns.size(), random);
  const auto product_with = [&](int count) {
    set_threads(count);
    Eigen::VectorXd y(x.size());
    StiffnessProduct product(s.unknowns, s.elements);
    product.apply({x.data(), static_cast<std::size_t>(x.size())},
                  {y.data(), static_cast<std::size_t>(y.size())});
    return y;
  };
  const Eigen::VectorXd one = product_with(1);
  EXPECT_EQ(one, product_with(2));
  EXPECT_EQ(one, product_with(5));
}

TEST(BlockDiagonal, HoldsTheDiagonalBlocksOfTheMatrix) {
  std::mt19937_64 random(16);
  // Free bodies only, so that every body has its u and θ; and a cell in which bodies touch themselves.
  const std::array scenes{
      test::random_cluster(random, 20, {.kn = 1, .ks = 0.5}),
      SceneBuilder({.kn = 2, .ks = 1}).ball({0.1, 0.2, 0.3}).ball({1.1, 0.7, 1.4}).periodic({1.9, 1.8, 2.2})};
  for (const SceneBuilder& scene : scenes) {
    const System s(scene);
    BlockDiagonal diagonal(s.model.bodies.size());
    assemble_stiffness(s.model, diagonal);
    const Eigen::MatrixXd k = stiffness_matrix(s);
    for (std::int32_t body = 0; body < s.model.bodies.size(); ++body) {
      ASSERT_EQ(s.unknowns.rotation(body), s.unknowns.translation(body) + 1);
      const int first = 3 * s.unknowns.translation(body);
      const Mat6& block = diagonal.blocks()[static_cast<std::size_t>(body)];
      EXPECT_LT((block - k.block<6, 6>(first, first)).cwiseAbs().maxCoeff(), 1e-13);
    }
  }
}

TEST(Mass, IsOnTheDiagonalAndMaskedNumbersDropOutOfItsRoot) {
  SceneBuilder builder({.kn = 1, .ks = 1});
  builder.ball({0, 0, 0}, 1, 4, model::FixedComponents(0b000010)).ball({1.9, 0, 0}, 1, 9);
  const System s(builder);
  const std::vector<double>& mass = s.mass;
  const std::vector<double> root = s.inverse_sqrt_mass();
  const std::size_t u =
      static_cast<std::size_t>(3 * s.unknowns.translation(s.model.bodies.mass[0] == 4 ? 0 : 1));
  EXPECT_EQ(mass[u], 4.0);
  EXPECT_EQ(root[u], 0.5);
  EXPECT_EQ(root[u + 1], 0.0);
  EXPECT_EQ(mass[u + 3], 1.6);
}

}  // namespace
}  // namespace eigengrain::assembly
