// Random packings in cells that deform: the same bits on any number of threads and from a state that was
// saved, and what granular matter does when it is sheared.
#include "eigengrain/assembly/energies.hpp"
#include "eigengrain/cycle/watch.hpp"
#include "eigengrain/io/scene_reader.hpp"
#include "eigengrain/measures/ledger.hpp"
#include "eigengrain/measures/measure.hpp"

#include "cells/support.hpp"
#include "support/restart.hpp"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>

namespace eigengrain::test {
namespace {

using assembly::State;
using cycle::Cycle;

/// Balls of 4 to 6 mm, pressed so that contacts overlap by 0.5% of r_a + r_b. The mass of a ball is 1.3 g, so
/// √(m/k) is 0.11 ms.
model::Scene packing(std::string_view gradient, int edge_mm = 40, std::string_view more = "") {
  return io::read_scene_text(fmt::format(R"(
materials: [{{name: grain, density: 2500}}]
contacts: [{{between: [any, any], law: linear, kn: 1e5, ks: 5e4, friction: 0.5, beta_n: 0.1, kr: 0.2, rolling_friction: 0.05}}]
periodic: {{box: [{0} mm, {0} mm, {0} mm], velocity_gradient: {1}}}
balls: [{{fill: dense, mean_overlap: 5e-3, sizes: {{distribution: uniform, min: 4 mm, max: 6 mm}}, seed: 1, material: grain}}]
damping: {{local: 0.2}}
timestep: {{policy: bound}}
{2}
)",
                                         edge_mm, gradient, more),
                             ".", "packing.yaml");
}

constexpr std::string_view mixed = "[[1, 0, 60], [-20, -2, 0], [0, 5, 1]]";

TEST(DeformingCell, GoesOnToTheBit) {
  expect_to_continue(packing(mixed), 1200, {0, 1, 333, 900});
}

// Clumps and a fixed ball, a floor with friction, and a bond across the cell.
TEST(DeformingCell, GoesOnToTheBitWithClumpsBondsAndAFloor) {
  const model::Scene scene = io::read_scene_text(R"(
gravity: [0, 0, -9.81]
materials: [{name: grain, density: 2500}, {name: glue, density: 2500}]
contacts:
  - {between: [glue, glue], law: linear, kn: 1e4, bond: {kind: parallel, kn: 1e9, ks: 4e8}}
  - {between: [any, any], law: linear, kn: 1e4, ks: 5e3, friction: 0.4, beta_n: 0.1}
periodic: {box: [0.06, 0.06, 1], axes: [x, y], velocity_gradient: [[2, 20, 0], [-5, -1, 0], [0, 0, 0]]}
balls:
  - {position: [0.05, 0.05, 0.005], radius: 5 mm, material: grain, fix: [x, y]}
  - {position: [0.004, 0.01, 0.005], radius: 5 mm, material: glue}
  - {position: [0.0541, 0.01, 0.005], radius: 5 mm, material: glue}
clumps:
  - balls: [{at: [0, 0, 0], radius: 5 mm}, {at: [6 mm, 0, 0], radius: 4 mm}]
    material: grain
    instances:
      - {position: [0.02, 0.02, 0.01], velocity: [1, 0, -1], spin: [10, 0, 40]}
      - {position: [0.045, 0.03, 0.01], velocity: [-1, 0.3, 0]}
walls: [{plane: {point: [0, 0, 0], normal: [0, 0, 1]}, material: grain}]
timestep: {policy: bound}
)",
                                                 ".", "heap.yaml");
  expect_to_continue(scene, 1200, {1, 700});
}

TEST(DeformingCell, DoesNotDependOnTheNumberOfThreads) {
  // Enough balls for several chunks.
  const model::Scene scene = packing(mixed, 85);
  const auto run = [&](int count) {
    const Threads threads(count);
    Cycle cycle(cycle::start(scene), cycle::policy_of(scene));
    cycle.run(250);
    return cycle.release();
  };
  const State one = run(1);
  std::printf("%d balls, %lld lists, strain %.2f\n", one.model.bodies.size(),
              static_cast<long long>(one.list.rebuilds), 60 * one.time);
  EXPECT_GT(one.model.bodies.size(), 600);
  EXPECT_GT(one.list.rebuilds, 50);
  for (const int count : {2, 4}) {
    EXPECT_EQ(bits_of(run(count)), bits_of(one)) << count << " threads";
  }
}

// A strain of four, in which the cell is reduced again and again; saved between, and on.
TEST(DeformingCell, GoesOnToTheBitThroughManyReductions) {
  const model::Scene scene = packing("[[0, 0, 80], [0, 0, 0], [0, 0, 0]]");
  Cycle cycle(cycle::start(scene), cycle::policy_of(scene));
  int reductions = 0;
  double slant = 0;
  while (cycle.state().time < 0.05) {
    cycle.run(20);
    const double now = cycle.state().model.cell.edges(0, 2);
    if (now < slant) ++reductions;
    slant = now;
  }
  std::printf("%lld steps, %d reductions\n", static_cast<long long>(cycle.state().step), reductions);
  EXPECT_EQ(reductions, 4);
  const std::int64_t steps = cycle.state().step;
  expect_to_continue(scene, steps, {steps / 3, 2 * steps / 3});
}

TEST(DeformingCell, TakesAnotherGradientFromWhereItIs) {
  const io::TemporaryFolder folder;
  const auto file = folder.path() / "state.h5";
  const model::Scene scene = packing("[[0, 0, 20], [0, 0, 0], [0, 0, 0]]");
  Cycle cycle(cycle::start(scene), cycle::policy_of(scene));
  cycle.run(600);
  io::write_state(cycle.state(), file);
  const Mat3 edges = cycle.state().model.cell.edges;
  ASSERT_GT(edges(0, 2), 0);

  // At rest: the flow is taken off again with the first kick, and the cell stays as it is.
  const std::vector<std::string> stop{"periodic.velocity_gradient=[]"};
  State state = io::read_state(file, stop);
  EXPECT_EQ(state.model.cell.edges, edges);
  EXPECT_THROW(measures::begin_ledger(state), InputError);
  const double kinetic = assembly::energies_of(state).kinetic;
  Cycle rest(std::move(state), cycle::policy_of(scene));
  rest.run(1);
  EXPECT_EQ(rest.state().model.cell.edges, edges);
  EXPECT_FALSE(rest.state().model.cell.deforms());
  double after = 0;  // of the whole velocities
  for (std::size_t i = 0; i < rest.state().model.bodies.mass.size(); ++i)
    after += 0.5 * rest.state().model.bodies.mass[i] * rest.state().model.bodies.velocity[i].squaredNorm();
  // In a step of 0.1 √(m/k) fluctuations change by as much; the flow alone would be 50 times more.
  EXPECT_LT(after, 1.5 * kinetic);
  rest.run(200);
  EXPECT_EQ(rest.state().model.cell.edges, edges);

  const std::vector<std::string> turn{"periodic.velocity_gradient=[[0, 0, 0], [0, 0, 0], [30, 0, 0]]"};
  Cycle other(io::read_state(file, turn), cycle::policy_of(scene));
  other.run(100);
  EXPECT_GT(other.state().model.cell.edges(2, 0), 0);

  const std::vector<std::string> box{"periodic.box=[50 mm, 40 mm, 40 mm]"};
  try {
    io::read_state(file, box);
    ADD_FAILURE() << "a box that the cell no longer is was taken";
  } catch (const InputError& error) {
    EXPECT_THAT(error.what(), testing::HasSubstr("whose cell has moved since; leave them out"));
  }
}

// Dense, at constant volume, slow: 60 √(m/k) for each percent of a strain of 1.2. The stress ratio of
// frictional balls is some 0.3 to 0.5 (GDR MiDi, Eur. Phys. J. E 14:341, 2004), their coordination 4 and
// more; fluctuations stay far below what the springs hold.
TEST(DeformingCell, ShearsGranularMatter) {
  const model::Scene scene = packing("[[0, 0, 1.5], [0, 0, 0], [0, 0, 0]]", 36);
  Cycle cycle(cycle::start(scene), cycle::policy_of(scene));
  cycle::Watch watch(cycle.state());
  const std::vector<model::Region> all{{"all", {}}};
  const double volume = cycle.state().model.cell.volume();
  double ratio = 0;
  int looks = 0;
  while (1.5 * cycle.state().time < 1.2) {
    cycle.run(250);
    const auto trouble = watch.look(cycle.state());
    ASSERT_FALSE(trouble.has_value()) << trouble->what;
    if (1.5 * cycle.state().time < 0.4) continue;
    const measures::Measure m = measures::measure(cycle.state().model, all).front();
    const double pressure = -m.stress.trace() / 3;
    EXPECT_GT(pressure, 0);
    ratio += -m.stress(0, 2) / pressure;
    ++looks;
    EXPECT_NEAR(m.volume / volume, 1, 1e-10);  // a rounding for each step
  }
  ratio /= -looks;
  const measures::Measure last = measures::measure(cycle.state().model, all).front();
  const assembly::Energies energies = assembly::energies_of(cycle.state());
  std::printf(
      "%d balls, %lld steps, %lld lists, stress ratio %.3f, coordination %.2f, kinetic over elastic %.1e\n",
      cycle.state().model.bodies.size(), static_cast<long long>(cycle.state().step),
      static_cast<long long>(cycle.state().list.rebuilds), ratio, last.fabric.coordination,
      energies.kinetic / energies.elastic);
  EXPECT_GT(ratio, 0.15);
  EXPECT_LT(ratio, 0.6);
  EXPECT_GT(last.fabric.coordination, 3.5);
  EXPECT_LT(energies.kinetic, 0.05 * energies.elastic);
}

}  // namespace
}  // namespace eigengrain::test
