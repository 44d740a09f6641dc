// Averages over regions with clumps: one body each.
#include "eigengrain/measures/measure.hpp"

#include "support/clumps.hpp"

#include <gtest/gtest.h>

#include <numbers>

namespace eigengrain::test {
namespace {

using namespace measures;

constexpr double pressed = 0.01;

/// A dumbbell between two plates that press each of its balls by `pressed`.
assembly::Model between_plates() {
  SceneBuilder builder({.kn = 100, .tension = false});
  builder.clump(dumbbell(), {.position = {0.3, 0.4, 1 - pressed},
                             .orientation = Quat(Eigen::AngleAxisd(0.4, Vec3::UnitZ())),
                             .velocity = {1, 2, 3},
                             .spin = {0, 0, 5}});
  builder.plane(Vec3::Zero(), Vec3::UnitZ()).plane({0, 0, 2 - 2 * pressed}, -Vec3::UnitZ());
  return builder.build();
}

model::Region box() {
  return {"box", model::BoxRegion{{-3, -3, 0}, {4, 4, 2 - 2 * pressed}}};
}

TEST(ClumpMeasures, HaveTheStressOfThePlates) {
  const assembly::Model model = between_plates();
  const std::vector<model::Region> regions{box()};
  const Measure found = measure(model, regions)[0];
  // Two forces of k U on each plate, 2 - 2U apart: σ_zz V = -Σ F h, and nothing else.
  Mat3 expected = Mat3::Zero();
  expected(2, 2) = -2 * 100 * pressed * (2 - 2 * pressed) / found.volume;
  // Branches that reach from the clump's centre to the points where the plates push: x and y cancel.
  EXPECT_LT((found.stress - expected).norm(), 1e-14);
  // Of the body itself: up to the contact points, which lie ½U behind the plates.
  const double volume = model.bodies.clumps.volume[0];
  Mat3 whole = Mat3::Zero();
  whole(2, 2) = -2 * 100 * pressed * (2 - pressed);
  for (const Mat3& own : body_stresses(model)) EXPECT_LT((own * volume - whole).norm(), 1e-12);
}

TEST(ClumpMeasures, CountAClumpOnce) {
  const assembly::Model model = between_plates();
  const std::vector<model::Region> regions{box()};
  const Measure found = measure(model, regions)[0];
  EXPECT_EQ(found.fabric.bodies, 1);
  EXPECT_EQ(found.fabric.coordination, 4);
  // The plates cut four caps of height U off: π U² (3R - U)/3 each, in the parts that balls have of the
  // union.
  const double ball = 4 * std::numbers::pi / 3;
  const double volume = model.bodies.clumps.volume[0];
  const double cap = std::numbers::pi * pressed * pressed * (3 - pressed) / 3;
  EXPECT_NEAR((1 - found.porosity) * found.volume, volume - 4 * cap * volume / (2 * ball), 1e-12);
}

TEST(ClumpMeasures, TakeTheVelocityOfTheCentre) {
  // v = L x of four clumps that also spin, each on its own.
  SceneBuilder builder;
  Mat3 gradient;
  gradient << 1, 2, 0, -1, 0.5, 3, 0, 0.2, -0.7;
  const Vec3 places[] = {{0, 0, 0}, {10, 0, 0}, {0, 10, 0}, {0, 0, 10}};
  for (const Vec3& at : places)
    builder.clump(odd_shape(), {.position = at, .velocity = gradient * at, .spin = at + Vec3(1, 2, 3)});
  const std::vector<model::Region> regions{{"all", model::WholeRegion{}}};
  const Measure found = measure(builder.build(), regions)[0];
  ASSERT_TRUE(found.velocity_gradient);
  EXPECT_LT((*found.velocity_gradient - gradient).norm(), 1e-13);
  EXPECT_EQ(found.fabric.bodies, 4);
  EXPECT_EQ(found.fabric.rattlers, 4);
}

}  // namespace
}  // namespace eigengrain::test
