// Balls of a clump: where they are, what is listed between them, and how forces come together.
#include "eigengrain/assembly/contact_list.hpp"

#include "support/clumps.hpp"
#include "support/motion.hpp"

#include <gtest/gtest.h>

#include <random>

namespace eigengrain::test {
namespace {

TEST(Members, HaveNoContactsAmongThemselves) {
  SceneBuilder builder({.kn = 1});
  builder.clump(odd_shape(), {});
  builder.clump(dumbbell(), {.position = {20, 0, 0}});
  EXPECT_EQ(builder.build().contacts.size(), 0);
  EXPECT_EQ(assembly::build_model(builder.scene(), 5.0).contacts.size(), 0);
}

TEST(Members, ButTouchTheirClumpsImages) {
  // Two balls 1.4 apart in a cell of 3.3: ball 1 and the image of ball 0 are 1.9 apart, each and its own 3.3.
  SceneBuilder builder({.kn = 1});
  builder.clump(dumbbell(), {.position = {1, 1, 1}});
  builder.periodic({3.3, 10, 10}, {true, false, false});
  const assembly::Model model = builder.build();
  EXPECT_EQ(model.contacts.size(), 1);
  EXPECT_NEAR(assembly::contact_forces(model).force[0].norm(), 0.1, 1e-12);
}

TEST(Members, KeepTheirRowsWhenBodiesAreSorted) {
  std::mt19937_64 random(21);
  SceneBuilder builder;
  for (int k = 0; k < 20; ++k) builder.ball(10 * random_vector(random));
  for (int k = 0; k < 10; ++k)
    builder.clump(k % 2 == 0 ? odd_shape() : dumbbell(),
                  {.position = 10 * random_vector(random), .orientation = random_orientation(random)});
  const assembly::Model model = builder.build();
  const model::Bodies& bodies = model.bodies;
  const model::Clumps& clumps = bodies.clumps;
  std::int64_t identity = 20;
  for (std::int32_t c = 0; c < clumps.size(); ++c)
    for (const std::int32_t row : clumps.members(c)) {
      EXPECT_EQ(bodies.identity[static_cast<std::size_t>(row)], identity++);
      EXPECT_EQ(clumps.of(row), c);
      EXPECT_EQ(clumps.owner(row), clumps.holder(c));
    }
  for (std::int32_t row = 0; row < bodies.size(); ++row)
    if (bodies.identity[static_cast<std::size_t>(row)] < 20) {
      EXPECT_EQ(clumps.owner(row), row);
    }
  // And where they are.
  model::Bodies placed = bodies;
  model::place_members(placed);
  for (std::size_t i = 0; i < placed.position.size(); ++i) EXPECT_EQ(placed.position[i], bodies.position[i]);
}

TEST(Members, GoThroughACellTogether) {
  SceneBuilder builder({.kn = 1, .tension = false});
  builder.clump(dumbbell(), {.position = {3, 5, 5}, .velocity = {1, 0, 0}, .spin = {0, 0.3, 1}});
  builder.periodic({10, 10, 10});
  cycle::Cycle cycle = cycle_of(builder, 0.01);
  for (int k = 0; k < 3000; ++k) {
    cycle.step();
    const model::Bodies& bodies = cycle.state().model.bodies;
    const Vec3 middle = 0.5 * (bodies.position[0] + bodies.position[1]);
    ASSERT_LT((middle - bodies.clumps.position[0]).norm(), 1e-12);
    ASSERT_NEAR((bodies.position[0] - bodies.position[1]).norm(), 1.4, 1e-12);
  }
  const Vec3& x = cycle.state().model.bodies.clumps.position[0];
  EXPECT_GE(x.x(), 0);  // wrapped, up to what a list lasts
  EXPECT_LT(x.x(), 10.1);
  EXPECT_GT(cycle.state().list.rebuilds, 10);
}

TEST(Members, DisplacementsOfTheCycleAreExact) {
  // velocity · dt is x_new - x_old and spin · dt the rotation of the step, which is what contacts are given.
  SceneBuilder builder;
  builder.clump(odd_shape(), {.velocity = {0.1, 0.2, -0.3}, .spin = {0.7, -0.4, 0.2}});
  constexpr double dt = 0.2;
  cycle::Cycle cycle = cycle_of(builder, dt);
  for (int k = 0; k < 100; ++k) {
    const model::Bodies before = cycle.state().model.bodies;
    cycle.step();
    const model::Bodies& after = cycle.state().model.bodies;
    const Vec3 theta = dt * after.spin[0];
    const Quat turn(Eigen::AngleAxisd(theta.norm(), theta.normalized()));
    EXPECT_LT(((turn * before.clumps.orientation[0]).coeffs() - after.clumps.orientation[0].coeffs()).norm(),
              1e-14);
    for (std::size_t i = 0; i < after.position.size(); ++i)
      EXPECT_LT((before.position[i] + dt * after.velocity[i] - after.position[i]).norm(), 1e-14);
  }
}

TEST(Members, ForcesComeTogetherAboutTheCentre) {
  std::mt19937_64 random(22);
  SceneBuilder builder;
  builder.ball({5, 5, 5});
  builder.clump(odd_shape(), {.position = {1, 2, 3}, .orientation = random_orientation(random)});
  const assembly::Model model = builder.build();
  const auto count = static_cast<std::size_t>(model.bodies.size());
  assembly::BodyForces forces{std::vector<Vec3>(count), std::vector<Vec3>(count)};
  for (std::size_t i = 0; i < count; ++i) {
    forces.force[i] = random_vector(random);
    forces.moment[i] = random_vector(random);
  }
  const auto total = [&](const assembly::BodyForces& f) {  // about the origin, where each force acts
    Vec6 sum = Vec6::Zero();
    for (std::size_t i = 0; i < count; ++i) {
      const Vec3& at = model::centre_of(model.bodies, static_cast<std::int32_t>(i));
      sum.head<3>() += f.force[i];
      sum.tail<3>() += f.moment[i] + (&f == &forces ? model.bodies.position[i] : at).cross(f.force[i]);
    }
    return sum;
  };
  assembly::BodyForces gathered = forces;
  assembly::gather_members(model.bodies, {}, gathered);
  EXPECT_LT((total(gathered) - total(forces)).norm(), 1e-13);
  for (const std::int32_t row : model.bodies.clumps.members(0))
    if (row != model.bodies.clumps.holder(0)) {
      EXPECT_EQ(gathered.force[static_cast<std::size_t>(row)], Vec3(Vec3::Zero()));
    }
}

TEST(Members, TurnExactlyInTrialDisplacements) {
  std::mt19937_64 random(23);
  SceneBuilder builder;
  builder.clump(odd_shape(), {.position = {1, 2, 3}, .orientation = random_orientation(random)});
  const assembly::Model model = builder.build();
  const auto count = static_cast<std::size_t>(model.bodies.size());
  assembly::Displacement moved{std::vector<Vec3>(count, Vec3::Zero()),
                               std::vector<Vec3>(count, Vec3::Zero())};
  const auto holder = static_cast<std::size_t>(model.bodies.clumps.holder(0));
  const Vec3 u(0.1, -0.2, 0.3);
  const Vec3 theta(1.0, 0.5, -0.7);
  moved.translation[holder] = u;
  moved.rotation[holder] = theta;
  const assembly::Displacement of_holders = moved;
  assembly::carry_members(model.bodies, moved);
  const Mat3 r = Eigen::AngleAxisd(theta.norm(), theta.normalized()).toRotationMatrix();
  const Vec3& centre = model.bodies.clumps.position[0];
  for (std::size_t i = 0; i < count; ++i) {
    const Vec3& x = model.bodies.position[i];
    EXPECT_LT((x + moved.translation[i] - (centre + u + r * (x - centre))).norm(), 1e-15 * 16);
    EXPECT_EQ(moved.rotation[i], theta);
  }
  model::Bodies bodies = model.bodies;
  assembly::commit_clumps(bodies, of_holders);
  for (std::size_t i = 0; i < count; ++i)
    EXPECT_LT((bodies.position[i] - model.bodies.position[i] - moved.translation[i]).norm(), 1e-15 * 16);
}

}  // namespace
}  // namespace eigengrain::test
