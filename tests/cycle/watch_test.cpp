// The watch: a run that blows up is caught while its numbers are still numbers, a healthy one is left alone.
#include "eigengrain/cycle/watch.hpp"

#include "eigengrain/cycle/bounds.hpp"
#include "eigengrain/cycle/policy.hpp"

#include "support/motion.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

namespace eigengrain::test {
namespace {

using cycle::Cycle;
using cycle::Trouble;
using cycle::Watch;

std::string told(const std::optional<Trouble>& trouble) {
  return trouble ? trouble->what : "nothing";
}

bool all_finite(const assembly::State& state) {
  return std::all_of(state.model.bodies.position.begin(), state.model.bodies.position.end(),
                     [](const Vec3& x) { return x.allFinite(); });
}

// Twenty pairs at rest in their springs, touched very lightly; one of them is lighter than the others, and
// the step is twice its limit but below that of the rest.
TEST(Watch, NamesThePairWhoseLimitIsExceeded) {
  SceneBuilder builder({.kn = 1, .ks = 0.5, .tension = true});
  constexpr int light = 13;
  for (int i = 0; i < 20; ++i) {
    const double mass = i == light ? 0.05 : 1;
    const Vec3 place(4 * i, 3 * (i % 3), 0);
    builder.ball(place, 1, mass).moving({1e-9, 0, 0}).ball(place + Vec3(0, 0, 2 - 1e-9), 1, mass);
  }
  // Two spheres: λ_max = max(2 k_n, 7 k_s)/m.
  const double limit = 2 / std::sqrt(3.5 / 0.05);
  Cycle cycle = cycle_of(builder, 2 * limit);
  Watch watch(cycle.state());
  std::optional<Trouble> trouble;
  for (int looks = 0; looks < 100 && !trouble; ++looks) {
    cycle.run(5);
    trouble = watch.look(cycle.state());
  }
  ASSERT_TRUE(trouble.has_value());
  EXPECT_TRUE(all_finite(cycle.state())) << trouble->what;
  ASSERT_GE(trouble->bodies.size(), 2U);
  // The two of the light pair come first; others only if they are named at all (fastest in energy).
  std::vector<std::int64_t> first{trouble->bodies[0], trouble->bodies[1]};
  std::sort(first.begin(), first.end());
  EXPECT_EQ(first, (std::vector<std::int64_t>{2 * light, 2 * light + 1})) << trouble->what;
}

/// A bed of balls dropped into a box.
SceneBuilder dropped(double alpha, int balls = 125) {
  std::mt19937_64 random(4);
  std::uniform_real_distribution<double> uniform(-1, 1);
  SceneBuilder builder({.kn = 1, .ks = 0.5, .tension = false});
  for (int i = 0; i < balls; ++i) {
    const double radius = 0.9 + 0.1 * uniform(random);
    builder.ball(2.3 * Vec3(i % 5 + 0.5, i / 5 % 5 + 0.5, i / 25 + 0.5) + 0.05 * random_vector(random),
                 radius, radius * radius * radius);
  }
  builder.plane(Vec3::Zero(), Vec3::UnitZ()).gravity({0, 0, -1e-3}).damped(alpha);
  for (int axis = 0; axis < 2; ++axis)
    builder.plane(Vec3::Zero(), Vec3::Unit(axis)).plane(Vec3::Constant(11.5), -Vec3::Unit(axis));
  return builder;
}

// The same bed with a step of twice its limit blows up as soon as balls meet; without tension, as users have
// it.
TEST(Watch, CatchesABedWithTwiceTheLimit) {
  SceneBuilder builder = dropped(0.7);
  // In a bed of z = 6 with k_s = 0.5 every ball has λ of some 10: twice 2/√10, damped, is 1.
  Cycle cycle = cycle_of(builder, 1.0);
  Watch watch(cycle.state());
  std::optional<Trouble> trouble;
  for (int looks = 0; looks < 2000 && !trouble; ++looks) {
    cycle.run(10);
    trouble = watch.look(cycle.state());
  }
  ASSERT_TRUE(trouble.has_value());
  EXPECT_TRUE(all_finite(cycle.state())) << trouble->what;
  EXPECT_FALSE(trouble->bodies.empty());
  EXPECT_LE(trouble->bodies.size(), 5U);
}

TEST(Watch, LeavesABedAloneThatSettlesWithTheStepOfAPolicy) {
  for (const double alpha : {0.0, 0.7})
    for (const auto policy : {model::TimestepPolicy::estimate, model::TimestepPolicy::bound}) {
      SceneBuilder builder = dropped(alpha);
      builder.scene().timestep.policy = policy;
      Cycle cycle(cycle::start(builder.scene()), cycle::policy_of(builder.scene()));
      Watch watch(cycle.state());
      for (int looks = 0; looks < 100; ++looks) {
        cycle.run(20);
        const auto trouble = watch.look(cycle.state());
        ASSERT_FALSE(trouble.has_value())
            << told(trouble) << ", alpha " << alpha << ", time " << cycle.state().time;
      }
    }
}

TEST(Watch, LeavesAGasOfCollidingBallsAlone) {
  std::mt19937_64 random(6);
  SceneBuilder builder({.kn = 1, .ks = 0, .tension = false});
  for (int i = 0; i < 64; ++i)
    builder.ball(2.6 * Vec3(i % 4 + 0.5, i / 4 % 4 + 0.5, i / 16 + 0.5)).moving(0.03 * random_vector(random));
  builder.periodic(Vec3::Constant(10.4));
  Cycle cycle = cycle_of(builder, 0.2);
  Watch watch(cycle.state());
  for (int looks = 0; looks < 100; ++looks) {
    cycle.run(50);
    const auto trouble = watch.look(cycle.state());
    ASSERT_FALSE(trouble.has_value()) << told(trouble);
  }
}

// At a coarse step an impact errs by up to ¼Δt²k/m of its energy: a ball may rise above where it was dropped,
// and there it has energy while gravity has released less than nothing.
TEST(Watch, LeavesABallAloneThatBouncesHigherThanItBegan) {
  SceneBuilder builder({.kn = 1, .ks = 0, .tension = false});
  builder.plane({0, 0, 0}, {0, 0, 1}).ball({0, 0, 1.7}).gravity({0, 0, -1e-3});
  Cycle cycle = cycle_of(builder, 0.8);
  Watch watch(cycle.state());
  double highest = 0;
  for (int looks = 0; looks < 2000; ++looks) {
    cycle.run(7);
    highest = std::max(highest, cycle.state().model.bodies.position[0].z());
    const auto trouble = watch.look(cycle.state());
    ASSERT_FALSE(trouble.has_value())
        << told(trouble) << " at height " << cycle.state().model.bodies.position[0].z();
  }
  EXPECT_GT(highest, 1.7);
}

// What is not a blow-up, though energy comes from nowhere that the watch looks: a ball that slides down a
// slope along a periodic axis (its height comes back with every turn around the cell, its speed does not).
TEST(Watch, LeavesABallAloneThatFallsAlongAPeriodicAxis) {
  SceneBuilder builder({.kn = 1, .ks = 0, .tension = false});
  builder.ball({1, 1, 1}).periodic(Vec3(4, 4, 4)).gravity({1e-5, 0, 0});
  Cycle cycle = cycle_of(builder, 0.2);
  Watch watch(cycle.state());
  for (int looks = 0; looks < 100; ++looks) {
    cycle.run(200);
    const auto trouble = watch.look(cycle.state());
    ASSERT_FALSE(trouble.has_value()) << told(trouble) << " at speed " << velocity_of(cycle.state(), 0).x();
  }
}

// And a press: a ball with a given velocity does work on others, far more than its own kinetic energy.
TEST(Watch, LeavesASlowPressAlone) {
  SceneBuilder builder({.kn = 1, .ks = 0, .tension = false});
  builder.plane({0, 0, 0}, {0, 0, 1}).damped(0.7);
  for (int i = 0; i < 5; ++i) builder.ball({0, 0, 1 + 2.0 * i});
  builder.ball({0, 0, 11}, 1, 1, fix_all).moving({0, 0, -1e-4});
  Cycle cycle = cycle_of(builder, 0.3);
  Watch watch(cycle.state());
  for (int looks = 0; looks < 50; ++looks) {
    cycle.run(200);  // to a way of 0.3 in all
    const auto trouble = watch.look(cycle.state());
    ASSERT_FALSE(trouble.has_value()) << told(trouble);
  }
}

}  // namespace
}  // namespace eigengrain::test
