// The orientation of bodies: there only where bonds ask for it, turned exactly, unit, untouched by trial
// states.
#include "support/bonds.hpp"
#include "support/motion.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

namespace eigengrain::test {
namespace {

using contact::turned;

/// Twice the sine of half the angle between two orientations.
double between(const Quat& a, const Quat& b) {
  return 2 * (a * b.conjugate()).vec().norm();
}

TEST(Orientation, IsThereOnlyWhereABondInTotalFormAsksForIt) {
  SceneBuilder pair(Springs{.ks = 0.5});
  pair.ball({0, 0, 0}).ball({2, 0, 0});
  EXPECT_TRUE(cycle::start(pair.scene()).model.bodies.orientation.empty());
  EXPECT_TRUE(cycle::start(SceneBuilder(pair).bonded(Cemented{.incremental = true}.rule()).scene())
                  .model.bodies.orientation.empty());
  EXPECT_EQ(
      cycle::start(SceneBuilder(pair).bonded(Cemented{}.rule()).scene()).model.bodies.orientation.size(), 2U);
}

TEST(Orientation, TurnsExactlyWithAConstantSpin) {
  // A free ball beside another: a whole number of steps of any size ends at exp(w t).
  const Vec3 spin(0.3, -0.2, 0.5);
  SceneBuilder builder;
  builder.ball({0, 0, 0}).ball({9, 0, 0}).moving(Vec3::Zero(), spin).bonded(Cemented{}.rule());
  for (const double dt : {0.01, 0.5, 2.0}) {
    cycle::Cycle cycle = cycle_of(builder, dt);
    cycle.run(1000);
    const double angle = 1000 * dt * spin.norm();
    const Quat expected(Eigen::AngleAxisd(angle, spin.normalized()));
    // 1000 products of an ulp, and an ulp of the angle.
    EXPECT_LT(between(cycle.state().model.bodies.orientation[row_of(cycle.state(), 1)], expected),
              2e-16 * (1000 + angle))
        << dt;
  }
}

TEST(Orientation, IsThatOfTheRotationVectorWhateverItsSize) {
  std::mt19937_64 random(1);
  for (const double size : {0.0, 1e-300, 1e-9, 1e-2, 0.02, 1.0, 3.0}) {
    const Vec3 theta = size * random_vector(random).normalized();
    const Quat start(random_rotation(random));
    const Quat expected =
        Quat(Eigen::AngleAxisd(size, size > 0 ? theta.normalized() : Vec3(Vec3::UnitX()))) * start;
    // Cosine and sine of half the angle are right to rounding up to a radian, and to 1e-13 at one and a half.
    EXPECT_LT(between(turned(start, theta), expected), size > 2 ? 3e-13 : 1e-15) << size;
  }
}

TEST(Orientation, StaysUnitOverAMillionSteps) {
  std::mt19937_64 random(2);
  Quat q = Quat::Identity();
  const Vec3 theta = 0.01 * random_vector(random);
  double worst = 0;
  for (int step = 0; step < 1000000; ++step) {
    q = turned(q, theta);
    worst = std::max(worst, std::abs(q.squaredNorm() - 1));
  }
  // Of the last product and correction alone; without the correction it is 1e-13 and grows.
  EXPECT_LT(worst, 1e-15);
}

TEST(Orientation, OfATrialStateIsNotThatOfTheModel) {
  std::mt19937_64 random(3);
  SceneBuilder builder = random_cluster(random, 4, {});
  assembly::Model model = builder.bonded(Cemented{}.rule()).build();
  const auto before = model.bodies.orientation;
  assembly::Displacement d = no_displacement(model);
  for (Vec3& theta : d.rotation) theta = random_vector(random);
  const std::vector<Quat> trial = assembly::turned_orientations(model.bodies, d.rotation);
  assembly::contact_forces(model, d);
  for (std::size_t i = 0; i < before.size(); ++i) {
    EXPECT_EQ(model.bodies.orientation[i].coeffs(), before[i].coeffs());
    EXPECT_LT(between(trial[i], turned(before[i], d.rotation[i])), 1e-16);
  }
}

}  // namespace
}  // namespace eigengrain::test
