// A bonded tetrahedron of four that tumbles freely, undamped, for a million steps: the total form keeps it,
// PFC3D's incremental form drifts until it comes apart.
#include "eigengrain/assembly/energies.hpp"

#include "support/bonds.hpp"
#include "support/motion.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>

namespace eigengrain::test {
namespace {

using cycle::Cycle;

constexpr double omega = 0.02;  // √(k/m)
constexpr double dt = 0.2;      // √(m/k)

Cycle tetrahedron(double ks, bool incremental) {
  SceneBuilder builder;
  const Vec3 spin = omega * Vec3(1, 2, 3).normalized();
  for (const Vec3& corner : {Vec3(1, 1, 1), Vec3(1, -1, -1), Vec3(-1, 1, -1), Vec3(-1, -1, 1)}) {
    const Vec3 x = corner / std::sqrt(2.0);
    builder.ball(x).moving(spin.cross(x), spin);
  }
  builder.without_law().bonded(Cemented{.kn = 1, .ks = ks, .incremental = incremental}.rule());
  return cycle_of(builder, dt);
}

double energy_of(const Cycle& cycle) {
  const assembly::Energies e = assembly::energies_of(cycle.state());
  return e.kinetic_product + e.elastic;
}

Vec3 angular_momentum_of(const Cycle& cycle) {
  const model::Bodies& b = cycle.state().model.bodies;
  Vec3 sum = Vec3::Zero();
  for (std::size_t i = 0; i < b.position.size(); ++i)
    // Velocities are of half a step before.
    sum += b.mass[i] * (b.position[i] - 0.5 * dt * b.velocity[i]).cross(b.velocity[i]) +
           b.inertia[i] * b.spin[i];
  return sum;
}

/// The distance of two centres that is farthest from 2, less 2.
double distortion_of(const Cycle& cycle) {
  const auto& x = cycle.state().model.bodies.position;
  double worst = 0;
  for (std::size_t i = 0; i < x.size(); ++i)
    for (std::size_t j = 0; j < i; ++j) worst = std::max(worst, std::abs((x[i] - x[j]).norm() - 2));
  return worst;
}

struct Seen {
  double energy = 0;      ///< largest change, relative
  double momentum = 0;    ///< largest change of the angular momentum, relative
  double distortion = 0;  ///< largest
};

Seen follow(Cycle& cycle, int steps) {
  Seen seen;
  const double energy = energy_of(cycle);
  cycle.step();
  const Vec3 momentum = angular_momentum_of(cycle);
  for (int step = 1; step < steps; ++step) {
    cycle.step();
    if (step % 97 != 0) continue;
    seen.energy = std::max(seen.energy, std::abs(energy_of(cycle) / energy - 1));
    seen.momentum = std::max(seen.momentum, (angular_momentum_of(cycle) - momentum).norm() / momentum.norm());
    seen.distortion = std::max(seen.distortion, distortion_of(cycle));
  }
  return seen;
}

TEST(TumblingCluster, IsKeptByTheTotalFormForAMillionSteps) {
  for (const double ks : {0.0, 0.5}) {
    Cycle cycle = tetrahedron(ks, false);
    Cycle again = tetrahedron(ks, false);
    const Seen early = follow(again, 10000);
    const Seen seen = follow(cycle, 1000000);
    std::printf(
        "k_s = %.1f: energy within %.2e (%.2e in the first 10,000), angular momentum within %.2e, centres "
        "within %.2e of their distance (%.2e)\n",
        ks, seen.energy, early.energy, seen.momentum, seen.distortion, early.distortion);
    // The elastic part of the energy swings by Δt² of its own 1e-3 share and does not drift; rounding alone
    // moves the angular momentum; the stretch is centrifugal, mω²r/k and its vibrations.
    EXPECT_LT(seen.energy, 1.2 * early.energy);
    EXPECT_LT(seen.energy, 2e-5);
    EXPECT_LT(seen.momentum, 1e-12);
    EXPECT_LT(seen.distortion, 1.2 * early.distortion);
    EXPECT_LT(seen.distortion, 1e-3);
  }
}

/// Steps until some distance of centres is off by a tenth, or `most`.
int steps_to_ruin(double ks, int most) {
  Cycle cycle = tetrahedron(ks, true);
  for (int step = 0; step < most; step += 100) {
    cycle.run(100);
    // Written so that not-a-number counts.
    if (!(distortion_of(cycle) < 0.2)) return step;
  }
  return most;
}

TEST(TumblingCluster, DestroysItselfInPfc3dsIncrementalForm) {
  for (const double ks : {0.0, 0.5}) {
    const int ruin = steps_to_ruin(ks, 1000000);
    std::printf("incremental, k_s = %.1f: out of shape by a tenth after %d steps\n", ks, ruin);
    EXPECT_LT(ruin, 1000000);
    EXPECT_GT(ruin, 1000);
  }
}

}  // namespace
}  // namespace eigengrain::test
