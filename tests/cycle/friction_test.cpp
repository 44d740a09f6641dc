// Sliding, rolling and oblique impacts against closed forms; what rests on walls.
#include "eigengrain/assembly/balance.hpp"

#include "support/motion.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>
#include <random>

namespace eigengrain::test {
namespace {

using cycle::Cycle;

/// A ball (R = 1, m = 1) that rests on a floor under its weight g: k_n = 1, so that the overlap is g. With g
/// a power of two the balance is exact to the bit.
SceneBuilder ball_at_rest(double g, double friction, model::FixedComponents fixed = {}) {
  SceneBuilder builder({.kn = 1, .ks = 0.5, .tension = false, .friction = friction});
  return builder.ball({0, 0, 1 - g}, 1, 1, fixed).plane({0, 0, 0}, {0, 0, 1}).gravity({0, 0, -g});
}

// A ball that may not turn, pushed along by 0.5 m g at μ = 0.3, gains (0.5 - 0.3) g.
TEST(Friction, ResistsAPushedBallByMuTimesItsWeight) {
  constexpr double g = 0x1p-20;
  constexpr double mu = 0.3;
  SceneBuilder builder = ball_at_rest(g, mu, fix_rotations).gravity({0.5 * g, 0, -g});
  Cycle cycle = cycle_of(builder, 0.25);
  cycle.run(2000);
  const double before = velocity_of(cycle.state(), 0).x();
  cycle.run(1000);
  // The force is the same at every step; sums of 1000 terms round to 1e-13.
  EXPECT_NEAR(cycle.state().force[0].x(), -mu * g, 1e-14 * g);
  EXPECT_NEAR((velocity_of(cycle.state(), 0).x() - before) / (1000 * 0.25 * 0.2 * g), 1, 1e-11);
}

// Below μ m g it holds: it hangs in the shear spring and swings about the place of rest, x = F/k_s.
TEST(Friction, HoldsABallThatIsPushedByLess) {
  constexpr double g = 0x1p-20;
  SceneBuilder builder = ball_at_rest(g, 0.9, fix_rotations).gravity({0.25 * g, 0, -g});
  Cycle cycle = cycle_of(builder, 0.25);
  double farthest = 0;
  for (int k = 0; k < 4000; ++k) {
    cycle.step();
    farthest = std::max(farthest, position_of(cycle.state(), 0).x());
  }
  // Sudden load: twice the static way 0.25 g/k_s. Discrete steps miss the turning point by (ωΔt)²/8 = 4e-3.
  EXPECT_NEAR(farthest, 2 * 0.25 * g / 0.5, 0.01 * g);
}

// Sliding friction brakes the centre by μ g and spins the ball up by 2.5 μ g/R until the contact point rests:
// at 2u₀/(7 μ g), with 5u₀/7 left.
TEST(Friction, MakesASlidingBallRollAtFiveSeventhsOfItsSpeed) {
  constexpr double g = 0x1p-20;
  constexpr double mu = 0.25;
  constexpr double u0 = 1e-3;
  constexpr double dt = 0.25;
  Cycle cycle = cycle_of(ball_at_rest(g, mu).moving({u0, 0, 0}), dt);
  const double stop = 2 * u0 / (7 * mu * g);
  // At first shear builds up in the spring; then it slips until the surface has come to rest. After that the
  // spring swings between ±μ m g, and touches the limit again and again.
  cycle.run(100);
  while (std::abs(cycle.state().force[0].x()) > (1 - 1e-9) * mu * g) cycle.step();
  const double slips_until = cycle.state().time;
  // The spring holds back the full force from the first steps on (μ m g/k_s is a way of 5e-7 at u₀ = 1e-3).
  EXPECT_NEAR(slips_until, stop, 4 * dt);
  const auto [u, surface] = mean_motion(cycle, 4000);
  // The spring goes on swinging: ±μ g/√(3.5 k_s) = 2e-7 in the speed, less than 1e-2 of that in the mean.
  EXPECT_NEAR(u, 5 * u0 / 7, 1e-5 * u0);
  EXPECT_NEAR(surface, 0, 1e-5 * u0);
}

// An oblique impact without loss along n that slides throughout: F_s = μ F_n at all times, so that the
// impulses are 2 m v_n and μ times that: v_t' = v_t - 2 μ v_n, ω' = 2.5 · 2 μ v_n/R.
TEST(Friction, OfAFullySlidingImpactFollowsFromTheNormalImpulse) {
  constexpr double vn = 1e-5;
  constexpr double mu = 0.3;
  constexpr double vt = 10 * mu * vn;  // slides throughout from 7 μ v_n on
  constexpr double dt = 0.005;
  SceneBuilder builder({.kn = 1, .ks = 0.8, .tension = false, .friction = mu});
  builder.ball({0, 0, 1 + 1.5 * dt * vn}).moving({vt, 0, -vn}).plane({0, 0, 0}, {0, 0, 1});
  Cycle cycle = cycle_of(builder, dt);
  cycle.run(static_cast<std::int64_t>(5 / dt));
  const Vec3 v = velocity_of(cycle.state(), 0);
  const Vec3 w = spin_of(cycle.state(), 0);
  // The normal impulse errs by ¼Δt² (energy_test), that of friction by the first step, in which the contact
  // has no shear yet, Δt² as well; the lever is R - U/2, U <= v_n = 1e-5.
  EXPECT_NEAR(v.z(), vn, 1e-4 * vn);
  EXPECT_NEAR(v.x(), vt - 2 * mu * vn, 1e-4 * vn);
  EXPECT_NEAR(v.y(), 0, 1e-14 * vn);
  EXPECT_NEAR(w.y(), 5 * mu * vn, 1e-4 * vn);  // turned by a force -x below the centre: about +y
}

// Balls that came to rest in a box: the walls carry the weight, up to the resultants that are left.
TEST(Walls, CarryTheWeightOfASettledPile) {
  constexpr double g = 1e-3;
  std::mt19937_64 random(3);
  std::uniform_real_distribution<double> uniform(0, 1);
  SceneBuilder builder({.kn = 1, .ks = 0.5, .tension = false, .friction = 0.4});
  double weight = 0;
  for (int i = 0; i < 64; ++i) {
    const double radius = 0.8 + 0.2 * uniform(random);
    const double mass = radius * radius * radius;
    const Vec3 jitter = 0.15 * Vec3(uniform(random), uniform(random), uniform(random));
    builder.ball(Vec3(1.1 + 2.3 * (i & 3), 1.1 + 2.3 * ((i >> 2) & 3), 1.1 + 2.3 * (i >> 4)) + jitter, radius,
                 mass);
    weight += mass * g;
  }
  builder.plane(Vec3::Zero(), Vec3::UnitZ()).gravity({0, 0, -g}).damped(0.7);
  for (int axis = 0; axis < 2; ++axis)
    builder.plane(Vec3::Zero(), Vec3::Unit(axis)).plane(Vec3::Constant(9.2), -Vec3::Unit(axis));
  Cycle cycle = cycle_of(builder, 0.2);
  assembly::Balance balance;
  for (int k = 0; k < 60; ++k) {
    cycle.run(1000);
    balance = assembly::balance_of(cycle.state());
    if (balance.unsupported == 0 && balance.mean < 1e-8) break;
  }
  ASSERT_LT(balance.mean, 1e-8);
  EXPECT_EQ(balance.unsupported, 0);
  EXPECT_EQ(balance.bodies, 64);
  Vec3 sum(0, 0, weight);  // what walls feel, less what they should
  for (const Vec3& force : assembly::wall_forces(cycle.state().model)) sum += force;
  const double left = balance.mean * balance.mean_contact_force * static_cast<double>(balance.bodies);
  std::printf("pile: |walls + weight| %.2e, resultants %.2e, weight %.2e\n", sum.norm(), left, weight);
  // The sum of all resultants is no more than the sum of their magnitudes, with rounding in 64 weights.
  EXPECT_LE(sum.norm(), left + 1e-14 * weight);
  // And the side walls push inwards, the floor up: the force on each is against its normal.
  const std::vector<Vec3> forces = assembly::wall_forces(cycle.state().model);
  for (std::size_t w = 0; w < forces.size(); ++w)
    EXPECT_LT(forces[w].dot(cycle.state().model.walls[w].normal), 0) << "wall " << w;
}

}  // namespace
}  // namespace eigengrain::test
