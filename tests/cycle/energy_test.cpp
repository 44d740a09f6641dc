// Energy over long runs: leapfrog conserves ½ v₋·M v₊ + elastic exactly in a linear system, and keeps it
// within bounds wherever the forces have a potential.
#include "eigengrain/assembly/energies.hpp"

#include "support/motion.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <random>

namespace eigengrain::test {
namespace {

using cycle::Cycle;

double energy_of(const assembly::State& state) {
  const assembly::Energies energies = assembly::energies_of(state);
  return energies.kinetic_product + energies.elastic + energies.gravitational;
}

/// Steps of a test that takes 10^6 in its long form: with EIGENGRAIN_LONG_TESTS set.
std::int64_t long_or_short() {
  return std::getenv("EIGENGRAIN_LONG_TESTS") != nullptr ? 1'000'000 : 200'000;
}

struct EnergyRange {
  double start = 0;
  double worst = 0;  ///< largest |E - E₀|/E₀ at any look
  double early = 0;  ///< mean of (E - E₀)/E₀ over the first tenth of the run
  double late = 0;   ///< and over the last tenth
};

EnergyRange watched(Cycle& cycle, std::int64_t steps, std::int64_t every) {
  cycle.step();  // at the very start v₋ is v₊
  EnergyRange range{.start = energy_of(cycle.state())};
  const std::int64_t looks = steps / every;
  const std::int64_t tenth = looks / 10;
  for (std::int64_t look = 0; look < looks; ++look) {
    cycle.run(every);
    const double error = energy_of(cycle.state()) / range.start - 1;
    range.worst = std::max(range.worst, std::abs(error));
    if (look < tenth) range.early += error / static_cast<double>(tenth);
    if (look >= looks - tenth) range.late += error / static_cast<double>(tenth);
  }
  return range;
}

// Balls in a row that move along it: the distances are linear in the displacements, to rounding.
TEST(Energy, IsExactInALinearSystemOverAMillionSteps) {
  SceneBuilder row{Springs{}};
  std::mt19937_64 random(7);
  std::uniform_real_distribution<double> uniform(-1, 1);
  for (int i = 0; i < 5; ++i)
    row.ball({(2 * i - 4) * (1 - 1e-12), 0, 0}).moving({1e-2 * uniform(random), 0, 0});
  row.plane({-5 + 1e-11, 0, 0}, {1, 0, 0});
  Cycle cycle = cycle_of(row, 0.7);
  const EnergyRange range = watched(cycle, 1'000'000, 500);
  std::printf("row: worst %.2e, mean %.2e at first, %.2e at last\n", range.worst, range.early, range.late);
  // An ulp of x (1e-15 at most) against an amplitude of 1e-2 is 1e-13 of the energy a step, at random: 1e-10
  // after 10^6, and up to ten times that for the worst of 2000 looks and an uneven walk.
  EXPECT_LT(range.worst, 1e-9);
}

// Without shear the contact forces have a potential, so that leapfrog is symplectic: at finite amplitude the
// error of this energy swings with Δt² but does not grow.
TEST(Energy, StaysWithinBoundsAtFiniteAmplitude) {
  std::mt19937_64 random(8);
  SceneBuilder cluster = random_cluster(random, 5, {.kn = 1, .ks = 0}, 1.3);
  for (int i = 0; i < 5; ++i) cluster.scene().bodies.velocity.push_back(0.02 * random_vector(random));
  Cycle cycle = cycle_of(cluster, 0.2);
  const EnergyRange range = watched(cycle, long_or_short(), 100);
  std::printf("cluster: worst %.2e, mean %.2e at first, %.2e at last\n", range.worst, range.early,
              range.late);
  // (ωΔt)²/8 with ωΔt = 0.4 is 2e-2 of the part that is not linear; the mean is that of a chaotic motion,
  // known to some 1e-4.
  EXPECT_LT(range.worst, 2e-2);
  EXPECT_LT(std::abs(range.late - range.early), 5e-4);
}

/// Relative change of the kinetic energy of a ball that hits a floor head on and leaves it, k = m = 1.
double energy_change_of_an_impact(double dt, double phase) {
  constexpr double speed = 0.01;
  SceneBuilder builder({.kn = 1, .ks = 0, .tension = false});
  builder.ball({0, 0, 1 + speed * dt * (2 - phase)}).plane({0, 0, 0}, {0, 0, 1}).moving({0, 0, -speed});
  Cycle cycle = cycle_of(builder, dt);
  cycle.run(static_cast<std::int64_t>(4 / dt) + 4);  // half a period is 3.14
  const double v = velocity_of(cycle.state(), 0).z();
  return v * v / (speed * speed) - 1;
}

// At the instant of touching the force has a kink. Of the first overlap vτ, τ in [0, Δt), the conserved
// energy is ½v²[1 - τ(Δt - τ)k/m], and it is the same on the way out: what an impact changes depends on how
// the steps fall and is less than ¼Δt²k/m, with no preference for gain or loss.
TEST(Energy, ChangesInAnImpactByTheKinkAlone) {
  constexpr int phases = 200;
  for (const double dt : {0.2, 0.05}) {
    double worst = 0;
    double mean = 0;
    for (int i = 0; i < phases; ++i) {
      const double change = energy_change_of_an_impact(dt, (i + 0.5) / phases);
      worst = std::max(worst, std::abs(change));
      mean += change / phases;
    }
    std::printf("impacts, step %.2f: worst %.2e, mean %.1e\n", dt, worst, mean);
    EXPECT_LT(worst, 0.25 * dt * dt * 1.02);  // and terms of fourth order
    EXPECT_GT(worst, 0.05 * dt * dt);
    EXPECT_LT(std::abs(mean), 0.01 * dt * dt);  // gains and losses cancel over all phases
  }
}

// So the energy of many collisions walks at random without drift.
TEST(Energy, WalksAtRandomThroughManyCollisions) {
  std::mt19937_64 random(9);
  SceneBuilder box({.kn = 1, .ks = 0, .tension = false});
  for (int i = 0; i < 8; ++i)
    box.ball(Vec3(1.5 + 3 * (i & 1), 1.5 + 3 * ((i >> 1) & 1), 1.5 + 3 * (i >> 2)))
        .moving(0.02 * random_vector(random));
  for (int axis = 0; axis < 3; ++axis)
    box.plane(Vec3::Zero(), Vec3::Unit(axis)).plane(Vec3::Constant(6), -Vec3::Unit(axis));
  Cycle cycle = cycle_of(box, 0.1);
  const std::int64_t steps = long_or_short();
  const EnergyRange range = watched(cycle, steps, 50);
  std::printf("collisions: worst %.2e, mean %.2e at first, %.2e at last, %lld lists\n", range.worst,
              range.early, range.late, static_cast<long long>(cycle.state().list.rebuilds));
  // Eight balls, each with an impact every 60 or so: Δt steps/60 · 8 impacts, each of about 0.1 Δt² · 2 of an
  // eighth of the energy (a pair has twice the k/m); three standard deviations.
  const double impacts = 8 * 0.1 * static_cast<double>(steps) / 60;
  EXPECT_LT(range.worst, 3 * 0.2 * 0.01 / 8 * std::sqrt(impacts) * 2);
  EXPECT_GT(cycle.state().list.rebuilds, 1000);
}

// With shear the incremental law conserves energy as far as increments are those of a potential: for small
// motions about a place, without rotation of the whole. Modes with λ > 0 have neither momentum nor angular
// momentum.
TEST(Energy, IsKeptWithShearWhileTheWholeDoesNotTurn) {
  constexpr double amplitude = 1e-6;
  std::mt19937_64 random(10);
  std::normal_distribution<double> gaussian;
  SceneBuilder tetrahedron({.kn = 1, .ks = 0.6});
  for (const Vec3& corner : {Vec3(1, 1, 1), Vec3(1, -1, -1), Vec3(-1, 1, -1), Vec3(-1, -1, 1)})
    tetrahedron.ball(corner / std::sqrt(2.0) * (1 - 1e-12));
  const System system(tetrahedron);
  const Modes modes(system);
  for (Eigen::Index mode = 0; mode <= modes.critical(); ++mode)
    if (modes.lambda()[mode] > 1e-6)
      modes.add_velocity(tetrahedron.scene(), mode, amplitude * gaussian(random));
  Cycle cycle = cycle_of(tetrahedron, 0.3);
  const EnergyRange range = watched(cycle, 200'000, 50);
  std::printf("shear: worst %.2e, mean %.2e at first, %.2e at last\n", range.worst, range.early, range.late);
  // Rotations of the contact planes are of the size of the amplitude.
  EXPECT_LT(range.worst, 10 * amplitude);
}

}  // namespace
}  // namespace eigengrain::test
