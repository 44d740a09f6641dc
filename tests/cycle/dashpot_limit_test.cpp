// How long a step may be with dashpots: the truth by running, and what policies make of it.
#include "eigengrain/cycle/bounds.hpp"
#include "eigengrain/cycle/policy.hpp"

#include "support/laws.hpp"
#include "support/motion.hpp"
#include "support/surfaces.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>
#include <random>

namespace eigengrain::test {
namespace {

using cycle::Cycle;

/// One mode: (2/ω)(√(ξ² + 1/(1 + α)) - ξ).
double limit_of_one(double omega, double xi, double alpha) {
  return 2 / omega * (std::sqrt(xi * xi + 1 / (1 + alpha)) - xi);
}

SceneBuilder ball_on_wall(double beta, double alpha) {
  SceneBuilder builder = with_law("linear", {{"kn", 1}, {"tension", 1}, {"beta_n", beta}});
  return builder.ball({0, 0, 1 - 1e-9}).plane({0, 0, 0}, {0, 0, 1}).damped(alpha);
}

/// Largest speed of the last tenth of some steps over the speed at the start, at a part of the limit.
double growth(double beta, double alpha, double of_limit, int steps) {
  SceneBuilder builder = ball_on_wall(beta, alpha);
  builder.moving({0, 0, 1e-6});
  Cycle cycle = cycle_of(std::move(builder), of_limit * limit_of_one(1, beta, alpha));
  double most = 0;
  for (int k = 0; k < steps; ++k) {
    cycle.step();
    if (10 * k >= 9 * steps) most = std::max(most, std::abs(velocity_of(cycle.state(), 0).z()));
  }
  return most / 1e-6;
}

// Near z = -1 the root moves by about -1e-3 for a thousandth of the step: e^0.001 a step at least, 20,000
// steps.
TEST(DampedLimit, IsWhereTheCycleBeginsToGrow) {
  for (const double beta : {0.1, 1.0})
    for (const double alpha : {0.0, 0.7}) {
      const double below = growth(beta, alpha, 0.999, 20000);
      const double above = growth(beta, alpha, 1.001, 20000);
      std::printf("beta %.1f, alpha %.1f: %.2e below, %.2e above\n", beta, alpha, below, above);
      EXPECT_LT(below, 1);
      EXPECT_GT(above, 1e3);
    }
}

TEST(Policies, TakeDashpotsIntoAccount) {
  for (const double beta : {0.2, 1.0}) {
    SceneBuilder builder = ball_on_wall(beta, 0.7);
    const assembly::State state = cycle::start(builder.scene());
    model::Scene& settings = builder.scene();
    settings.timestep = {model::TimestepPolicy::bound, 0.9, {}};
    EXPECT_NEAR(cycle::policy_of(settings).dt(state), 0.9 * limit_of_one(1, beta, 0.7), 1e-11);
    settings.timestep = {model::TimestepPolicy::estimate, 0.8, {}};
    // PFC3D's eq. 1.35: k over F(β)², F(β) = √(1 + β²) - β.
    EXPECT_NEAR(cycle::policy_of(settings).dt(state), 0.8 * (std::sqrt(1 + beta * beta) - beta), 1e-14);
  }
}

// A ball in flight is judged by the contact that it may form.
TEST(Policies, JudgeFirstContactsWithTheirDashpotsAndTheirImpact) {
  SceneBuilder builder = with_law("linear", {{"kn", 1}, {"beta_n", 0.5}});
  builder.ball({0, 0, 5}).plane({0, 0, 0}, {0, 0, 1}).damped(0.7);
  builder.scene().timestep = {model::TimestepPolicy::bound, 1.0, {}};
  // Two such balls: ω² = 2k/m; c of the ball's own mass, c/m_reduced = 4βω_1, so ξ = 4β/2√2 of ω.
  const double expected = limit_of_one(std::sqrt(2.0), std::sqrt(2.0) * 0.5, 0.7);
  EXPECT_NEAR(cycle::policy_of(builder.scene()).dt(cycle::start(builder.scene())), expected, 1e-12);

  SceneBuilder fast = with_law("hertz", {{"effective_young", 1e6}});
  fast.ball({0, 0, 5}).moving({0, 0, -1}).plane({0, 0, 0}, {0, 0, 1});
  SceneBuilder faster = fast;
  faster.scene().bodies.velocity[0].z() = -100;
  const auto step = [](SceneBuilder& scene) {
    return cycle::policy_of(scene.scene()).dt(cycle::start(scene.scene()));
  };
  EXPECT_LT(step(faster), 0.8 * step(fast));
}

// The springs of a law that could have dashpots are not damped by that.
TEST(Policies, KnowNoDashpotsWhereTheirRatiosAreZero) {
  SceneBuilder builder = with_law("hertz", {{"effective_young", 1e6}});
  builder.ball({0, 0, 1 - 1e-3}).plane({0, 0, 0}, {0, 0, 1});
  EXPECT_TRUE(assembly::LinearSystem(builder.build()).damping.empty());
  builder.scene().contacts[0].parameters = values_of("hertz", {{"effective_young", 1e6}, {"beta_n", 0.1}});
  EXPECT_FALSE(assembly::LinearSystem(builder.build()).damping.empty());
}

// A ball that is near enough to be listed has its impact still before it, and so has one that a wall runs
// into.
TEST(Policies, CountTheImpactOfANearBallAndOfAWall) {
  const auto step = [](double height, double ball, double wall) {
    SceneBuilder builder = with_law("hertz", {{"effective_young", 1e6}});
    builder.ball({0, 0, 1 + height}).moving({0, 0, -ball}).plane({0, 0, 0}, {0, 0, 1}).carried({0, 0, wall});
    model::Scene& scene = builder.scene();
    scene.timestep = {model::TimestepPolicy::bound, 1.0, {}};
    return cycle::policy_of(scene).dt(cycle::start(scene));
  };
  EXPECT_EQ(step(1e-3, 100, 0), step(5, 100, 0));  // listed or not
  EXPECT_LT(step(1e-3, 100, 0), 0.8 * step(1e-3, 1, 0));
  EXPECT_EQ(step(5, 0, 200), step(5, 100, 0));  // two such balls meet as fast
}

// Where a ball may come to touch another triangle without a new list, the bound is asked for in between.
TEST(Policies, AskForTheBoundInBetweenWhereThereAreSurfaces) {
  SceneBuilder builder;
  builder.scene().timestep = {model::TimestepPolicy::bound, 1.0, {}};
  EXPECT_EQ(cycle::policy_of(builder.scene()).every, 0);
  builder.surface(flat(2, 1));
  EXPECT_GT(cycle::policy_of(builder.scene()).every, 0);
}

// A stiffness that follows the overlap has to be asked for while contacts only get deeper.
TEST(Policies, AskMoreOftenWhereStiffnessFollowsTheOverlap) {
  SceneBuilder linear = with_law("linear", {{"kn", 1}});
  SceneBuilder hertz = with_law("hertz", {{"effective_young", 1}});
  EXPECT_GT(cycle::policy_of(linear.scene()).every, 10 * cycle::policy_of(hertz.scene()).every);
  EXPECT_GT(cycle::policy_of(hertz.scene()).every, 0);
}

}  // namespace
}  // namespace eigengrain::test
