// What results may not depend on: the number of threads (to the bit), and when the near pairs are listed.
#include "support/bits.hpp"
#include "support/motion.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>
#include <random>

namespace eigengrain::test {
namespace {

using assembly::State;
using cycle::Cycle;

/// Balls thrown about in a box that repeats along x, with friction and a floor.
SceneBuilder falling_balls(int across, int high, bool periodic = true) {
  constexpr double spacing = 2.15;
  std::mt19937_64 random(21);
  std::uniform_real_distribution<double> uniform(-1, 1);
  SceneBuilder builder({.kn = 1, .ks = 0.5, .tension = false});
  for (int k = 0; k < high; ++k)
    for (int j = 0; j < across; ++j)
      for (int i = 0; i < across; ++i) {
        const double radius = 0.95 + 0.05 * uniform(random);
        builder
            .ball(spacing * Vec3(i + 0.5, j + 0.5, k + 0.5) + 0.06 * random_vector(random), radius,
                  radius * radius * radius)
            .moving(0.03 * random_vector(random) + Vec3(0.02, 0, 0), 0.02 * random_vector(random));
      }
  const double edge = across * spacing;
  builder.plane(Vec3::Zero(), Vec3::UnitZ()).plane(Vec3::Zero(), Vec3::UnitY());
  builder.plane(Vec3(0, edge, 0), -Vec3::UnitY()).gravity({0, 0, -2e-4}).damped(0.1);
  if (periodic)
    builder.periodic(Vec3::Constant(edge), {true, false, false});
  else
    builder.plane(Vec3::Zero(), Vec3::UnitX()).plane(Vec3(edge, 0, 0), -Vec3::UnitX());
  return builder;
}

TEST(Threads, DoNotChangeABitOfThreeThousandBalls) {
  const auto run = [](int count) {
    const Threads threads(count);
    Cycle cycle = cycle_of(falling_balls(13, 18), 0.3);
    cycle.run(500);
    return cycle.release();
  };
  const State one = run(1);
  std::size_t sheared = 0;
  for (const Vec3& shear : shears_of(one)) sheared += shear.isZero(0) ? 0 : 1;
  std::printf("%d balls, %lld lists, %zu contacts with shear\n", one.model.bodies.size(),
              static_cast<long long>(one.list.rebuilds), sheared);
  EXPECT_GT(one.list.rebuilds, 20);  // that there is something to differ in
  EXPECT_GT(sheared, 100U);
  for (const int count : {2, 4}) {
    const State many = run(count);
    EXPECT_EQ(bits_of(one), bits_of(many)) << count << " threads";
    EXPECT_EQ(one.list.rebuilds, many.list.rebuilds);
  }
}

State with_skin(SceneBuilder builder, double part, double dt, int steps) {
  State state = cycle::start(builder.scene());
  // Smaller than it was listed for, which is safe.
  state.list.skin *= part;
  Cycle cycle(std::move(state), fixed_step(dt));
  cycle.run(steps);
  return cycle.release();
}

double farthest(const State& a, const State& b) {
  double most = 0;
  const std::vector<Vec3> x = positions_of(a);
  const std::vector<Vec3> y = positions_of(b);
  const model::PeriodicCell& cell = a.model.cell;
  for (std::size_t i = 0; i < x.size(); ++i) {
    Vec3 apart = x[i] - y[i];
    for (int k = 0; k < 3; ++k)  // wrapped or not
      if (cell.periodic[k]) apart[k] -= cell.edges(k, k) * std::round(apart[k] / cell.edges(k, k));
    most = std::max(most, apart.norm());
  }
  return most;
}

// Pairs that do not touch add nothing to a sum whose order is that of the pairs: without a periodic axis the
// same motion to the bit. With one, centres are wrapped at other times, and rounding grows through
// collisions.
TEST(NearPairs, MayBeListedAtAnyTime) {
  const SceneBuilder closed = falling_balls(6, 6, false);
  const State seldom = with_skin(closed, 1, 0.3, 500);
  const State often = with_skin(closed, 0.2, 0.3, 500);
  std::printf("lists: %lld and %lld, apart by %.2e; ", static_cast<long long>(seldom.list.rebuilds),
              static_cast<long long>(often.list.rebuilds), farthest(seldom, often));
  EXPECT_GT(often.list.rebuilds, seldom.list.rebuilds + 100);
  EXPECT_EQ(farthest(seldom, often), 0);

  const SceneBuilder open = falling_balls(6, 6, true);
  const double apart = farthest(with_skin(open, 1, 0.3, 200), with_skin(open, 0.2, 0.3, 200));
  std::printf("periodic: apart by %.2e\n", apart);
  // Rounding 1e-15 of a position, and a factor of some ten for each of the few collisions of a ball.
  EXPECT_LT(apart, 1e-9);
}

// A ball that a slope would make slide hangs in its shear spring while another flies by and makes lists
// expire.
TEST(NearPairs, KeepTheShearOfAStickingContactThroughManyLists) {
  constexpr double g = 0x1p-20;
  SceneBuilder builder({.kn = 1, .ks = 0.5, .tension = false, .friction = 0.9});
  builder.ball({0, 0, 1 - g}, 1, 1, fix_rotations).plane({0, 0, 0}, {0, 0, 1});
  builder.ball({0, 0, 9}, 1, 1, fix_all).moving({0.2, 0, 0});
  builder.gravity({0.25 * g, 0, -g}).damped(0.7);
  Cycle cycle = cycle_of(builder, 0.25);
  cycle.run(2000);
  const std::int64_t lists = cycle.state().list.rebuilds;
  EXPECT_GT(lists, 1000);
  const double held = cycle.state().force[row_of(cycle.state(), 0)].x();
  EXPECT_NEAR(held, -0.25 * g, 1e-9 * g);  // settled: swings have shrunk by 0.42 each half cycle
  cycle.run(2000);
  EXPECT_GT(cycle.state().list.rebuilds, lists + 1000);
  EXPECT_NEAR(cycle.state().force[row_of(cycle.state(), 0)].x(), -0.25 * g, 1e-12 * g);
}

// A pair under shear that travels around a periodic cell again and again, against the same pair in free
// space.
TEST(NearPairs, KeepTheShearOfAPairThatCrossesThePeriodicBoundary) {
  const auto run = [](bool periodic) {
    SceneBuilder builder({.kn = 1, .ks = 0.5, .tension = true});
    const Vec3 drift(0.1, 0.02, -0.05);
    builder.ball({1, 1, 1}).moving(drift, Vec3(0, 0, 2e-3));
    builder.ball(Vec3(1, 1, 1) + 1.99 * Vec3(2, 1, 2).normalized()).moving(drift, Vec3(0, 2e-3, 1e-3));
    if (periodic) builder.periodic(Vec3(5, 6, 7));
    Cycle cycle = cycle_of(builder, 0.2);
    cycle.run(5000);  // x: 20 times around the cell
    return cycle.release();
  };
  const State wrapped = run(true);
  const State free = run(false);
  const std::vector<Vec3> a = shears_of(wrapped);
  const std::vector<Vec3> b = shears_of(free);
  // Near pairs of the cell that never touch are listed as well; the one under shear is the one that counts.
  Vec3 sum_a = Vec3::Zero();
  Vec3 sum_b = Vec3::Zero();
  for (const Vec3& shear : a) sum_a += shear;
  for (const Vec3& shear : b) sum_b += shear;
  EXPECT_GT(wrapped.list.rebuilds, 100);
  EXPECT_GT(sum_b.norm(), 1e-5);
  // Positions up to 100 know an overlap to 1e-14, at each of 5000 steps.
  EXPECT_LT((sum_a - sum_b).norm(), 1e-10);
  EXPECT_LT(farthest(wrapped, free), 1e-9);
}

}  // namespace
}  // namespace eigengrain::test
