// The unbalanced ratio of scenes that can be added up by hand.
#include "eigengrain/assembly/balance.hpp"

#include "eigengrain/io/scene_reader.hpp"

#include "support/motion.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>

namespace eigengrain::test {
namespace {

using assembly::Balance;

Balance balance_of(SceneBuilder builder) {
  return assembly::balance_of(cycle::start(builder.scene()));
}

constexpr Springs grains{.kn = 1, .ks = 0.5, .tension = false};
constexpr double g = 0x1p-10;

SceneBuilder on_floor(double overlap, model::FixedComponents fixed = {}) {
  SceneBuilder builder(grains);
  builder.ball({0, 0, 1 - overlap}, 1, 1, fixed).plane({0, 0, 0}, {0, 0, 1}).gravity({0, 0, -g});
  return builder;
}

// Powers of two: exact.
TEST(Balance, OfABallAtRestIsZero) {
  const Balance balance = balance_of(on_floor(g));
  EXPECT_EQ(balance.mean, 0);
  EXPECT_EQ(balance.max, 0);
  EXPECT_EQ(balance.moment_mean, 0);
  EXPECT_EQ(balance.bodies, 1);
  EXPECT_EQ(balance.contacts, 1);
  EXPECT_EQ(balance.unsupported, 0);
  EXPECT_EQ(balance.mean_contact_force, g);
}

// Contact 4g, weight g: resultant 3g over a mean contact force of 4g.
TEST(Balance, IsTheResultantOverTheContactForce) {
  const Balance balance = balance_of(on_floor(4 * g));
  EXPECT_EQ(balance.mean, 0.75);
  EXPECT_EQ(balance.max, 0.75);
}

// Two balls on the floor and no more: resultants 3g and g, contact forces 4g and 2g.
TEST(Balance, TakesMeansAndTheLargestOverBodies) {
  const Balance balance = balance_of(on_floor(4 * g).ball({5, 0, 1 - 2 * g}));
  EXPECT_DOUBLE_EQ(balance.mean, 2.0 / 3.0);
  EXPECT_DOUBLE_EQ(balance.max, 1);
  EXPECT_EQ(balance.mean_contact_force, 3 * g);
}

// A ball in the air is no part of the ratio, but it is in the way of an equilibrium; a fixed one is not.
TEST(Balance, CountsWhatHangsInTheAir) {
  const SceneBuilder builder = on_floor(4 * g)
                                   .ball({5, 0, 3})
                                   .ball({9, 0, 3}, 1, 1, fix_all)
                                   .ball({13, 0, 3}, 1, 1, model::FixedComponents(0b000100));  // held along z
  const Balance balance = balance_of(builder);
  EXPECT_EQ(balance.unsupported, 1);
  EXPECT_EQ(balance.bodies, 1);
  EXPECT_EQ(balance.mean, 0.75);
  EXPECT_EQ(balance_of(SceneBuilder(grains).ball({0, 0, 0})).unsupported,
            0);  // without gravity nothing pulls
}

// Without a contact there is no force to compare with.
TEST(Balance, WithoutContactsIsZeroAndUnsupported) {
  const Balance balance = balance_of(SceneBuilder(grains).ball({0, 0, 3}).gravity({0, 0, -g}));
  EXPECT_EQ(balance.mean, 0);
  EXPECT_EQ(balance.contacts, 0);
  EXPECT_EQ(balance.unsupported, 1);
}

// A component that keeps its velocity needs no balance; a body that is fixed entirely is not counted.
TEST(Balance, LeavesFixedComponentsOut) {
  EXPECT_EQ(balance_of(on_floor(4 * g, model::FixedComponents(0b000100))).mean, 0);
  EXPECT_EQ(balance_of(on_floor(4 * g, model::FixedComponents(0b000011))).mean, 0.75);
  const Balance fixed = balance_of(on_floor(4 * g, fix_all));
  EXPECT_EQ(fixed.bodies, 0);
  EXPECT_EQ(fixed.contacts, 1);
}

// A shear force F_s at the floor has the moment (R - U/2) F_s; over R, over the contact force √(F_n² + F_s²).
TEST(Balance, GivesMomentsOverTheRadius) {
  SceneBuilder builder = on_floor(g);
  assembly::State state = cycle::start(builder.scene());
  cycle::Cycle cycle = cycle_of(on_floor(g).moving({g / 8, 0, 0}), 1.0);
  cycle.step();  // k_s v Δt = g/16, below μ F_n = g/2
  const Balance balance = assembly::balance_of(cycle.state());
  const double shear = g / 16;
  const double contact = std::hypot(g, shear);
  EXPECT_NEAR(balance.moment_mean, (1 - g / 2) * shear / contact, 1e-14);
  EXPECT_EQ(balance.moment_mean, balance.moment_max);
  EXPECT_NEAR(balance.mean, shear / contact, 1e-14);
}

// Positions in metres of the packing of 10,000: an ulp of x times k_n is a mean residual of 1.4e-11 (found
// independently, docs of the data). The floor is a model of it: the same order.
TEST(Balance, KnowsTheRoundingOfPositions) {
  const model::Scene scene = io::read_scene(EIGENGRAIN_EXAMPLES "/scenes/packing_10k.yaml");
  const Balance balance = assembly::balance_of(cycle::start(scene));
  std::printf("10k packing: floor %.2e, mean ratio %.2e, %lld unsupported\n", balance.floor, balance.mean,
              static_cast<long long>(balance.unsupported));
  EXPECT_GT(balance.floor, 0.5e-11);
  EXPECT_LT(balance.floor, 3e-11);
}

// And of one ball: its z of 0.999 is known to an ulp of 1.1e-16, spread evenly: 1.1e-16/√12 of a force g.
TEST(Balance, FloorOfABallIsAnUlpOfItsHeight) {
  EXPECT_NEAR(balance_of(on_floor(g)).floor, 0x1p-53 / std::sqrt(12.0) / g, 1e-6 * 0x1p-53 / g);
}

}  // namespace
}  // namespace eigengrain::test
