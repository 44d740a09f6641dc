// Walls that move: what they drag, carry and hit, against closed forms; restart and threads to the bit.
#include "eigengrain/cycle/policy.hpp"
#include "eigengrain/io/scene_reader.hpp"
#include "eigengrain/io/state_file.hpp"

#include "support/bits.hpp"
#include "support/motion.hpp"
#include "support/restart.hpp"
#include "unit/io_support.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <numbers>

namespace eigengrain::test {
namespace {

using assembly::State;
using cycle::Cycle;

constexpr double pi = std::numbers::pi;

// Seen from a floor that moves with V, a ball at rest slides with -V until it rolls with -5V/7, after
// 2V/(7 μ g) (friction_test): seen from outside it ends with 2V/7.
TEST(MovingWall, DragsABallUntilItRolls) {
  constexpr double g = 0x1p-20;
  constexpr double mu = 0.25;
  constexpr double V = 1e-3;
  constexpr double dt = 0.25;
  SceneBuilder builder({.kn = 1, .ks = 0.5, .tension = false, .friction = mu});
  builder.ball({0, 0, 1 - g}).plane({0, 0, 0}, {0, 0, 1}).carried({V, 0, 0}).gravity({0, 0, -g});
  Cycle cycle = cycle_of(builder, dt);
  cycle.run(100);
  while (std::abs(cycle.state().force[0].x()) > (1 - 1e-9) * mu * g) cycle.step();
  EXPECT_NEAR(cycle.state().time, 2 * V / (7 * mu * g), 4 * dt);
  const auto [u, surface] = mean_motion(cycle, 4000);
  // The shear spring goes on swinging: less than 1e-2 of 2e-7 in the means.
  EXPECT_NEAR(u, 2 * V / 7, 1e-5 * V);
  EXPECT_NEAR(surface, V, 1e-5 * V);
}

// A sphere that rolls on a turntable runs in a circle with 2/7 of its angular velocity.
TEST(MovingWall, ATurntableCarriesARollingBallRoundAtTwoSevenths) {
  constexpr double g = 0x1p-20;
  constexpr double turn = 5e-4;
  constexpr double orbit = 2 * turn / 7;
  constexpr double radius = 10;
  SceneBuilder builder({.kn = 1, .ks = 0.5, .tension = false, .friction = 0.9});
  builder.ball({radius, 0, 1 - g}).moving({0, orbit * radius, 0}, {5 * turn * radius / 7, 0, 0});
  builder.plane({0, 0, 0}, {0, 0, 1}).carried(Vec3::Zero(), {0, 0, turn}).gravity({0, 0, -g});
  constexpr int steps = 40000;
  constexpr double dt = 2 * pi / orbit / steps;
  Cycle cycle = cycle_of(builder, dt);
  for (int quarter = 1; quarter <= 4; ++quarter) {
    cycle.run(steps / 4);
    const double angle = 0.5 * pi * quarter;
    const Vec3 expected(radius * std::cos(angle), radius * std::sin(angle), 1 - g);
    // The centripetal force m orbit² radius = 2e-7 swings in its spring of 0.5 as nothing damps it, which
    // makes a velocity of 3e-7 beside 1.4e-3, and the ball rolls on a lever R - U/2 (U = 1e-6).
    EXPECT_LT((position_of(cycle.state(), 0) - expected).norm(), 1e-3 * radius) << quarter;
  }
}

// A ball on a wall that turns with it like one rigid body: nothing moves at the contact. With the geometry of
// the middle of the step an increment errs by θ³ of the lever, with that of its end by θ².
TEST(MovingWall, TurnsWithABallWithoutSpuriousShear) {
  SceneBuilder builder({.kn = 1, .ks = 1, .tension = true});
  const Vec3 centre(3, -1, 0.5);
  const Vec3 axis = Vec3(1, 2, -0.5).normalized();
  const Vec3 start(0, 0, 0.9);
  builder.ball(start).plane({0, 0, 0}, {0, 0, 1}).carried({0.1, 0, 0}, axis, centre);
  State state = cycle::start(builder.scene());
  assembly::ContactForceSum forces(state.model, true);
  assembly::WallStep walls(state.model);
  constexpr int steps = 1000;
  constexpr double dt = 2 * pi / steps;
  assembly::BodyForces sum;
  for (int k = 1; k <= steps; ++k) {
    walls.move(state, dt);
    const Vec3 x = Eigen::AngleAxisd(k * dt, axis) * (start - centre) + centre + Vec3(0.1 * k * dt, 0, 0);
    const std::vector<Vec3> velocity{(x - state.model.bodies.position[0]) / dt};
    const std::vector<Vec3> spin{axis};
    state.model.bodies.position[0] = x;
    forces.advance(state.model,
                   {.position = state.model.bodies.position,
                    .velocity = velocity,
                    .spin = spin,
                    .duration = dt,
                    .per_second = 1 / dt,
                    .walls = &walls},
                   sum);
    state.time += dt;
  }
  const std::vector<Vec3> shears = shears_of(state);
  ASSERT_EQ(shears.size(), 1U);
  // A rigid turn by θ errs by θ³/12 of the lever (docs/theory.md), here 3.2: at most 7e-5 in the 1000 steps;
  // θ² would make 6e-2.
  EXPECT_LT(shears[0].norm(), 7e-5);
  EXPECT_NEAR(sum.force[0].norm(), 0.1, 1e-8);  // and the overlap is what it was
}

TEST(MovingWall, FollowsItsTable) {
  SceneBuilder builder;
  builder.ball({0, 0, 50}).plane({0, 0, 0}, {0, 0, 1}).carried(Vec3::Zero());
  builder.scene().wall_motions[0].time = {1, 3, 4};
  builder.scene().wall_motions[0].velocity = {{}, {Vec3(0, 0, 2), Vec3::Zero()}, {}};
  Cycle cycle = cycle_of(builder, 0.125);
  cycle.run(64);
  // The area under the triangle. Kinks stand at steps, so the middle of a step gives it exactly; all numbers
  // here are sums of powers of two.
  EXPECT_EQ(cycle.state().model.walls[0].point, Vec3(0, 0, 3));
  EXPECT_EQ(cycle.state().model.wall_poses[0].centre, Vec3(0, 0, 3));
}

// A heavy wall gives a ball at rest twice its own speed.
TEST(MovingWall, HitsABallThatWasFarAway) {
  constexpr double V = 1e-3;
  constexpr double dt = 0.01;
  SceneBuilder builder({.kn = 1, .ks = 0, .tension = false});
  builder.ball({0, 0, 1.2}).plane({0, 0, 0}, {0, 0, 1}).carried({0, 0, V});
  Cycle cycle = cycle_of(builder, dt);
  cycle.run(static_cast<std::int64_t>((0.2 / V + 4) / dt));
  EXPECT_GT(cycle.state().list.rebuilds, 5);  // 0.2 is eight half skins of 0.05 R
  // An impact errs by ¼Δt² where contact begins within a step (energy_test).
  EXPECT_NEAR(velocity_of(cycle.state(), 0).z(), 2 * V, 1e-4 * V);
}

/// A wall that sweeps round like a door into balls in a closed box.
SceneBuilder stirred_balls() {
  SceneBuilder builder({.kn = 1, .ks = 0.5, .tension = false});
  std::mt19937_64 random(3);
  for (int k = 0; k < 6; ++k)
    for (int j = 0; j < 6; ++j)
      for (int i = 0; i < 6; ++i)
        builder.ball(Vec3(2.2 * i + 1.2, 2.2 * j + 1.2, 2.2 * k + 1.2) + 0.03 * random_vector(random))
            .moving(0.01 * random_vector(random));
  builder.plane({0, 0, 0}, {0, 0, 1}).plane({0, 0, 0}, {0, 1, 0}).plane({14, 14, 14}, {-1, 0, 0});
  builder.plane({14, 14, 14}, {0, -1, 0}).gravity({0, 0, -1e-4}).damped(0.1);
  return builder.plane({0, 0, 0}, {1, 0, 0}).carried({1e-3, 0, 0}, {0, 1e-3, 0}, {0, 0, 0});
}

TEST(MovingWall, IsTheSameOnAnyNumberOfThreads) {
  const auto run = [](int count) {
    const Threads threads(count);
    Cycle cycle = cycle_of(stirred_balls(), 0.3);
    cycle.run(500);
    EXPECT_GT(cycle.state().list.rebuilds, 5);
    return bits_of(cycle.state());
  };
  const std::string one = run(1);
  EXPECT_EQ(one, run(2));
  EXPECT_EQ(one, run(4));
}

// Pairs that do not touch add nothing to a sum in the order of the pairs: whenever they are listed, the same
// motion to the bit, if no list comes too late.
TEST(MovingWall, IsListedBeforeItTouches) {
  const auto run = [](double part) {
    State state = cycle::start(stirred_balls().scene());
    state.list.skin *= part;
    Cycle cycle(std::move(state), fixed_step(0.3));
    cycle.run(500);
    return cycle.release();
  };
  const State seldom = run(1);
  const State often = run(0.1);
  EXPECT_GT(often.list.rebuilds, 2 * seldom.list.rebuilds);
  EXPECT_EQ(std::memcmp(seldom.model.bodies.position.data(), often.model.bodies.position.data(),
                        seldom.model.bodies.position.size() * sizeof(Vec3)),
            0);
}

constexpr std::string_view turning_scene = R"(
gravity: [0, 0, -9.81]
materials: [{name: grain, density: 2500}]
contacts: [{between: [any, any], law: linear, kn: 1e5, ks: 5e4, friction: 0.4}]
balls:
  - {position: [0.011, 0.012, 0.006], radius: 5 mm, material: grain}
  - {position: [0.022, 0.012, 0.006], radius: 5 mm, material: grain}
  - {position: [0.016, 0.021, 0.007], radius: 5 mm, material: grain}
walls:
  - {plane: {point: [0, 0, 0.001], normal: [0, 0, 1]}, material: grain, spin: [0, 0.2, 1]}
  - {plane: {point: [0, 0, 0], normal: [1, 0, 0]}, material: grain, motion_file: push.csv}
  - {plane: {point: [0, 0, 0], normal: [0, 1, 0]}, material: grain}
timestep: {policy: fixed, dt: 10 us}
)";

TEST(MovingWall, ContinuesFromAStateFileToTheBit) {
  const io::TemporaryFolder folder;
  folder.write("push.csv", "0 0 0 0\n0.005 0.5 0 0 0 0 1\n0.02 -0.2 0 0 0 0 0\n");
  const model::Scene scene = io::read_scene_text(turning_scene, folder.path());
  expect_to_continue(scene, 2000, {1, 777});
}

TEST(MovingWall, OfAStateMayBeStoppedAndOthersMayBegin) {
  const io::TemporaryFolder folder;
  folder.write("push.csv", "0 0 0 0\n0.005 0.5 0 0 0 0 1\n");
  const model::Scene scene = io::read_scene_text(turning_scene, folder.path());
  Cycle cycle(cycle::start(scene), cycle::policy_of(scene));
  cycle.run(500);
  const auto file = folder.path() / "results.h5";
  io::write_state(cycle.state(), file);
  const std::vector<std::string> stop{"walls.0.spin=[0, 0, 0]", "walls.2.velocity=[0, 1, 0]"};
  Cycle stopped(io::read_state(file, stop), cycle::policy_of(scene));
  const model::Plane floor = stopped.state().model.walls[0];
  EXPECT_EQ(floor.normal, cycle.state().model.walls[0].normal);
  stopped.run(100);
  EXPECT_EQ(stopped.state().model.walls[0].normal, floor.normal);
  EXPECT_NEAR(stopped.state().model.walls[2].point.y(), 100 * 1e-5, 1e-15);
  // A wall that has moved cannot be put back by leaving its motion out.
  const std::vector<std::string> gone{
      "walls.0={plane: {point: [0, 0, 0.001], normal: [0, 0, 1]}, material: grain}"};
  try {
    io::read_state(file, gone);
    ADD_FAILURE() << "not refused";
  } catch (const InputError& error) {
    EXPECT_NE(std::string(error.what()).find("wall number 1 has moved since the start"), std::string::npos)
        << error.what();
  }
}

}  // namespace
}  // namespace eigengrain::test
