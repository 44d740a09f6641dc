// A block on an incline: four balls bonded to a plate, under gravity that is tilted by θ.
#include "eigengrain/assembly/forces.hpp"

#include "support/bonds.hpp"
#include "support/laws.hpp"
#include "support/motion.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <numbers>

namespace eigengrain::test {
namespace {

constexpr double friction = 0.4;
constexpr double g = 10;
constexpr double stiffness = 1e6;

/// Mass 4, laid down with the overlap that its weight makes.
SceneBuilder block_on(double degrees, double local_damping) {
  const double angle = degrees * std::numbers::pi / 180;
  SceneBuilder builder = with_law(
      "linear", {{"kn", stiffness}, {"ks", 0.5 * stiffness}, {"friction", friction}, {"beta_n", 0.5}});
  const double height = 1 - g * std::cos(angle) / stiffness;
  for (const double x : {-1, 1})
    for (const double y : {-1, 1}) builder.ball({x, y, height});
  return builder.bonded(Cemented{.kn = 10 * stiffness, .ks = 6 * stiffness}.rule())
      .plane({0, 0, 0}, {0, 0, 1})
      .gravity(g * Vec3(std::sin(angle), 0, -std::cos(angle)))
      .damped(local_damping);
}

Vec3 momentum(const assembly::State& state) {
  Vec3 sum = Vec3::Zero();
  for (std::size_t i = 0; i < state.model.bodies.mass.size(); ++i)
    sum += state.model.bodies.mass[i] * state.model.bodies.velocity[i];
  return sum;
}

// a = g (sin θ - μ cos θ): friction raises one edge and presses the other down, and its sum is μ N all the
// same. Rounding of velocities over 20,000 steps remains.
TEST(Incline, ABlockSlidesWithTheAccelerationOfCoulombsLaw) {
  for (const double degrees : {25.0, 40.0}) {
    const double angle = degrees * std::numbers::pi / 180;
    cycle::Cycle cycle = cycle_of(block_on(degrees, 0), 5e-5);
    cycle.run(20000);  // until the dashpots have stilled the plate
    const Vec3 before = momentum(cycle.state());
    const double start = cycle.state().time;
    cycle.run(20000);
    const Vec3 acceleration = (momentum(cycle.state()) - before) / (4 * (cycle.state().time - start));
    EXPECT_NEAR(acceleration.x(), g * (std::sin(angle) - friction * std::cos(angle)), 1e-8) << degrees;
    EXPECT_NEAR(acceleration.y(), 0, 1e-10);
    // No ball rolls, which would be a spin as large as the velocity; the bonds go on trembling.
    EXPECT_GT(velocity_of(cycle.state(), 0).x(), 1.0);
    for (const Vec3& w : cycle.state().model.bodies.spin) EXPECT_LT(w.norm(), 1e-3);
  }
}

TEST(Incline, ABlockRestsBelowTheAngleOfFriction) {
  constexpr double degrees = 20;  // arctan 0.4 = 21.8
  const double angle = degrees * std::numbers::pi / 180;
  cycle::Cycle cycle = cycle_of(block_on(degrees, 0.7), 5e-5);
  const double start = position_of(cycle.state(), 0).x();
  cycle.run(50000);
  // Positions of order 1 m are rounded to an ulp, which the stiffest springs, the bonds', turn into √(k/m)
  // ulps of velocity.
  const double ulp = std::numeric_limits<double>::epsilon();
  EXPECT_LT(momentum(cycle.state()).norm(), 4 * std::sqrt(10 * stiffness) * ulp);
  const Vec3 on_floor = assembly::wall_forces(cycle.state().model)[0];
  EXPECT_NEAR(on_floor.x(), 4 * g * std::sin(angle), 1e-9);
  EXPECT_NEAR(on_floor.z(), -4 * g * std::cos(angle), 1e-9);
  // The springs of four contacts gave way, no more: m g sin θ/k_s, and the plate leans a little.
  EXPECT_NEAR(position_of(cycle.state(), 0).x() - start, g * std::sin(angle) / (0.5 * stiffness), 1e-5);
}

}  // namespace
}  // namespace eigengrain::test
