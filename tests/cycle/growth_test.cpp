// Radii that change in time: forces, masses, energy, lists, threads and restart.
#include "eigengrain/assembly/balance.hpp"
#include "eigengrain/measures/measure.hpp"

#include "support/ledger.hpp"
#include "support/restart.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <cstdio>
#include <limits>
#include <numbers>

namespace eigengrain::test {
namespace {

using cycle::Cycle;

constexpr double ulp = std::numeric_limits<double>::epsilon();

/// Ball of radius one between two walls that it touches; k = 100.
SceneBuilder between_walls() {
  SceneBuilder builder({.kn = 100, .tension = false});
  builder.ball({0, 0, 1}).growing(1.1, 4, 1);
  return builder.plane({0, 0, 0}, Vec3::UnitZ()).plane({0, 0, 2}, -Vec3::UnitZ());
}

// U = 1.1 - 1 at both walls: F = 10, E = 2 · ½ 100 · 0.01; by symmetry it never moves. The ramp is over at t
// = 5.
TEST(Growth, PressesABallAgainstTwoWalls) {
  Cycle cycle = cycle_with_ledger(between_walls(), 0.05);
  cycle.run(20);
  EXPECT_EQ(cycle.state().model.bodies.radius[0], 1);
  cycle.run(40);
  const double halfway = cycle.state().model.bodies.radius[0];
  EXPECT_NEAR(halfway, 1 + 0.1 * (cycle.state().time - 1) / 4, 4 * ulp);
  cycle.run(60);
  const assembly::State& state = cycle.state();
  EXPECT_EQ(state.model.bodies.radius[0], 1.1);
  EXPECT_DOUBLE_EQ(state.model.bodies.mass[0], 1.1 * 1.1 * 1.1);
  EXPECT_DOUBLE_EQ(state.model.bodies.inertia[0], 0.4 * std::pow(1.1, 5));
  const std::vector<assembly::WallLoad> loads = assembly::wall_loads(state.model);
  EXPECT_NEAR(loads[0].force.z(), -10, 100 * 4 * ulp);  // k times some ulps of a length
  EXPECT_NEAR(loads[1].force.z(), 10, 100 * 4 * ulp);
  const measures::Ledger ledger = measures::ledger_of(state);
  EXPECT_NEAR(ledger.elastic.normal, 1, 1e-13);
  EXPECT_NEAR(ledger.integrals.growth, 1, 1e-13);
  EXPECT_NEAR(ledger.balance_error, 0, 1e-13);
}

// Straight rows of springs that also pull stay a linear system, now one whose masses change: exact to
// rounding.
TEST(Growth, ItsWorkClosesTheLedgerInALinearSystem) {
  SceneBuilder builder{Springs{}};
  for (int i = 0; i < 5; ++i) {
    builder.ball({2.0 * i * (1 - 1e-12), 0, 0}).growing(1 + 1e-2 * (i - 1), 20, 5.0 * i);
    builder.moving({1e-2 * (i - 2), 0, 0});
  }
  Cycle cycle = cycle_with_ledger(builder.plane({-1 + 1e-11, 0, 0}, {1, 0, 0}).damped(0.1), 0.3);
  cycle.step();
  const double begin = measures::ledger_of(cycle.state()).balance_error;
  cycle.run(300);
  const measures::Ledger end = measures::ledger_of(cycle.state());
  EXPECT_GT(std::abs(end.integrals.growth), 1e-5);
  EXPECT_NEAR(end.balance_error, begin, 1e-11 * cycle.state().ledger->initial);
}

TEST(Growth, TheListKnowsOfIt) {
  SceneBuilder builder({.kn = 100, .tension = false});
  builder.ball({0, 0, 0}, 1, 1, fix_all).growing(2, 10).ball({2.5, 0, 0}, 1, 1, fix_all);
  builder.ball({20, 0, 0}).moving({0, 0, 1e-9});
  Cycle cycle = cycle_of(builder, 0.01);
  EXPECT_EQ(cycle.state().model.contacts.size(), 0);
  cycle.run(1100);
  EXPECT_GT(cycle.state().list.rebuilds, 10);  // each for a growth of 0.025
  EXPECT_NEAR(cycle.state().force[row_of(cycle.state(), 1)].x(), 50, 100 * 8 * ulp);
}

// Its mass falls to an eighth, and the step by √8.
TEST(Growth, TheStepFollowsMassesThatShrink) {
  SceneBuilder builder({.kn = 100, .tension = false});
  builder.ball({0, 0, 0}).growing(0.5, 3);
  builder.scene().timestep = {model::TimestepPolicy::bound, 0.8, {}};
  const cycle::TimestepPolicy policy = cycle::policy_of(builder.scene());
  Cycle cycle(cycle::start(builder.scene()), policy);
  const double begin = cycle.state().next_dt;
  while (cycle.state().time < 3.5) cycle.step();
  EXPECT_EQ(cycle.state().model.bodies.radius[0], 0.5);
  EXPECT_NEAR(begin / cycle.state().next_dt, std::sqrt(8), 1e-12);
}

TEST(Growth, RadiiAreScaledAtOnceToo) {
  model::Bodies bodies;
  for (const bool disk : {false, true, false}) {
    const double mass = disk ? model::disk_mass(2, 7) : model::sphere_mass(2, 7);
    bodies.identity.push_back(bodies.size());
    bodies.position.emplace_back(10.0 * bodies.size(), 0, 0);
    bodies.radius.push_back(2);
    bodies.mass.push_back(mass);
    bodies.inertia.push_back(disk ? model::disk_inertia(2, mass) : model::sphere_inertia(2, mass));
  }
  const std::array<std::int32_t, 2> rows{0, 1};
  model::scale_radii(bodies, rows, 1.5);
  EXPECT_EQ(bodies.radius, (std::vector<double>{3, 3, 2}));
  EXPECT_DOUBLE_EQ(bodies.mass[0], model::sphere_mass(3, 7));
  EXPECT_DOUBLE_EQ(bodies.inertia[0], model::sphere_inertia(3, bodies.mass[0]));
  EXPECT_DOUBLE_EQ(bodies.mass[1], model::disk_mass(3, 7));
  EXPECT_DOUBLE_EQ(bodies.inertia[1], model::disk_inertia(3, bodies.mass[1]));
  EXPECT_EQ(bodies.mass[2], model::sphere_mass(2, 7));
}

// A simple cubic lattice with a spacing of 2 and k = 100: every ball takes an area of 4 with a contact of
// U = 2 · 1.01 - 2.
TEST(Growth, CompactsALatticeToAPressure) {
  SceneBuilder builder({.kn = 100, .tension = false});
  for (int i = 0; i < 27; ++i)
    builder.ball({1.0 + 2 * (i % 3), 1.0 + 2 * (i / 3 % 3), 1.0 + 2 * (i / 9)}, 0.98)
        .growing(1.01 / 0.98, 10);
  Cycle cycle = cycle_of(builder.periodic({6, 6, 6}).damped(0.7), 0.02);
  cycle.run(600);
  const model::Region all{"all", {}};
  const measures::Measure found = measures::measure(cycle.state().model, std::span(&all, 1)).front();
  for (int k = 0; k < 3; ++k) EXPECT_NEAR(found.stress(k, k), -100 * 0.02 / 4, 100 * 20 * ulp) << k;
}

const char* const loose = R"(
materials: [{name: grain, density: 2500}]
contacts: [{between: [grain, grain], law: linear, kn: 1e4, ks: 5e3, friction: 0.3}]
periodic: {box: [0.02, 0.02, 0.02]}
balls:
  - {fill: random, fraction: 0.3, radius: 2 mm, seed: 3, material: grain, growth: {factor: 1.34, over: 20 ms, from: 1 ms}}
damping: {local: 0.7}
timestep: {policy: bound}
)";

// From 0.3 to 0.72 of the volume: well beyond jamming, so that it ends under pressure and carries it by some
// six contacts a ball. What grew is what a scene of these balls would be.
TEST(Growth, CompactsAPacking) {
  const model::Scene scene = io::read_scene_text(loose, ".", "loose.yaml");
  Cycle cycle(cycle::start(scene), cycle::policy_of(scene));
  while (cycle.state().time < 0.06) cycle.step();
  const assembly::State& state = cycle.state();
  const model::Bodies& bodies = state.model.bodies;
  double solid = 0;
  for (std::size_t i = 0; i < bodies.radius.size(); ++i) {
    EXPECT_EQ(bodies.radius[i], 1.34 * 0.002);
    EXPECT_DOUBLE_EQ(bodies.mass[i], model::sphere_mass(1.34 * 0.002, 2500));
    solid += bodies.mass[i] / 2500;
  }
  EXPECT_NEAR(solid / 8e-6, 0.3 * std::pow(1.34, 3), 0.02);  // random fills end within half a ball
  const assembly::Balance balance = assembly::balance_of(state);
  EXPECT_LT(balance.mean, 1e-2);
  EXPECT_GT(2.0 * static_cast<double>(balance.contacts) / bodies.size(), 5);
  const model::Region all{"all", {}};
  const double pressure = -measures::measure(state.model, std::span(&all, 1)).front().stress.trace() / 3;
  // p = Σ F_n l/3V, from the places and radii alone.
  double virial = 0;
  for (std::size_t i = 0; i < bodies.radius.size(); ++i)
    for (std::size_t j = 0; j < i; ++j) {
      Vec3 apart = bodies.position[i] - bodies.position[j];
      for (int k = 0; k < 3; ++k) apart[k] -= 0.02 * std::round(apart[k] / 0.02);  // the cell is 7 radii wide
      const double overlap = bodies.radius[i] + bodies.radius[j] - apart.norm();
      if (overlap > 0) virial += 1e4 * overlap * apart.norm();
    }
  EXPECT_GT(pressure, 5e4);  // some (φ - φ_jam)/3φ of a diameter times k, from three contacts a ball: 1e5 Pa
  EXPECT_NEAR(pressure, virial / (3 * 8e-6), 1e-11 * pressure);  // ulps of 0.02 m against overlaps of 1e-4 m
}

// With friction, slip and contacts that form: of second order in the step (measured: 3.7e-5 and 1.0e-5 of the
// work of growth).
TEST(Growth, ItsWorkIsOfSecondOrderInAPackingWithFriction) {
  const model::Scene scene = io::read_scene_text(loose, ".", "loose.yaml");
  std::array<double, 2> errors{};
  for (std::size_t k = 0; k < 2; ++k) {
    const double dt = k == 0 ? 2e-5 : 1e-5;
    Cycle cycle(with_ledger(cycle::start(scene)), fixed_step(dt));
    cycle.run(std::lround(0.03 / dt));
    const measures::Ledger end = measures::ledger_of(cycle.state());
    EXPECT_GT(end.integrals.contacts.slip, 0.05 * end.integrals.growth);
    errors[k] = std::abs(end.balance_error) / end.integrals.growth;
    std::printf("growth, step %.0e: balance error %.1e of its work\n", dt, errors[k]);
  }
  EXPECT_LT(errors[0], 1e-4);
  EXPECT_LT(errors[1], 0.5 * errors[0]);
}

TEST(Growth, ARestartInTheMiddleGoesOnToTheBit) {
  const model::Scene scene = io::read_scene_text(loose, ".", "loose.yaml");
  expect_to_continue(scene, 600, {0, 7, 333});
  const io::TemporaryFolder folder;
  Cycle cycle(cycle::start(scene), cycle::policy_of(scene));
  cycle.run(150);
  while (cycle.state().list.growth == 0 && cycle.state().step < 600) cycle.step();
  io::write_state(cycle.state(), folder.path() / "state.h5");
  const assembly::State read = io::read_state(folder.path() / "state.h5");
  EXPECT_EQ(read.model.bodies.radius, cycle.state().model.bodies.radius);
  EXPECT_EQ(read.model.bodies.mass, cycle.state().model.bodies.mass);
  EXPECT_EQ(read.list.growth, cycle.state().list.growth);
  EXPECT_GT(read.list.growth, 0);
}

TEST(Growth, ThreadsDoNotMatter) {
  const model::Scene scene = io::read_scene_text(loose, ".", "loose.yaml");
  const auto run = [&](int threads) {
    const Threads with(threads);
    Cycle cycle(cycle::start(scene), cycle::policy_of(scene));
    cycle.run(400);
    return bits_of(cycle.state());
  };
  EXPECT_EQ(run(1), run(3));
}

}  // namespace
}  // namespace eigengrain::test
