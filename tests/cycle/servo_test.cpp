// Walls that are driven to a force: one ball, a packing under a piston, a box under all-round stress.
#include "eigengrain/assembly/servo.hpp"

#include "eigengrain/assembly/balance.hpp"
#include "eigengrain/cycle/policy.hpp"
#include "eigengrain/io/scene_reader.hpp"
#include "eigengrain/io/state_file.hpp"

#include "support/motion.hpp"
#include "unit/io_support.hpp"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <random>

namespace eigengrain::test {
namespace {

using assembly::State;
using cycle::Cycle;

/// A fixed ball under a lid with k_n = 2 that overlaps it by `overlap`.
SceneBuilder lid_on_a_ball(double overlap, double force) {
  SceneBuilder builder({.kn = 2, .ks = 0, .tension = false});
  builder.ball({0, 0, 0}, 1, 1, fix_all).plane({0, 0, 1 - overlap}, {0, 0, -1}).carried(Vec3::Zero());
  builder.scene().wall_motions[0].servo = model::Servo{{0, 0, -1}, force, 0.25, 0.01};
  return builder;
}

TEST(Servo, MakesUpForAPartOfTheMissingForceInAStep) {
  // F = 0.2, wanted 0.204: v = 0.25 · 0.004/(2 · 0.5).
  EXPECT_NEAR(assembly::servo_speeds(lid_on_a_ball(0.1, 0.204).build(), 0.5)[0], 1e-3, 1e-15);
  // Farther away the bound holds, both ways, and without a contact.
  EXPECT_EQ(assembly::servo_speeds(lid_on_a_ball(0.1, 5).build(), 0.5)[0], 0.01);
  EXPECT_EQ(assembly::servo_speeds(lid_on_a_ball(0.1, 0.01).build(), 0.5)[0], -0.01);
  EXPECT_EQ(assembly::servo_speeds(lid_on_a_ball(-0.1, 5).build(), 0.5)[0], 0.01);
  Cycle cycle = cycle_of(lid_on_a_ball(0.1, 0.204), 0.5);
  for (int k = 1; k <= 20; ++k) {
    cycle.step();
    EXPECT_NEAR(0.204 + cycle.state().force[0].z(), 0.004 * std::pow(0.75, k), 1e-15);
  }
}

/// Balls in a box whose lid, or whose every wall, is driven.
std::string packing_scene(const std::string& walls) {
  std::string balls;
  std::mt19937_64 random(12);
  std::uniform_real_distribution<double> uniform(0, 1);
  for (int k = 0; k < 6; ++k)
    for (int j = 0; j < 5; ++j)
      for (int i = 0; i < 5; ++i)
        balls += fmt::format("  - {{position: [{}, {}, {}], radius: {}, material: grain}}\n",
                             0.006 + 0.011 * i + 5e-4 * uniform(random),
                             0.006 + 0.011 * j + 5e-4 * uniform(random),
                             0.006 + 0.011 * k + 5e-4 * uniform(random), 0.005 - 0.001 * uniform(random));
  return R"(
materials: [{name: grain, density: 2500}]
contacts: [{between: [any, any], law: linear, kn: 1e5, ks: 5e4, friction: 0.3}]
balls:
)" + balls +
         "walls:\n" + walls;
}

const std::string box = "box: {min: [0, 0, 0], max: [0.056, 0.056, 0.067]";

TEST(Servo, BringsAPackingToAStressAndKeepsItThere) {
  const io::TemporaryFolder folder;
  const model::Scene scene = io::read_scene_text(
      packing_scene(
          "  - {" + box + ", open: [+z]}, material: grain}\n" +
          "  - {plane: {point: [0, 0, 0.067], normal: [0, 0, -1]}, material: grain, servo: {stress: 10 "
          "kPa, area: 3.136e-3 m2, max_speed: 0.2 m/s}}\n"),
      folder.path(), "piston.yaml");
  Cycle cycle(cycle::start(scene), cycle::policy_of(scene));
  cycle.run(20000);
  const assembly::Balance balance = assembly::balance_of(cycle.state());
  const auto loads = assembly::wall_loads(cycle.state().model);
  const double wanted = 1e4 * 0.056 * 0.056;
  EXPECT_LT(balance.mean, 1e-3);
  EXPECT_NEAR(loads[5].force.z(), wanted, 1e-4 * wanted);  // the lid
  // The sides hold a part by friction, and all walls together nothing.
  Vec3 sum = Vec3::Zero();
  for (const assembly::WallLoad& load : loads) sum += load.force;
  EXPECT_LT(sum.norm(), 1e-2 * wanted);
  EXPECT_GT(assembly::servo_speeds(cycle.state().model, 1e-5)[0], -1e-3);
}

TEST(Servo, ConfinesAPackingFromAllSidesAndRestartsToTheBit) {
  const io::TemporaryFolder folder;
  const model::Scene scene = io::read_scene_text(
      packing_scene("  - {" + box + "}, material: grain, servo: {stress: 20 kPa, max_speed: 0.1 m/s}}\n"),
      folder.path(), "box.yaml");
  Cycle cycle(cycle::start(scene), cycle::policy_of(scene));
  cycle.run(3000);
  const auto file = folder.path() / "box.h5";
  io::write_state(cycle.state(), file);
  Cycle again(io::read_state(file), cycle::policy_of(scene));
  cycle.run(9000);
  again.run(9000);
  for (std::size_t i = 0; i < cycle.state().model.bodies.position.size(); ++i)
    ASSERT_EQ(cycle.state().model.bodies.position[i], again.state().model.bodies.position[i]);
  const auto loads = assembly::wall_loads(cycle.state().model);
  for (std::size_t w = 0; w < 6; ++w) {
    const model::Servo& servo = *scene.wall_motions[w].servo;
    EXPECT_NEAR(-loads[w].force.dot(servo.direction), servo.force, 1e-3 * servo.force) << w;
    EXPECT_NEAR(servo.force, 2e4 * (w < 4 ? 0.056 * 0.067 : 0.056 * 0.056), 1e-12);
  }
}

TEST(ServoMistakes, AreReported) {
  const auto says = [](const std::string& servo, const std::string& shape) {
    return io::texts_of(
        io::mistakes_in("materials: [{name: grain, density: 2500}]\n"
                        "contacts: [{between: [any, any], law: none}]\n"
                        "balls: [{position: [0.1, 0.1, 0.1], radius: 5 mm, material: grain}]\n"
                        "walls: [{material: grain, " +
                        shape + ", servo: {max_speed: 1, " + servo + "}}]\n"));
  };
  using testing::ElementsAre;
  using testing::HasSubstr;
  const std::string plane = "plane: {point: [0, 0, 0], normal: [0, 0, 1]}";
  EXPECT_THAT(says("force: 1 N", plane), testing::IsEmpty());
  EXPECT_THAT(says("force: 1 N, stress: 1 Pa", plane),
              ElementsAre(HasSubstr("walls[0].servo: either a force or a stress is wanted")));
  EXPECT_THAT(says("relaxation: 0.5", plane), ElementsAre(HasSubstr("either a force or a stress is wanted")));
  EXPECT_THAT(says("stress: 1 Pa", plane),
              ElementsAre(HasSubstr("walls[0].servo: a stress on a wall without an area of its own; add e.g. "
                                    "\"area: 0.04 m2\"")));
  EXPECT_THAT(says("force: 1 N, area: 1", plane),
              ElementsAre(HasSubstr("walls[0].servo.area: has a meaning")));
  EXPECT_THAT(says("force: 1 N, direction: [0, 0, 0]", plane),
              ElementsAre(HasSubstr("walls[0].servo.direction: zero, which is no direction")));
  EXPECT_THAT(says("force: -1 N", plane),
              ElementsAre(HasSubstr("walls[0].servo.force: \"-1 N\" is out of range")));
  EXPECT_THAT(says("stress: 1 Pa", "polygon: {corners: [[0, 0, 0], [1, 0, 0], [0, 1, 0]]}"),
              testing::IsEmpty());
}

}  // namespace
}  // namespace eigengrain::test
