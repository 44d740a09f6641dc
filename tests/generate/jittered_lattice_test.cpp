#include "eigengrain/generate/jittered_lattice.hpp"

#include "generate/support.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <numeric>

namespace eigengrain::generate {
namespace {

TEST(JitteredLattice, HasTheContactsOfASettledPacking) {
  Random random(1);
  const PeriodicBalls made = jittered_lattice(4000, random);
  const std::vector<int> count = neighbours_of(made.balls, made.region, 0).count;
  const double mean = std::accumulate(count.begin(), count.end(), 0.0) / static_cast<double>(count.size());
  // Gaps of neighbours are symmetric about 0: half of 12, with a standard error of √(12/4)/√4000 times a few
  // for neighbours that share a ball.
  EXPECT_NEAR(mean, 6, 0.2);
}

TEST(JitteredLattice, ComesWithinATenthOfTheNumberAskedFor) {
  for (const std::int64_t balls : {1000, 10'000, 100'000}) {
    Random random(1);
    const PeriodicBalls made = jittered_lattice(balls, random);
    EXPECT_NEAR(static_cast<double>(made.balls.position.size()) / static_cast<double>(balls), 1, 0.1)
        << balls;
    EXPECT_EQ(made.balls.radius.size(), made.balls.position.size());
  }
}

TEST(JitteredLattice, IsTheSameForTheSameSeed) {
  Random one(7);
  Random other(7);
  EXPECT_EQ(jittered_lattice(100, one).balls.position, jittered_lattice(100, other).balls.position);
}

TEST(JitteredLattice, StaysWithinItsBounds) {
  Random random(1);
  const PeriodicBalls made = jittered_lattice(500, random);
  for (const double radius : made.balls.radius) {
    EXPECT_GE(radius, 0.9);
    EXPECT_LE(radius, 1.1);
  }
  for (const Vec3& x : made.balls.position)
    for (int k = 0; k < 3; ++k) {
      EXPECT_GE(x[k], 0);
      EXPECT_LT(x[k], made.region.upper[k]);
    }
  // Two neighbours come nearer by at most √3 · 0.05 each, and have grown by 0.1 each.
  EXPECT_GT(neighbours_of(made.balls, made.region, 0).least_gap, -2 * (0.0867 + 0.1));
}

TEST(JitteredLattice, RefusesNoBalls) {
  Random random(1);
  EXPECT_THROW(jittered_lattice(0, random), InputError);
}

}  // namespace
}  // namespace eigengrain::generate
