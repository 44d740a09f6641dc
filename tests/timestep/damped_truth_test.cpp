// The limit of the damped cycle against dense algebra and closed forms.
#include "eigengrain/cycle/bounds.hpp"

#include "support/damped.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>
#include <random>
#include <utility>

namespace eigengrain::test {
namespace {

using timestep::Truth;

TEST(DampedTruth, IsTheLargestRootOfTheDenseQuadraticProblem) {
  std::mt19937_64 random(11);
  std::uniform_real_distribution<double> uniform(0, 1);
  double worst = 0;
  for (int scene = 0; scene < 60; ++scene) {
    SceneBuilder builder = random_cluster(random, 3 + scene % 8, {}, 2, 0.2);
    builder.scene().contacts =
        damped_scene(0.7 * uniform(random), {2 * uniform(random), uniform(random)}).scene().contacts;
    if (scene % 3 > 0) mix(builder, static_cast<std::uint64_t>(scene));
    const System s(builder);
    if (s.elements.empty() || s.unknowns.free_components().empty()) continue;
    const Truth truth = truth_of(s);
    if (!std::isfinite(truth.limit)) continue;
    worst = std::max(worst, std::abs(truth.limit / dense_limit_of(s) - 1));
    EXPECT_TRUE(truth.certified);
    EXPECT_LE(truth.limit_proof.dt, truth.limit);
    EXPECT_GT(truth.limit_proof.dt, truth.limit * (1 - 1e-6));
  }
  std::printf("largest relative difference from the companion matrix: %.1e\n", worst);
  EXPECT_LT(worst, 1e-10);  // residuals of 1e-10 and unsymmetric dense eigenvalues
}

TEST(DampedTruth, OfOneModeIsItsClosedForm) {
  for (const double beta : {0.0, 0.01, 0.5, 2.0})
    for (const double alpha : {0.0, 0.4, 0.8}) {
      SceneBuilder builder = damped_scene(0, {beta, 0});
      builder.ball({0, 0, 1 - 1e-9}).plane({0, 0, 0}, {0, 0, 1}).damped(alpha);
      const double expected = 2 * (std::sqrt(beta * beta + 1 / (1 + alpha)) - beta);
      EXPECT_NEAR(truth_of(System(builder)).limit / expected, 1, 1e-12) << beta << " " << alpha;
    }
}

// Eq. 1.35 (tests/bench/damped_limits.py prints more) for two equal balls, k_s = ½: the mode across n with
// both rolling has k/m = 7 k_s, c/m = 7 c_s, c_s = 2β√(½ k_s); the rule takes √(I/(R² k_s)) F(β) of it. Safe
// at rest (0.84), it is 1.38 times the limit at β = 1, and 1.81 with α = 0.8 beside it.
TEST(DampedTruth, IsBelowTheRuleOfPfc3dForOnePair) {
  for (const auto& [beta, alpha] : {std::pair{0.0, 0.0}, std::pair{1.0, 0.0}, std::pair{1.0, 0.8}}) {
    SceneBuilder builder = damped_scene(0.5, {beta, beta});
    builder.ball(Vec3::Zero()).ball({2 - 1e-9, 0, 0}).damped(alpha);
    const System s(builder);
    const double a = 1 + alpha;
    const double limit = 2 / (0.5 * (7 * a * beta + std::sqrt(49 * a * a * beta * beta + 14 * a)));
    EXPECT_NEAR(truth_of(s).limit / limit, 1, 1e-8);  // levers are R - ½ 1e-9
    const double rule = cycle::damped_timestep(cycle::diagonal_estimate(s), alpha);
    EXPECT_NEAR(rule / (std::sqrt(0.8) * (std::sqrt(1 + beta * beta) - beta) / std::sqrt(a)), 1, 1e-8);
    EXPECT_EQ(rule > limit, beta > 0);
  }
}

TEST(DampedTruth, WithoutDashpotsIsOverRootOnePlusAlphaExactly) {
  const System s(unstressed_cluster(3, 12, {.kn = 1, .ks = 0.5}, 0.7));
  const Truth truth = truth_of(s);
  EXPECT_EQ(truth.limit, cycle::damped_timestep(truth.dt, 0.7));
  EXPECT_EQ(truth.limit_proof.dt, cycle::damped_timestep(truth.proof.dt, 0.7));
}

// The iteration that larger systems need, against the dense one.
TEST(DampedTruth, IterationAndDenseLinearizationAgree) {
  SceneBuilder small = damped_scene(0.6, {0.3, 0.2});
  mix(with_balls(small, unstressed_places(4, 8)), 5);
  SceneBuilder large = damped_scene(0.6, {0.3, 0.2});
  mix(with_balls(large, unstressed_places(4, 40)), 5);
  const System a(small);
  const System b(large);
  EXPECT_LE(a.unknowns.size(), timestep::dense_unknowns);
  EXPECT_GT(b.unknowns.size(), timestep::dense_unknowns);
  EXPECT_NEAR(truth_of(a).limit / dense_limit_of(a), 1, 1e-11);
  EXPECT_NEAR(truth_of(b).limit / dense_limit_of(b), 1, 1e-11);
}

}  // namespace
}  // namespace eigengrain::test
