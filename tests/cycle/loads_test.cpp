// Forces and moments applied to bodies: closed forms of the motion, equilibrium, energy, threads and restart.
#include "eigengrain/assembly/balance.hpp"
#include "eigengrain/assembly/energies.hpp"
#include "eigengrain/cycle/watch.hpp"

#include "support/clumps.hpp"
#include "support/ledger.hpp"
#include "support/restart.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace eigengrain::test {
namespace {

using cycle::Cycle;

constexpr double ulp = std::numeric_limits<double>::epsilon();

// Leapfrog that starts with half a step has the parabola exactly; n sums of a step each round by ulp/2 at
// most of the largest value, once in the velocity (which then counts n times in the place) and once in the
// place.
TEST(Loads, AConstantForceMakesAParabola) {
  constexpr double dt = 0.125;
  constexpr int steps = 400;
  const Vec3 force(0.3, -0.7, 2);
  constexpr double mass = 4;
  SceneBuilder builder;
  builder.ball({1, 2, 3}, 1, mass).loaded(force).moving({0.5, 0, -1});
  Cycle cycle = cycle_of(builder, dt);
  cycle.run(steps);
  const double t = dt * steps;
  const Vec3 expected = Vec3(1, 2, 3) + t * Vec3(0.5, 0, -1) + 0.5 * t * t / mass * force;
  const Vec3 way = position_of(cycle.state(), 0) - expected;
  EXPECT_LT(way.norm(), 2 * steps * ulp * expected.norm());
}

TEST(Loads, AMomentMakesABallTurn) {
  constexpr double dt = 0.125;
  constexpr int steps = 400;
  SceneBuilder builder;  // without friction: nothing else turns here
  builder.ball({0, 0, 0}, 2, 5).loaded(Vec3::Zero(), {0, 0.3, -0.1});
  Cycle cycle = cycle_of(builder, dt);
  cycle.run(steps);
  const Vec3 expected = dt * (steps - 0.5) / (0.4 * 5 * 4) * Vec3(0, 0.3, -0.1);  // at t - dt/2
  EXPECT_LT((spin_of(cycle.state(), 0) - expected).norm(), steps * ulp * expected.norm());
  EXPECT_EQ(position_of(cycle.state(), 0), Vec3::Zero());
}

// About a principal axis the angular momentum and the spin stay along it: θ = M t²/2I exactly.
TEST(Loads, AMomentTurnsAClumpAboutAPrincipalAxis) {
  constexpr double dt = 0.125;
  constexpr int steps = 160;
  for (int axis = 0; axis < 3; ++axis) {
    const model::ClumpShape shape = odd_shape();
    const double moment = 1e-2 * shape.inertia[axis];
    SceneBuilder builder;
    builder.clump(shape, {.force = {shape.mass, 0, 0}, .moment = moment * Vec3::Unit(axis)});
    Cycle cycle = cycle_of(builder, dt);
    cycle.run(steps);
    const double t = dt * steps;
    const model::Clumps& clumps = cycle.state().model.bodies.clumps;
    const Eigen::AngleAxisd turn(clumps.orientation[0]);
    const double expected = 0.5 * moment / shape.inertia[axis] * t * t;
    ASSERT_LT(expected, 3.1);  // not turned about more than once
    // Each step composes two rotations, of some ulps each.
    EXPECT_NEAR(turn.angle() * turn.axis()[axis], expected, 10 * steps * ulp) << axis;
    EXPECT_NEAR(clumps.position[0].x(), 0.5 * t * t, 2 * steps * ulp * t * t) << axis;
  }
}

TEST(Loads, ASortKeepsThemWithTheirBodies) {
  std::mt19937_64 random(3);
  SceneBuilder builder = random_cluster(random, 20, {});
  for (int i = 0; i < 20; ++i) {
    builder.scene().bodies.applied_force.emplace_back(i, 0, 0);
    builder.scene().bodies.damping.push_back(0.01 * i);
  }
  const model::Bodies bodies = builder.build().bodies;
  for (std::size_t row = 0; row < 20; ++row) {
    EXPECT_EQ(bodies.applied_force[row].x(), static_cast<double>(bodies.identity[row]));
    EXPECT_EQ(bodies.damping[row], 0.01 * static_cast<double>(bodies.identity[row]));
  }
}

/// A ball that is pulled onto a wall, and another that is pushed onto it.
SceneBuilder pulled() {
  SceneBuilder builder({.kn = 100, .ks = 50, .tension = false});
  builder.ball({0, 0, 1 - 1e-3}).loaded({0, 0, -3}, {0.1, 0, 0});
  builder.ball({0, 0, 3 - 3e-3}).loaded({0, 0, -1});
  return builder.plane(Vec3::Zero(), Vec3::UnitZ()).damped(0.7);
}

// Overlaps are (3 + 1)/100 and 1/100. The moment is held by friction, between the ball at the floor and both
// its contacts: the upper ball may turn with it, and does not rest before it does.
TEST(Loads, ABallPulledOntoAWallComesToRest) {
  SceneBuilder builder = pulled();
  builder.scene().bodies.applied_moment.clear();
  Cycle cycle = cycle_of(builder, 0.05);
  cycle.run(4000);
  EXPECT_NEAR(position_of(cycle.state(), 0).z(), 1 - 0.04, 1e-12);
  EXPECT_NEAR(position_of(cycle.state(), 1).z(), 3 - 0.05, 1e-12);
  const assembly::Balance balance = assembly::balance_of(cycle.state());
  EXPECT_LT(balance.max, 1e-11);
  EXPECT_EQ(balance.unsupported, 0);
}

TEST(Loads, AreUnsupportedWhereNothingTouches) {
  SceneBuilder builder;
  builder.ball({0, 0, 0}).loaded({1, 0, 0});
  builder.ball({9, 0, 0}).loaded(Vec3::Zero(), {0, 1, 0});
  builder.ball({18, 0, 0}, 1, 1, model::FixedComponents(1)).loaded({1, 0, 0});  // held against it
  builder.ball({27, 0, 0});
  EXPECT_EQ(assembly::balance_of(cycle::start(builder.scene())).unsupported, 2);
}

TEST(Loads, LocalDampingOpposesThemToo) {
  SceneBuilder builder;
  builder.ball({0, 0, 0}).loaded({1, 0, 0}).damped(0.5);
  Cycle cycle = cycle_of(builder, 0.25);
  cycle.run(3);
  // The first half step is undamped, as nothing moves yet.
  EXPECT_EQ(velocity_of(cycle.state(), 0).x(), 0.125 + 2 * 0.25 * 0.5);
}

// In a linear system the trapezoidal rule is exact, and a constant load is linear; spins are counted as well.
TEST(Loads, TheLedgerClosesWithThem) {
  SceneBuilder builder({.kn = 1, .ks = 0.5});
  for (int i = 0; i < 4; ++i) builder.ball({2 * i * (1 - 1e-12), 0, 0}).loaded({1e-3 * (i - 1), 0, 0});
  builder.ball({100, 0, 0}).loaded({0, 1e-3, 0}, {0, 0, 1e-3});
  Cycle cycle = cycle_with_ledger(builder.damped(0.2), 0.5);
  cycle.step();
  const double begin = measures::ledger_of(cycle.state()).balance_error;
  cycle.run(500);
  const measures::Ledger end = measures::ledger_of(cycle.state());
  EXPECT_GT(end.integrals.applied, 1e-3);
  EXPECT_NEAR(end.balance_error, begin, 1e-12 * end.integrals.applied);
  // The one that flies: force times way, moment times angle, at (1 - α) of the acceleration.
  SceneBuilder free;
  free.ball({0, 0, 0}).loaded({0, 1e-3, 0}, {0, 0, 1e-3});
  Cycle flight = cycle_with_ledger(free, 0.5);
  flight.run(100);
  const double t = 50;
  EXPECT_NEAR(measures::ledger_of(flight.state()).integrals.applied, 0.5e-6 * t * t + 0.5e-6 * t * t / 0.4,
              1e-15);
}

TEST(Loads, TheWatchKnowsThatTheyBringEnergy) {
  SceneBuilder builder;
  builder.ball({0, 0, 0}).loaded({1, 0, 0}).moving({1e-6, 0, 0});
  Cycle cycle = cycle_of(builder, 1e-3);
  cycle::Watch watch(cycle.state());
  cycle.run(1000);
  EXPECT_FALSE(watch.look(cycle.state()).has_value());
}

const char* const scene_text = R"(
gravity: [0, 0, -9.81]
materials: [{name: grain, density: 2500}]
contacts: [{between: [any, any], law: linear, kn: 1e4, ks: 5e3, friction: 0.4}]
balls:
  - {position: [0, 0, 0.006], radius: 5 mm, material: grain, force: [1 mN, 0, 0], moment: [0, 1e-6, 0], damping: 0.2}
  - {position: [0.001, 0, 0.017], radius: 5 mm, material: grain}
  - {position: [0.002, 0, 0.028], radius: 5 mm, material: grain, damping: 0}
clumps:
  - balls: [{at: [0, 0, 0], radius: 5 mm}, {at: [6 mm, 0, 0], radius: 4 mm}]
    material: grain
    damping: 0.3
    instances: [{position: [0.02, 0.02, 0.01], force: [0, -1 mN, 0], moment: [1e-6, 0, 0]}, {position: [0.02, 0.02, 0.03]}]
walls: [{plane: {point: [0, 0, 0], normal: [0, 0, 1]}, material: grain}]
damping: {local: 0.5}
timestep: {policy: bound}
)";

TEST(Loads, ARestartGoesOnToTheBit) {
  expect_to_continue(io::read_scene_text(scene_text, ".", "loads.yaml"), 800, {0, 1, 300});
}

TEST(Loads, ThreadsDoNotMatter) {
  const model::Scene scene = io::read_scene_text(scene_text, ".", "loads.yaml");
  const auto run = [&](int threads) {
    const Threads with(threads);
    Cycle cycle(cycle::start(scene), cycle::policy_of(scene));
    cycle.run(500);
    return bits_of(cycle.state());
  };
  EXPECT_EQ(run(1), run(3));
}

TEST(OwnDamping, StandsInTheBodiesAsAsked) {
  const model::Bodies bodies = io::read_scene_text(scene_text, ".", "loads.yaml").bodies;
  constexpr double of_scene = model::Bodies::scene_damping;
  EXPECT_EQ(bodies.damping, (std::vector<double>{0.2, of_scene, 0, 0.3, 0.3, 0.3, 0.3}));
  EXPECT_EQ(bodies.applied_force[3], Vec3(0, -1e-3, 0));
  EXPECT_EQ(bodies.applied_force[4], Vec3::Zero());  // of the clump's holder alone
}

}  // namespace
}  // namespace eigengrain::test
