// The energy ledger of a bed of about 1,000 balls that settles with all kinds of losses on walls that move.
#include "eigengrain/base/parallel.hpp"

#include "support/laws.hpp"
#include "support/ledger.hpp"
#include "support/motion.hpp"
#include "support/surfaces.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>
#include <random>
#include <utility>

namespace eigengrain::test {
namespace {

using cycle::Cycle;
using measures::Ledger;
using measures::ledger_of;

/// 10 × 10 × 10 balls that fall into a box of triangles, on a slowly turning floor.
SceneBuilder bed() {
  std::mt19937_64 random(31);
  SceneBuilder builder = with_law("linear", {{"kn", 1},
                                             {"ks", 0.5},
                                             {"friction", 0.4},
                                             {"beta_n", 0.1},
                                             {"beta_s", 0.1},
                                             {"kr", 0.05},
                                             {"rolling_friction", 0.1}});
  constexpr int edge = 10;
  for (int k = 0; k < edge; ++k)
    for (int j = 0; j < edge; ++j)
      for (int i = 0; i < edge; ++i)
        builder.ball(2.15 * Vec3(i - 4.5, j - 4.5, k + 0.5) + 0.04 * random_vector(random), 0.95)
            .moving(0.03 * random_vector(random), 0.02 * random_vector(random));
  const double half = 2.15 * edge / 2;
  builder.plane({0, 0, 0}, {0, 0, 1}).carried({0, 0, 0}, {0, 0, 1e-3});
  model::Surface sides = cuboid({half, half, 100}, true);
  return builder.surface(std::move(sides)).gravity({0, 0, -1e-3}).damped(0.05);
}

struct Run {
  Ledger ledger;
  double passed = 0;  ///< energy that passed through: what there was, and what gravity and walls put in, J
};

Run run(double dt, double time) {
  Cycle cycle = cycle_with_ledger(bed(), dt);
  cycle.run(std::lround(time / dt));
  Run result{ledger_of(cycle.state())};
  result.passed =
      cycle.state().ledger->initial + result.ledger.integrals.gravity + result.ledger.integrals.walls;
  return result;
}

// Impacts begin and end, slip begins and ends in all phases of the step: each errs by some Δt².
// Measured: 1.6e-2 of what passed through at 0.4, 4.1e-3 at half of that and 1.0e-3 at a quarter.
TEST(LedgerBed, OfAThousandBallsClosesTheBetterTheSmallerTheStep) {
  for (const double dt : {0.4, 0.1}) {
    const auto [ledger, passed] = run(dt, 240);
    const contact::Dissipation& lost = ledger.integrals.contacts;
    const double error = std::abs(ledger.balance_error) / passed;
    std::printf(
        "bed, step %.1f: gravity %.3f, walls %.4f, slip %.3f, rolling %.3f, viscous %.3f, damping %.3f, "
        "error "
        "%.1e of %.3f J\n",
        dt, ledger.integrals.gravity, ledger.integrals.walls, lost.slip, lost.rolling, lost.viscous,
        ledger.integrals.damping, error, passed);
    EXPECT_LT(error, 0.15 * dt * dt);
    for (const double part : {lost.slip, lost.rolling, lost.viscous, ledger.integrals.damping})
      EXPECT_GT(part, 1e-3 * passed);
  }
}

TEST(LedgerBed, IsTheSameToTheBitOnAnyNumberOfThreads) {
  const int before = threads();
  set_threads(1);
  const Ledger one = run(0.3, 60).ledger;
  set_threads(3);
  const Ledger many = run(0.3, 60).ledger;
  set_threads(before);
  EXPECT_TRUE(same_bits(one, many));
  EXPECT_GT(one.integrals.contacts.rolling, 0);
}

}  // namespace
}  // namespace eigengrain::test
