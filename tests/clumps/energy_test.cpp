// The energy of clumps that hit walls and each other.
#include "eigengrain/assembly/balance.hpp"
#include "eigengrain/assembly/energies.hpp"
#include "eigengrain/assembly/forces.hpp"

#include "support/clumps.hpp"
#include "support/motion.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

namespace eigengrain::test {
namespace {

/// Two balls in one body that fly obliquely onto a wall without friction.
SceneBuilder oblique_impact() {
  SceneBuilder builder({.kn = 1e4, .tension = false});
  builder.clump(dumbbell(), {.position = {0, 0, 2.2},
                             .orientation = Quat(Eigen::AngleAxisd(0.5, Vec3::UnitY())),
                             .velocity = {0.3, 0, -1},
                             .spin = {0.4, 0.2, 0.1}});
  builder.plane(Vec3::Zero(), Vec3::UnitZ());
  return builder;
}

double mechanical(const assembly::State& state) {
  const assembly::Energies e = assembly::energies_of(state);
  return e.kinetic + e.elastic;
}

TEST(ClumpEnergy, IsKeptInAnImpactOnAWall) {
  // Only the kinks where contacts begin and end cost or give: up to ¼Δt²k/m each (docs/theory.md), and the
  // error of the free rotation, which is of the same order. So it falls by four with the step.
  std::vector<double> lost;
  for (const int fine : {1, 2, 4, 8}) {
    const double dt = 1e-3 / fine;
    cycle::Cycle cycle = cycle_of(oblique_impact(), dt);
    cycle.step();
    const double before = mechanical(cycle.state());
    double most = 0;
    double largest_elastic = 0;
    for (int k = 0; k < 3000 * fine; ++k) {
      cycle.step();
      largest_elastic = std::max(largest_elastic, assembly::energies_of(cycle.state()).elastic);
      if (assembly::energies_of(cycle.state()).elastic == 0)
        most = std::max(most, std::abs(mechanical(cycle.state()) / before - 1));
    }
    EXPECT_GT(largest_elastic, 0.2 * before);  // it was an impact
    EXPECT_GT(cycle.state().model.bodies.clumps.velocity[0].z(), 0);
    lost.push_back(most);
  }
  const double mass = dumbbell().mass;
  EXPECT_LT(lost[0],
            2 * 0.25 * 1e-6 * 1e4 / mass * 10);  // lighter at its ends: some times the bound of a ball
  EXPECT_LT(lost[3], lost[0] / 16);  // at least of the order 4/3 in the mean of the phases; two are expected
}

TEST(ClumpEnergy, IsTheTensorsInFlight) {
  SceneBuilder builder;
  const Vec3 spin(0.4, -0.2, 0.7);
  const Quat q(Eigen::AngleAxisd(1.1, Vec3(1, 2, 3).normalized()));
  const model::ClumpShape shape = odd_shape();
  builder.clump(shape, {.orientation = q, .velocity = {1, 2, 3}, .spin = spin});
  const assembly::Energies e = assembly::energies_of(cycle_of(builder, 0.1).state());
  const Mat3 tensor = q.toRotationMatrix() * shape.inertia.asDiagonal() * q.toRotationMatrix().transpose();
  EXPECT_NEAR(e.kinetic, 0.5 * shape.mass * 14 + 0.5 * spin.dot(tensor * spin), 1e-13 * e.kinetic);
  EXPECT_EQ(e.kinetic, e.kinetic_product);  // no force, and no step yet
}

TEST(ClumpEnergy, IsConservedByALinearSystemOverManySteps) {
  // Two clumps held by springs that vibrate by 1e-7: the discrete energy ½ v₋·M v₊ + elastic is that of
  // leapfrog in a linear system, up to the second order of the amplitude.
  std::mt19937_64 random(35);
  SceneBuilder builder = touching_pair({.kn = 1, .ks = 0.5, .tension = true}, random);
  model::Clumps& clumps = builder.scene().bodies.clumps;
  const Vec3 spin(1e-7, 2e-7, -1e-7);
  clumps.angular_momentum[0] = model::angular_momentum(clumps, 0, spin);
  clumps.velocity[1] = Vec3(1e-7, 0, -2e-7);
  cycle::Cycle cycle = cycle_of(builder, 0.3);
  cycle.step();
  const auto discrete = [&] {
    const assembly::Energies e = assembly::energies_of(cycle.state());
    return e.kinetic_product + e.elastic;
  };
  const double before = discrete();
  ASSERT_GT(before, 1e-20);
  double most = 0;
  for (int k = 0; k < 200; ++k) {
    cycle.run(50);
    most = std::max(most, std::abs(discrete() / before - 1));
  }
  EXPECT_LT(most, 1e-5);
}

TEST(ClumpEnergy, OfARestingClumpIsBalanced) {
  // A dumbbell lies on two floors' worth of contacts: after damping its resultants vanish.
  SceneBuilder builder({.kn = 1e4, .ks = 5e3, .tension = false, .friction = 0.5});
  builder.clump(dumbbell(),
                {.position = {0, 0, 1.3}, .orientation = Quat(Eigen::AngleAxisd(0.2, Vec3::UnitY()))});
  builder.plane(Vec3::Zero(), Vec3::UnitZ()).gravity({0, 0, -9.81}).damped(0.7);
  cycle::Cycle cycle = cycle_of(builder, 1e-3);
  EXPECT_EQ(assembly::balance_of(cycle.state()).unsupported, 1);  // one body, of two balls
  cycle.run(20000);
  const assembly::Balance balance = assembly::balance_of(cycle.state());
  EXPECT_EQ(balance.bodies, 1);
  EXPECT_EQ(balance.contacts, 2);
  EXPECT_EQ(balance.unsupported, 0);
  EXPECT_LT(balance.max, 1e-9);
  EXPECT_LT(balance.moment_max, 1e-9);
  EXPECT_NEAR(assembly::wall_forces(cycle.state().model)[0].z(), -dumbbell().mass * 9.81, 1e-6);
}

}  // namespace
}  // namespace eigengrain::test
