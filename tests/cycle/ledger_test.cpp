// The energy ledger: exact where the trapezoidal rule is, of second order elsewhere, the same to the bit on
// any number of threads and after a restart, and without influence on the motion.
#include "eigengrain/measures/ledger.hpp"

#include "eigengrain/base/parallel.hpp"
#include "eigengrain/cycle/policy.hpp"
#include "eigengrain/io/scene_reader.hpp"
#include "eigengrain/io/state_file.hpp"

#include "support/ledger.hpp"
#include "support/motion.hpp"
#include "unit/io_support.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>
#include <random>

namespace eigengrain::test {
namespace {

using assembly::State;
using cycle::Cycle;
using measures::Ledger;
using measures::ledger_of;

/// Balls in a row on springs that also pull, thrown about along it: linear to rounding.
SceneBuilder row(double damping) {
  SceneBuilder builder{Springs{}};
  std::mt19937_64 random(7);
  std::uniform_real_distribution<double> uniform(-1, 1);
  for (int i = 0; i < 5; ++i)
    builder.ball({(2 * i - 4) * (1 - 1e-12), 0, 0}).moving({1e-2 * uniform(random), 0, 0});
  return builder.plane({-5 + 1e-11, 0, 0}, {1, 0, 0}).damped(damping);
}

/// Worst change of the balance error after the first step, in which the step grows from nothing, over the
/// energy that the scene begins with.
double worst_error(Cycle& cycle, int steps) {
  cycle.step();
  const double begin = ledger_of(cycle.state()).balance_error;
  double worst = 0;
  for (int k = 0; k < steps; ++k) {
    cycle.step();
    worst = std::max(worst, std::abs(ledger_of(cycle.state()).balance_error - begin));
  }
  return worst / cycle.state().ledger->initial;
}

// An ulp of x (1e-15 at most) against an amplitude of 1e-2 is 1e-13 of the energy a step, at random: some
// 1e-12 after 10^3 steps, five times that for the worst.
constexpr double rounding_of_a_row = 1e-11;

TEST(Ledger, ClosesExactlyInALinearSystem) {
  Cycle cycle = cycle_with_ledger(row(0), 0.7);
  EXPECT_LT(worst_error(cycle, 1000), rounding_of_a_row);
}

TEST(Ledger, ClosesExactlyWithLocalDamping) {
  Cycle cycle = cycle_with_ledger(row(0.3), 0.7);
  EXPECT_LT(worst_error(cycle, 1000), rounding_of_a_row);
  const Ledger end = ledger_of(cycle.state());
  // All of it was taken by the damping.
  EXPECT_LT(end.kinetic + end.elastic.normal, 1e-3 * cycle.state().ledger->initial);
  EXPECT_NEAR(end.integrals.damping, cycle.state().ledger->initial, 1e-2 * cycle.state().ledger->initial);
  EXPECT_EQ(end.integrals.contacts.slip, 0);
}

// A ball that is moved at a given velocity pulls another one along, through a spring, against gravity.
TEST(Ledger, ClosesExactlyWithPrescribedVelocitiesAndGravity) {
  constexpr double speed = 1e-2;
  SceneBuilder builder{Springs{}};
  builder.ball({0, 0, 0}, 1, 1, fix_all).moving({speed, 0, 0});
  builder.ball({-2 * (1 - 1e-12), 0, 0}, 1, 1).gravity({-1e-3, 0, 0});
  Cycle cycle = cycle_with_ledger(builder, 0.3);
  cycle.step();
  const double begin = ledger_of(cycle.state()).balance_error;
  cycle.run(200);
  const Ledger ledger = ledger_of(cycle.state());
  const double way = speed * 0.3 * 201;
  EXPECT_NEAR(ledger.balance_error, begin, 1e-14);
  // Gravity works on both; of the moved one its work is taken out again.
  const double fell = position_of(cycle.state(), 1).x() + 2;
  EXPECT_NEAR(ledger.integrals.gravity, -1e-3 * (way + fell), 1e-14);
  EXPECT_NEAR(ledger.gravitational, 1e-3 * (way + fell - 2), 1e-14);
  // It lifts both, and the other one swings by some v/ω = 1e-2 about its place.
  EXPECT_NEAR(ledger.integrals.prescribed, 2e-3 * way, 2e-2 * speed + 1e-3 * 1e-2);
}

// Where the step changes at t the kinetic energy ½m(v² - ¼Δt²a²) does: by -⅛ m a² (Δt_new² - Δt_old²).
TEST(Ledger, ErrsBySecondOrderWhereTheStepChanges) {
  SceneBuilder builder{Springs{}};
  builder.ball({1 - 1e-12, 0, 0}).moving({1e-2, 0, 0}).plane(Vec3::Zero(), {1, 0, 0});
  State state = with_ledger(cycle::start(builder.scene()));
  Cycle cycle(std::move(state), {[](const State& s) { return s.step < 10 ? 0.2 : 0.5; }, 1});
  cycle.run(10);
  const double before = ledger_of(cycle.state()).balance_error;
  const double a = position_of(cycle.state(), 0).x() - 1;  // k = m = 1
  cycle.run(50);
  EXPECT_GT(std::abs(a), 1e-3);
  EXPECT_NEAR(ledger_of(cycle.state()).balance_error - before, -a * a / 8 * (0.25 - 0.04), 1e-15);
}

TEST(Ledger, MayBeginAtAnyTime) {
  Cycle cycle = cycle_of(row(0.1), 0.7);
  cycle.run(17);
  State state = with_ledger(cycle.release());
  EXPECT_EQ(ledger_of(state).balance_error, 0);
  EXPECT_EQ(ledger_of(state).integrals.damping, 0);
  Cycle later(std::move(state), fixed_step(0.7));
  later.run(20);
  EXPECT_LT(std::abs(ledger_of(later.state()).balance_error),
            rounding_of_a_row * later.state().ledger->initial);
}

/// A ball that lies on a floor and is set sliding: k = 100, m = 1, g = 1, μ = 0.5.
SceneBuilder sliding_ball(double speed, model::FixedComponents fixed) {
  SceneBuilder builder({.kn = 100, .ks = 50, .tension = false});
  return builder.ball({0, 0, 1 - 0.01}, 1, 1, fixed)
      .moving({speed, 0, 0})
      .plane(Vec3::Zero(), Vec3::UnitZ())
      .gravity({0, 0, -1});
}

// Normal force and direction stay as they are: exact. It comes to rest after v²/2μg and swings a little on
// its shear spring, which holds at most ½(μmg)²/k_s.
TEST(Ledger, FrictionTakesWhatASlidingBallHad) {
  Cycle cycle = cycle_with_ledger(sliding_ball(0.5, fix_rotations), 0.01);
  EXPECT_LT(worst_error(cycle, 300), 1e-13);
  const Ledger end = ledger_of(cycle.state());
  const double spring = 0.5 * 0.25 / 50;
  EXPECT_NEAR(end.integrals.contacts.slip, 0.125, 1.01 * spring);
  EXPECT_LT(end.integrals.contacts.slip, 0.125);
  EXPECT_GT(end.elastic.shear + end.kinetic, 0.5 * spring);  // nothing else takes energy
  EXPECT_NEAR(end.elastic.normal, 0.5 * 100 * 1e-4, 1e-12);
}

// Free to turn it rolls in the end with 5/7 of its speed and 5/7 of its energy.
TEST(Ledger, FrictionTakesTwoSeventhsFromABallThatComesToRoll) {
  Cycle cycle = cycle_with_ledger(sliding_ball(0.5, {}), 0.002);
  cycle.run(1000);
  const Ledger end = ledger_of(cycle.state());
  // Up to what the shear spring holds.
  EXPECT_NEAR(end.integrals.contacts.slip, 0.125 * 2 / 7, 0.5 * 0.25 / 50);
  EXPECT_NEAR(end.balance_error, 0, 1e-4 * 0.125);
}

// When a contact opens with shear in it, that energy is lost by slip.
TEST(Ledger, AContactThatOpensLosesItsShearEnergy) {
  SceneBuilder builder({.kn = 100, .ks = 50, .tension = false});
  builder.ball({0, 0, 0.99}, 1, 1, fix_all).moving({0.02, 0, 0.5}).plane(Vec3::Zero(), Vec3::UnitZ());
  Cycle cycle = cycle_with_ledger(builder, 0.015);
  cycle.step();
  const double stored = ledger_of(cycle.state()).elastic.shear;
  EXPECT_GT(stored, 0);
  cycle.run(3);
  const Ledger end = ledger_of(cycle.state());
  EXPECT_EQ(end.elastic.shear, 0);
  EXPECT_EQ(end.elastic.normal, 0);
  EXPECT_GT(end.integrals.contacts.slip, 0.5 * stored);
}

/// Balance error at t = 20 of a cluster that swings and turns at finite amplitude, over its energy.
double error_of_a_cluster(double dt) {
  std::mt19937_64 random(8);
  SceneBuilder cluster = random_cluster(random, 5, {.kn = 1, .ks = 0.5}, 1.3);
  for (int i = 0; i < 5; ++i) {
    cluster.scene().bodies.velocity.push_back(0.02 * random_vector(random));
    cluster.scene().bodies.spin.push_back(0.02 * random_vector(random));
  }
  Cycle cycle = cycle_with_ledger(cluster, dt);
  cycle.run(std::lround(20 / dt));
  return ledger_of(cycle.state()).balance_error / cycle.state().ledger->initial;
}

TEST(Ledger, IsOfSecondOrderWhereMotionsAreFinite) {
  const double coarse = error_of_a_cluster(0.1);
  const double fine = error_of_a_cluster(0.05);
  const double finest = error_of_a_cluster(0.025);
  std::printf("cluster: %.2e, %.2e, %.2e; orders %.2f and %.2f\n", coarse, fine, finest,
              std::log2(std::abs(coarse / fine)), std::log2(std::abs(fine / finest)));
  EXPECT_LT(std::abs(coarse), 1e-2);
  EXPECT_NEAR(std::log2(std::abs(coarse / fine)), 2, 0.2);
  EXPECT_NEAR(std::log2(std::abs(fine / finest)), 2, 0.1);
}

/// Balls that fall onto a floor between walls, roll, slip and are damped; one is moved.
SceneBuilder settling_balls(int across, int high) {
  std::mt19937_64 random(21);
  SceneBuilder builder({.kn = 1, .ks = 0.5, .tension = false});
  for (int k = 0; k < high; ++k)
    for (int j = 0; j < across; ++j)
      for (int i = 0; i < across; ++i)
        builder.ball(2.15 * Vec3(i + 0.5, j + 0.5, k + 0.5) + 0.04 * random_vector(random), 0.95)
            .moving(0.03 * random_vector(random), 0.02 * random_vector(random));
  builder.scene().bodies.fixed[static_cast<std::size_t>(across * across * high / 2)] = fix_all;
  const double edge = 2.15 * across;
  builder.plane(Vec3::Zero(), Vec3::UnitZ()).plane(Vec3::Zero(), Vec3::UnitY());
  return builder.plane(Vec3(0, edge, 0), -Vec3::UnitY())
      .periodic(Vec3::Constant(edge), {true, false, false})
      .gravity({0, 0, -1e-3})
      .damped(0.1);
}

TEST(Ledger, IsTheSameToTheBitOnAnyNumberOfThreadsAndChangesNothing) {
  const int before = threads();
  const auto run = [](int count, bool ledger) {
    set_threads(count);
    State state = cycle::start(settling_balls(10, 11).scene());  // more than one chunk of bodies
    if (ledger) measures::begin_ledger(state);
    Cycle cycle(std::move(state), fixed_step(0.3));
    cycle.run(80);
    return cycle.release();
  };
  const State without = run(2, false);
  const State one = run(1, true);
  EXPECT_FALSE(without.ledger.has_value());
  const Ledger ledger = ledger_of(one);
  EXPECT_GT(ledger.integrals.contacts.slip, 0);
  EXPECT_GT(ledger.integrals.damping, 0);
  EXPECT_NE(ledger.integrals.prescribed, 0);
  for (const int count : {2, 3}) {
    const State many = run(count, true);
    EXPECT_TRUE(same_bits(ledger, ledger_of(many))) << count << " threads";
  }
  set_threads(before);
  EXPECT_EQ(without.model.bodies.position, one.model.bodies.position);
  EXPECT_EQ(without.model.bodies.spin, one.model.bodies.spin);
  EXPECT_EQ(without.force, one.force);
}

// Impacts, slips and openings are kinks of the force; each errs by some Δt² of its own sign.
TEST(Ledger, OfASettlingBedClosesTheBetterTheSmallerTheStep) {
  double last = 0;
  for (const double dt : {0.4, 0.1}) {
    Cycle cycle = cycle_with_ledger(settling_balls(6, 8), dt);
    cycle.run(std::lround(200 / dt));
    const Ledger ledger = ledger_of(cycle.state());
    const double turned_over = cycle.state().ledger->initial + ledger.integrals.gravity;
    const double error = std::abs(ledger.balance_error) / turned_over;
    std::printf("bed, step %.1f: gravity %.4f, slip %.4f, damping %.4f, moved %.4f, error %.1e of %.4f J\n",
                dt, ledger.integrals.gravity, ledger.integrals.contacts.slip, ledger.integrals.damping,
                ledger.integrals.prescribed, error, turned_over);
    EXPECT_LT(error, 0.1 * dt * dt);
    if (last > 0) {
      EXPECT_LT(error, 0.25 * last);
    }
    last = error;
  }
}

TEST(Ledger, GoesOnToTheBitAfterARestart) {
  const std::string scene =
      "gravity: [0, 0, -9.81]\n"
      "materials: [{name: glass, density: 2500}]\n"
      "contacts: [{between: [glass, glass], law: linear, kn: 2e4, ks: 1e4, friction: 0.5}]\n"
      "balls:\n"
      "  - {position: [0, 0, 5 mm], radius: 5 mm, material: glass, velocity: [0.2, 0, 0]}\n"
      "  - {position: [0, 1 mm, 15 mm], radius: 5 mm, material: glass}\n"
      "  - {position: [0, 1 mm, 26 mm], radius: 5 mm, material: glass, fix: [z], velocity: [0, 0, -0.1]}\n"
      "walls: [{plane: {point: [0, 0, 0], normal: [0, 0, 1]}, material: glass}]\n";
  const io::TemporaryFolder folder;
  const auto file = folder.path() / "state.h5";
  Cycle whole(with_ledger(cycle::start(io::read_scene_text(scene, "."))), fixed_step(1e-5));
  whole.run(150);
  io::write_state(whole.state(), file);
  whole.run(150);
  State read = io::read_state(file);
  ASSERT_TRUE(read.ledger.has_value());
  Cycle rest(std::move(read), fixed_step(1e-5));
  rest.run(150);
  const Ledger ledger = ledger_of(whole.state());
  EXPECT_GT(ledger.integrals.contacts.slip, 0);
  EXPECT_GT(ledger.integrals.damping, 0);
  EXPECT_NE(ledger.integrals.prescribed, 0);
  EXPECT_TRUE(same_bits(ledger, ledger_of(rest.state())));
}

}  // namespace
}  // namespace eigengrain::test
