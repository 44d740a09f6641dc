// Where walls go: tables of velocities, exact rotation, loads on walls.
#include "eigengrain/model/wall_motion.hpp"

#include "eigengrain/assembly/forces.hpp"

#include "support/scenes.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

namespace eigengrain::model {
namespace {

TEST(WallMotion, IsLinearBetweenTheRowsAndConstantOutside) {
  const WallMotion motion{
      0, Vec3::Zero(), {1, 3, 4}, {{{0, 0, 0}, {0, 0, 8}}, {{2, 0, -4}, {0, 0, 0}}, {{2, 1, 0}, {1, 0, 0}}}};
  EXPECT_EQ(motion.at(-5).translation, Vec3(0, 0, 0));
  EXPECT_EQ(motion.at(1).spin, Vec3(0, 0, 8));
  EXPECT_EQ(motion.at(1.5).translation, Vec3(0.5, 0, -1));
  EXPECT_EQ(motion.at(1.5).spin, Vec3(0, 0, 6));
  EXPECT_EQ(motion.at(3).translation, Vec3(2, 0, -4));
  EXPECT_EQ(motion.at(3.5).translation, Vec3(2, 0.5, -2));
  EXPECT_EQ(motion.at(100).translation, Vec3(2, 1, 0));
  EXPECT_EQ(motion.at(100).spin, Vec3(1, 0, 0));
}

TEST(WallPose, TurnsAboutACentreThatMoves) {
  const Vec3 start(1, 2, 3);
  constexpr int steps = 1000;
  WallPose pose{.centre = start};
  const Vec3 axis = Vec3(1, -2, 0.5).normalized();
  for (int k = 0; k < steps; ++k) pose = pose.moved({1e-3, 0, 0}, 2 * std::numbers::pi / steps * axis);
  // A full turn, and a way of one: a point is back where it was, one further. A product of 1000 quaternions
  // rounds to some 1e-14; the linear form of eq. 1.28 would end 2% too far out.
  const Vec3 x(4, -1, 2);
  EXPECT_LT((pose.point(x, start) - (x + Vec3(1, 0, 0))).norm(), 1e-12);
}

TEST(WallPose, WithoutATurnKeepsTheBitsOfAPlane) {
  const Plane plane{{0.1, 0.2, 0.3}, Vec3(1, 1, 1).normalized(), 0, "", {0.1, 0.2, 0.3}};
  const WallMotion motion{0, plane.centre, {0}, {{Vec3(1, 0, 0), Vec3::Zero()}}};
  Plane moved = plane;
  carry(plane, motion, WallPose{.centre = plane.centre}.moved({0.5, 0, 0}, Vec3::Zero()), moved);
  EXPECT_EQ(moved.normal, plane.normal);
  EXPECT_EQ(moved.point, Vec3(0.1 + 0.5, 0.2, 0.3));
  EXPECT_EQ(moved.centre, moved.point);
}

TEST(WallLoads, AreForceAndMomentAboutTheCentre) {
  // Two balls press on a floor with forces k U = 0.1 and 0.2 at x_C = x - (1 - U/2) z.
  test::SceneBuilder builder({.kn = 1, .tension = false});
  builder.ball({3, 0, 0.9}).ball({0, 5, 0.8}).plane(Vec3::Zero(), Vec3::UnitZ());
  builder.scene().walls.back().centre = {1, 1, 0};
  const auto loads = assembly::wall_loads(builder.build());
  ASSERT_EQ(loads.size(), 1U);
  EXPECT_LT((loads[0].force - Vec3(0, 0, -0.3)).norm(), 1e-15);
  const Vec3 first = Vec3(2, -1, 0).cross(Vec3(0, 0, -0.1));
  const Vec3 second = Vec3(-1, 4, 0).cross(Vec3(0, 0, -0.2));
  EXPECT_LT((loads[0].moment - first - second).norm(), 1e-14);
}

}  // namespace
}  // namespace eigengrain::model
