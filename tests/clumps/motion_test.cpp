// Clumps in the explicit cycle.
#include "support/motion.hpp"

#include "eigengrain/assembly/energies.hpp"

#include "support/bits.hpp"
#include "support/clumps.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

namespace eigengrain::test {
namespace {

/// One ball, as itself or as a clump of one, on a rough floor beside a fixed one: it slides, rolls and bumps.
SceneBuilder lonely(bool clump, double damping) {
  SceneBuilder builder({.kn = 1e4, .ks = 6e3, .tension = false, .friction = 0.4});
  builder.ball({2.5, 0.3, 1}, 1, 1, fix_all);
  const double mass = model::sphere_mass(1, 1);
  const Vec3 at(0, 0, 1);
  const Vec3 velocity(1, 0.2, -0.5);
  const Vec3 spin(0.3, -0.2, 0.9);
  if (clump)
    builder.clump(given_shape({Vec3::Zero()}, {1}, mass, Vec3::Constant(model::sphere_inertia(1, mass))),
                  {.position = at, .velocity = velocity, .spin = spin});
  else
    builder.ball(at, 1, mass).moving(velocity, spin);
  builder.plane(Vec3::Zero(), Vec3::UnitZ()).gravity({0.3, 0, -9.81}).damped(damping);
  return builder;
}

TEST(ClumpMotion, OfOneBallIsThatOfTheBall) {
  for (const double damping : {0.0, 0.7}) {
    cycle::Cycle ball = cycle_of(lonely(false, damping), 1e-3);
    cycle::Cycle clump = cycle_of(lonely(true, damping), 1e-3);
    ball.run(3000);
    clump.run(3000);
    // Each step rounds positions of order one; contacts of stiffness 1e4 pass that on without making it grow.
    // Local damping does: it asks for a sign, and where a velocity passes zero rounding decides, once in a
    // while, which way a step's damping goes.
    const double same = damping > 0 ? 1e-5 : 1e-12;
    EXPECT_LT((position_of(ball.state(), 1) - position_of(clump.state(), 1)).norm(), same) << damping;
    EXPECT_LT((velocity_of(ball.state(), 1) - velocity_of(clump.state(), 1)).norm(), 10 * same);
    EXPECT_LT((spin_of(ball.state(), 1) - spin_of(clump.state(), 1)).norm(), 10 * same);
    EXPECT_GT((position_of(ball.state(), 1) - Vec3(0, 0, 1)).norm(), 0.1);
    const auto e_ball = assembly::energies_of(ball.state());
    const auto e_clump = assembly::energies_of(clump.state());
    EXPECT_NEAR(e_ball.kinetic, e_clump.kinetic, 100 * same);
    EXPECT_NEAR(e_ball.kinetic_product, e_clump.kinetic_product, 100 * same);
    EXPECT_NEAR(e_ball.gravitational, e_clump.gravitational, 100 * same);
  }
}

TEST(ClumpMotion, IsAsGivenWhereItIsFixed) {
  SceneBuilder builder({.kn = 1e3, .tension = false});
  builder.ball({0, 0, 1.9}, 1, 1);
  builder.clump(dumbbell(), {.velocity = {0.1, 0, 0}, .spin = {0, 0, 2}, .fixed = fix_all});
  cycle::Cycle cycle = cycle_of(builder, 1e-3);
  cycle.run(1000);
  const model::Clumps& clumps = cycle.state().model.bodies.clumps;
  EXPECT_NEAR(clumps.position[0].x(), 0.1, 1e-13);
  EXPECT_EQ(clumps.spin[0], Vec3(0, 0, 2));
  // The principal axis of the dumbbell has turned by 2 rad.
  const Vec3 axis = clumps.orientation[0] * Vec3::UnitX();
  EXPECT_NEAR(std::abs(axis.dot(Vec3(std::cos(2.0), std::sin(2.0), 0))), 1, 1e-12);
  EXPECT_NEAR(clumps.angular_momentum[0].z(), 2 * clumps.inertia[0].maxCoeff(), 1e-12);
}

TEST(ClumpMotion, StartsAtSecondOrderUnderAConstantMoment) {
  // A spring pulls one end: exact for a half step is not asked, but the error at a time falls by four.
  const auto end = [](double dt, double t) {
    SceneBuilder builder({.kn = 3, .ks = 2, .tension = true});
    builder.ball({0.7, 1.9999, 0.1}, 1, 1, fix_all);
    builder.clump(odd_shape(),
                  {.position = {0.1, 0.2, 0}, .velocity = {0.01, 0, 0}, .spin = {0.02, 0.01, -0.03}});
    cycle::Cycle cycle = cycle_of(builder, dt);
    cycle.run(std::llround(t / dt));
    return position_of(cycle.state(), 2);
  };
  constexpr double t = 4;
  const Vec3 fine = end(t / 16384, t);
  std::vector<double> error;
  for (const int steps : {256, 512, 1024}) error.push_back((end(t / steps, t) - fine).norm());
  // The reference's own error is (1024/16384)² of the last.
  EXPECT_NEAR(std::log2(error[0] / error[1]), 2, 0.1);
  EXPECT_NEAR(std::log2(error[1] / error[2]), 2, 0.1);
}

/// Two clumps that are held together by linear springs along and across n, and tumble.
SceneBuilder tumbling_pair() {
  std::mt19937_64 random(31);
  SceneBuilder builder = touching_pair({.kn = 1, .ks = 0.5, .tension = true}, random);
  model::Clumps& clumps = builder.scene().bodies.clumps;
  const Vec3 spin(0.02, 0.03, 0.05);
  for (std::int32_t c = 0; c < 2; ++c) {
    clumps.angular_momentum[static_cast<std::size_t>(c)] = model::angular_momentum(clumps, c, spin);
    clumps.velocity[static_cast<std::size_t>(c)] = spin.cross(clumps.position[static_cast<std::size_t>(c)]);
  }
  clumps.velocity[1] += Vec3(0.01, -0.005, 0.008);
  return builder;
}

TEST(ClumpMotion, OfATumblingPairIsOfSecondOrder) {
  // Springs of shear are incremental: with displacements that were not those of the very step, or levers of
  // its end, the pair would be of first order.
  constexpr double t = 40;
  const auto end = [&](int steps) {
    cycle::Cycle cycle = cycle_of(tumbling_pair(), t / steps);
    cycle.run(steps);
    return positions_of(cycle.state());
  };
  const std::vector<Vec3> fine = end(32768);
  std::vector<double> error;
  for (const int steps : {512, 1024, 2048}) {
    const std::vector<Vec3> found = end(steps);
    double most = 0;
    for (std::size_t i = 0; i < found.size(); ++i) most = std::max(most, (found[i] - fine[i]).norm());
    error.push_back(most);
  }
  EXPECT_NEAR(std::log2(error[0] / error[1]), 2, 0.15) << error[1];
  EXPECT_NEAR(std::log2(error[1] / error[2]), 2, 0.15) << error[2];
}

Vec6 momentum_of(const assembly::State& state) {
  const model::Bodies& bodies = state.model.bodies;
  Vec6 sum = Vec6::Zero();
  const auto add = [&](double m, const Vec3& x, const Vec3& v, const Vec3& own) {
    sum.head<3>() += m * v;
    // x at t, v at t - dt/2: x × v is that of t - dt/2 with x - ½ dt v, which adds nothing.
    sum.tail<3>() += m * x.cross(v) + own;
  };
  for (std::size_t i = 0; i < bodies.position.size(); ++i)
    if (bodies.clumps.of(static_cast<std::int32_t>(i)) == model::Clumps::none)
      add(bodies.mass[i], bodies.position[i], bodies.velocity[i], bodies.inertia[i] * bodies.spin[i]);
  const model::Clumps& clumps = bodies.clumps;
  for (std::size_t c = 0; c < clumps.position.size(); ++c)
    add(clumps.mass[c], clumps.position[c], clumps.velocity[c], clumps.angular_momentum[c]);
  return sum;
}

TEST(ClumpMotion, KeepsBothMomentaToRounding) {
  // Friction, slip and impacts; forces on both sides act at one point, so nothing is lost but digits.
  SceneBuilder builder({.kn = 1e3, .ks = 500, .tension = false, .friction = 0.3});
  builder.ball({-0.5, -2.2, 0.4}, 0.8, 1.5).moving({0, 0.8, 0}, {1, 0, 0.5});
  builder.clump(dumbbell(), {.velocity = {0, 0, 0}, .spin = {0.2, 0.3, 0.5}});
  builder.clump(odd_shape(),
                {.position = {0.3, 2.6, 0.2}, .velocity = {0.1, -0.9, 0}, .spin = {0.3, 0.0, 2}});
  cycle::Cycle cycle = cycle_of(builder, 2e-3);
  cycle.step();
  const Vec6 before = momentum_of(cycle.state());
  cycle.run(20000);
  // They fly apart for 40 s: each step rounds positions of ten by some 1e-15.
  EXPECT_LT((momentum_of(cycle.state()) - before).norm(), 2e-10);
}

TEST(ClumpMotion, DampsRotationAlongThePrincipalAxes) {
  // A moment about one principal axis of a body at rest, and one that turns the other way: damped to
  // (1 - α) M and (1 + α) M whatever the orientation.
  std::mt19937_64 random(33);
  for (const double sign : {1.0, -1.0}) {
    const model::ClumpShape shape = given_shape({{0, 1, 0}, {0, -1, 0}}, {0.5, 0.5}, 2, {1, 2, 2.5});
    const Quat q = random_orientation(random);
    SceneBuilder builder({.kn = 1, .tension = true});
    // A fixed ball beside each end, overlapping by 0.01: the forces are along e_3 and against it.
    builder.ball(q * Vec3(0, 1, -0.99), 0.5, 1, fix_all);
    builder.ball(q * Vec3(0, -1, 0.99), 0.5, 1, fix_all);
    builder.clump(shape, {.orientation = q, .spin = q * Vec3(sign * 1e-9, 0, 0)});
    builder.damped(0.7);
    cycle::Cycle cycle = cycle_of(builder, 1e-6);
    cycle.step();
    const model::Clumps& clumps = cycle.state().model.bodies.clumps;
    const Vec3 own = clumps.orientation[0].conjugate() * clumps.angular_momentum[0];
    const double moment = 2 * 0.01;  // k U times the arms
    EXPECT_NEAR(own.x() - sign * 1e-9, 0.5e-6 * moment * (1 - sign * 0.7), 1e-15);
  }
}

TEST(ClumpMotion, DoesNotDependOnThreads) {
  std::mt19937_64 random(34);
  SceneBuilder builder({.kn = 1e3, .ks = 400, .tension = false, .friction = 0.5});
  for (int k = 0; k < 500; ++k) {
    const Vec3 at = 3 * Vec3(k % 8, (k / 8) % 8, k / 64) + 0.3 * random_vector(random);
    if (k % 3 == 0)
      builder.ball(at, 1, 1).moving(random_vector(random));
    else
      builder.clump(
          k % 2 == 0 ? dumbbell() : odd_shape(),
          {.position = at, .orientation = random_orientation(random), .velocity = random_vector(random)});
  }
  builder.damped(0.2).gravity({0, 0, -1}).plane({0, 0, -2}, {0, 0, 1});
  builder.periodic({24, 24, 40}, {true, true, false});
  const auto bits = [&](int threads) {
    const Threads wanted(threads);
    cycle::Cycle cycle = cycle_of(builder, 2e-3);
    cycle.run(60);
    return bits_of(cycle.state());
  };
  const std::string one = bits(1);
  EXPECT_TRUE(one == bits(2));
  EXPECT_TRUE(one == bits(3));
}

}  // namespace
}  // namespace eigengrain::test
