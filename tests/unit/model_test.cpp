#include "eigengrain/model/bodies.hpp"
#include "eigengrain/model/surroundings.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <numbers>
#include <random>

namespace eigengrain::model {
namespace {

TEST(FixedComponents, KnowsItsTwoVectors) {
  FixedComponents fixed;
  EXPECT_FALSE(fixed.all());
  fixed.fix(0);
  fixed.fix(5);
  EXPECT_EQ(fixed.translation(), 1);
  EXPECT_EQ(fixed.rotation(), 4);
  EXPECT_TRUE(fixed.component(5));
  EXPECT_FALSE(fixed.component(4));
  EXPECT_TRUE(FixedComponents(63).all());
}

TEST(Sphere, MassAndInertia) {
  const double mass = sphere_mass(2.0, 3.0);
  EXPECT_DOUBLE_EQ(mass, 32.0 * std::numbers::pi);
  EXPECT_DOUBLE_EQ(sphere_inertia(2.0, mass), 1.6 * mass);
}

TEST(PeriodicCell, WrapsOnlyAlongItsAxesAndIntoTheHalfOpenCell) {
  const PeriodicCell cell = PeriodicCell::box({1, 0, 0}, {2, 1, 1}, {true, false, true});
  EXPECT_EQ(cell.wrapped({3, 7, -0.25}), Vec3(1, 7, 0.75));
  EXPECT_EQ(cell.wrapped({0.5, 0, 1}), Vec3(2.5, 0, 0));
  // The largest double below zero: adding the length rounds to the upper end, which is the lower end.
  EXPECT_LT(cell.wrapped({1, 0, -1e-300}).z(), 1.0);
  EXPECT_EQ(cell.shift(Image{-1, 0, 2}), Vec3(-2, 0, 2));
}

TEST(SortAlongCurve, IsAPermutationThatShortensTheWay) {
  std::mt19937_64 random(7);
  std::uniform_real_distribution<double> uniform(0, 1);
  Bodies bodies;
  constexpr int n = 4000;
  for (int i = 0; i < n; ++i) {
    bodies.identity.push_back(i);
    bodies.position.emplace_back(uniform(random), uniform(random), uniform(random));
    bodies.radius.push_back(i);
    bodies.mass.push_back(1);
    bodies.inertia.push_back(1);
    bodies.material.push_back(0);
    bodies.fixed.emplace_back();
  }
  const auto way = [](const Bodies& b) {
    double sum = 0;
    for (std::size_t i = 1; i < b.position.size(); ++i) sum += (b.position[i] - b.position[i - 1]).norm();
    return sum;
  };
  const Bodies before = bodies;
  sort_along_curve(bodies);
  // Mean step: about 0.66 in random order, a few cells of size n^(-1/3) = 0.063 along the curve.
  EXPECT_LT(way(bodies), 0.2 * way(before));
  std::vector<std::int64_t> identities = bodies.identity;
  for (std::size_t i = 0; i < identities.size(); ++i) {
    EXPECT_EQ(bodies.position[i], before.position[static_cast<std::size_t>(identities[i])]);
    EXPECT_EQ(bodies.radius[i], static_cast<double>(identities[i]));
  }
  std::sort(identities.begin(), identities.end());
  for (std::size_t i = 0; i < identities.size(); ++i) EXPECT_EQ(identities[i], static_cast<std::int64_t>(i));
}

}  // namespace
}  // namespace eigengrain::model
