// Local damping of each body for itself.
#include "eigengrain/assembly/local_damping.hpp"
#include "eigengrain/cycle/bounds.hpp"
#include "eigengrain/cycle/policy.hpp"

#include "support/ledger.hpp"
#include "support/motion.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

namespace eigengrain::test {
namespace {

using cycle::Cycle;

/// Ratio of two successive turning points of a ball on a wall spring, k = m = 1, z = 1 + amplitude.
double half_cycle_ratio(Cycle& cycle, std::int64_t ball, double rest) {
  double first = 0;
  double extreme = 0;
  double before = velocity_of(cycle.state(), ball).z();
  for (int k = 0; k < 100000; ++k) {
    cycle.step();
    const double v = velocity_of(cycle.state(), ball).z();
    extreme = std::max(extreme, std::abs(position_of(cycle.state(), ball).z() - rest));
    if (v * before < 0) {
      if (first != 0) return extreme / first;
      first = extreme;
      extreme = 0;
      // Until it is on the other side its distance is still that of before.
      while (velocity_of(cycle.state(), ball).z() * (position_of(cycle.state(), ball).z() - rest) < 0)
        cycle.step();
    }
    before = velocity_of(cycle.state(), ball).z();
  }
  return 0;
}

// sqrt((1 - α)/(1 + α)) of each. The turning point is met to Δt²/8 of the amplitude, the period of leapfrog
// errs by Δt²/24, and where the velocity changes sign the damping follows up to a step later, which is worth
// 2α F · FΔt² of the energy ½F²: together below 2Δt² of the amplitude.
TEST(OwnDamping, EachBallDecaysByItsOwn) {
  constexpr double dt = 2e-3;
  const double alphas[] = {0.1, 0.7, 0.4};
  for (std::int64_t ball = 0; ball < 3; ++ball) {
    SceneBuilder builder;
    for (int i = 0; i < 3; ++i) builder.ball({5.0 * i, 0, 1 - 1e-3}).moving({0, 0, -1e-2});
    builder.scene().bodies.damping = {alphas[0], alphas[1], model::Bodies::scene_damping};
    Cycle cycle = cycle_of(builder.plane(Vec3::Zero(), Vec3::UnitZ()).damped(alphas[2]), dt);
    const double alpha = alphas[ball];
    EXPECT_NEAR(half_cycle_ratio(cycle, ball, 1), std::sqrt((1 - alpha) / (1 + alpha)), 2 * dt * dt) << alpha;
  }
}

TEST(OwnDamping, BoundsCountTheLargest) {
  SceneBuilder builder;
  builder.ball({0, 0, 1 - 1e-3}).damped_alone(0.6).ball({5, 0, 1 - 1e-3});
  builder.plane(Vec3::Zero(), Vec3::UnitZ()).damped(0.2);
  builder.scene().timestep = {model::TimestepPolicy::bound, 1.0, {}};
  const assembly::State state = cycle::start(builder.scene());
  EXPECT_EQ(assembly::largest_damping(state.model), 0.6);
  // One spring k = m = 1: 2, and with α 2/sqrt(1.6); the margin for rounding is 1e-12.
  EXPECT_NEAR(cycle::policy_of(builder.scene()).dt(state), 2 / std::sqrt(1.6), 1e-11);
}

// What each loses is counted as its own.
TEST(OwnDamping, TheLedgerClosesWithIt) {
  SceneBuilder builder{Springs{}};
  for (int i = 0; i < 5; ++i)
    builder.ball({2 * i * (1 - 1e-12), 0, 0}).damped_alone(0.15 * i).moving({1e-2 * (i - 2), 0, 0});
  Cycle cycle = cycle_with_ledger(builder, 0.5);
  cycle.step();
  const double begin = measures::ledger_of(cycle.state()).balance_error;
  cycle.run(500);
  EXPECT_GT(measures::ledger_of(cycle.state()).integrals.damping, 0.5 * cycle.state().ledger->initial);
  EXPECT_NEAR(measures::ledger_of(cycle.state()).balance_error, begin, 1e-11 * cycle.state().ledger->initial);
}

}  // namespace
}  // namespace eigengrain::test
