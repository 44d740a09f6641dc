// Clumps as scene files ask for them.
#include "eigengrain/assembly/model.hpp"
#include "eigengrain/io/scene_reader.hpp"

#include "unit/io_support.hpp"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <numbers>

namespace eigengrain::io {
namespace {

using std::numbers::pi;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

/// A scene with these entries of `clumps`, the first of which stands in line 4.
std::string scene(const std::string& clumps, const std::string& rest = "") {
  return "materials: [{name: grain, density: 2000}]\n"
         "contacts: [{between: [any, any], law: linear, kn: 1e5}]\n"
         "clumps:\n" +
         clumps + rest;
}

constexpr const char* pair = "balls: [{at: [0, 0, 0], radius: 5 mm}, {at: [0, 5 mm, 0], radius: 5 mm}]";

std::string entry(const std::string& keys) {
  return fmt::format("- {{{}, material: grain}}\n", keys);
}

std::vector<std::string> mistakes(const std::string& clumps) {
  return texts_of(mistakes_in(scene(clumps)));
}

TEST(ClumpScene, NeedsNoOtherBalls) {
  const model::Scene read =
      read_scene_text(scene(entry(fmt::format(
                          "{}, instances: [{{position: [0, 0, 1]}}, {{position: [1, 0, 0], axis: [1, 0, 0], "
                          "angle: 90 deg, velocity: [1, 2, 3], spin: [0, 0, 4], fix: [x]}}]",
                          pair))),
                      ".", "");
  const model::Bodies& bodies = read.bodies;
  const model::Clumps& clumps = bodies.clumps;
  ASSERT_EQ(bodies.size(), 4);
  ASSERT_EQ(clumps.size(), 2);
  // The lens of two balls of 5 mm at 5 mm: π (4r + d)(2r - d)²/12.
  const double lens = pi * 25e-3 * 25e-6 / 12;
  const double mass = 2000 * (2 * 4 * pi / 3 * 125e-9 - lens);
  EXPECT_NEAR(clumps.mass[0], mass, 1e-13 * mass);
  EXPECT_NEAR(clumps.volume[0], mass / 2000, 1e-13 * mass / 2000);
  EXPECT_EQ(bodies.mass[3], clumps.mass[1]);
  // The centre of mass is at `position`, and the balls are beside it.
  EXPECT_LT((clumps.position[1] - Vec3(1, 0, 0)).norm(), 1e-15);
  EXPECT_LT((bodies.position[0] - Vec3(0, -2.5e-3, 1)).norm(), 1e-15);
  EXPECT_LT((bodies.position[1] - Vec3(0, 2.5e-3, 1)).norm(), 1e-15);
  EXPECT_LT((bodies.position[2] - Vec3(1, 0, -2.5e-3)).norm(), 1e-15);  // y has become z
  EXPECT_EQ(clumps.velocity[1], Vec3(1, 2, 3));
  EXPECT_EQ(clumps.spin[1], Vec3(0, 0, 4));
  // About its long axis, now z, it has the least moment.
  EXPECT_NEAR(clumps.angular_momentum[1].z(), 4 * clumps.inertia[1].minCoeff(), 1e-20);
  EXPECT_TRUE(bodies.fixed[2].component(0) && bodies.fixed[3].component(0));
  EXPECT_THAT(read.notes, Contains(HasSubstr("clumps[0]: volume")));
  EXPECT_EQ(assembly::build_model(read).contacts.size(), 0);
}

TEST(ClumpScene, NumbersItsBallsBehindTheOthers) {
  const model::Scene read =
      read_scene_text(scene(entry(fmt::format("{}, instances: [{{position: [0, 0, 1]}}]", pair)),
                            "balls: [{position: [5, 5, 5], radius: 5 mm, material: grain}]\n"),
                      ".", "");
  EXPECT_THAT(read.bodies.identity, ElementsAre(0, 1, 2));
  EXPECT_THAT(read.bodies.clumps.member, ElementsAre(1, 2));
  EXPECT_EQ(read.bodies.clumps.of(0), model::Clumps::none);
  EXPECT_EQ(read.bodies.velocity.size(), 3U);
}

TEST(ClumpScene, TakesMassPropertiesAsGiven) {
  const model::Scene read = read_scene_text(
      scene(
          entry(fmt::format("{}, mass: 2 g, centre: [1 mm, 0, 0], inertia: [1e-8, 2e-8, 2.5e-8], instances: "
                            "[{{position: [0, 0, 0]}}]",
                            pair))),
      ".", "");
  const model::Clumps& clumps = read.bodies.clumps;
  EXPECT_EQ(clumps.mass[0], 2e-3);
  EXPECT_EQ(clumps.inertia[0], Vec3(1e-8, 2e-8, 2.5e-8));
  EXPECT_LT((read.bodies.position[0] - Vec3(-1e-3, 0, 0)).norm(), 1e-18);
}

TEST(ClumpScene, SpreadsAMassThatIsGivenAlone) {
  const auto read = [](const std::string& keys) {
    return read_scene_text(scene(entry(keys + ", instances: [{position: [0, 0, 0]}]")), ".", "");
  };
  const model::Scene own = read(pair);
  const model::Scene heavy = read(fmt::format("{}, mass: 1 kg", pair));
  EXPECT_EQ(heavy.bodies.clumps.mass[0], 1);
  const double factor = 1 / own.bodies.clumps.mass[0];
  for (int k = 0; k < 3; ++k)
    EXPECT_NEAR(heavy.bodies.clumps.inertia[0][k] / (factor * own.bodies.clumps.inertia[0][k]), 1, 1e-12);
}

TEST(ClumpScene, IsWrappedAsAWhole) {
  const model::Scene read =
      read_scene_text(scene(entry(fmt::format("{}, instances: [{{position: [1.2, 0.1, 0.001]}}]", pair)),
                            "periodic: {box: [1, 1, 1]}\n"),
                      ".", "");
  EXPECT_NEAR(read.bodies.clumps.position[0].x(), 0.2, 1e-15);
  EXPECT_NEAR((read.bodies.position[0] - read.bodies.position[1]).norm(), 5e-3, 1e-15);
}

TEST(ClumpMistakes, SayWhatAndWhereAndWhatToWrite) {
  const std::string at = ", instances: [{position: [0, 0, 0]}]";
  EXPECT_THAT(mistakes(entry(pair + at)), IsEmpty());
  EXPECT_THAT(mistakes(entry("balls: []" + at)),
              ElementsAre(HasSubstr("scene.yaml:4: clumps[0].balls: none; a clump has at least one")));
  EXPECT_THAT(mistakes(entry(fmt::format("{}, instances: []", pair))),
              ElementsAre(HasSubstr("clumps[0].instances: none; add e.g.")));
  EXPECT_THAT(mistakes(entry(pair)), ElementsAre(HasSubstr("clumps[0]: instances is missing")));
  EXPECT_THAT(
      mistakes(entry("balls: [{at: [0, 0, 0], radius: 5 mm}, {at: [1 mm, 0, 0], radius: 4 mm}]" + at)),
      ElementsAre(HasSubstr("clumps[0].balls[1]: lies within balls[0]")));
  EXPECT_THAT(mistakes(entry("balls: [{at: [0, 0, 0], radius: 5 mm}, {at: [0, 0, 0], radius: 5 mm}]" + at)),
              ElementsAre(HasSubstr("lies within balls[0]")));
  EXPECT_THAT(mistakes(entry("balls: [{at: [0, 0, 0], radius: -5 mm}]" + at)),
              ElementsAre(HasSubstr("clumps[0].balls[0].radius: \"-5 mm\" is out of range")));
  EXPECT_THAT(mistakes(entry("balls: [{position: [0, 0, 0], radius: 5 mm}]" + at)),
              Contains(HasSubstr("clumps[0].balls[0].position: unknown key")));
  EXPECT_THAT(mistakes(entry(fmt::format("{}, inertia: [1, 1, 1]", pair) + at)),
              ElementsAre(HasSubstr("clumps[0].inertia: mass, centre and inertia belong together")));
  EXPECT_THAT(mistakes(entry(fmt::format("{}, mass: 1, centre: [0, 0, 0]", pair) + at)),
              ElementsAre(HasSubstr("clumps[0].centre: mass, centre and inertia belong together")));
  EXPECT_THAT(mistakes(entry(fmt::format("{}, mass: 1, centre: [0, 0, 0], inertia: [1, 1, 3]", pair) + at)),
              ElementsAre(HasSubstr("clumps[0].inertia: (1, 1, 3) kg m2 belong to no rigid body")));
  EXPECT_THAT(
      mistakes(entry(fmt::format("{}, instances: [{{position: [0, 0, 0], fix: [wx]}}]", pair))),
      ElementsAre(HasSubstr("clumps[0].instances[0].fix: the rotation of a clump is fixed about all axes "
                            "or about none; write wx, wy and wz")));
  EXPECT_THAT(mistakes(entry(fmt::format("{}, instances: [{{position: [0, 0, 0], axis: [0, 0, 0]}}]", pair))),
              ElementsAre(HasSubstr("clumps[0].instances[0].axis: [0, 0, 0] has no direction")));
  EXPECT_THAT(
      mistakes(entry(fmt::format("{}, instances: [{{position: [0, 0, 0], angle: 90 mm}}]", pair))),
      ElementsAre(HasSubstr("clumps[0].instances[0].angle: \"90 mm\" is a length; a pure number is wanted")));
  EXPECT_THAT(mistakes(fmt::format("- {{{}{}, material: grian}}\n", pair, at)),
              Contains(HasSubstr("clumps[0].material: unknown material \"grian\"; did you mean \"grain\"?")));
}

TEST(ClumpMistakes, OfAPlane) {
  const std::string at = ", instances: [{position: [0, 0, 0]}]";
  EXPECT_THAT(texts_of(mistakes_in(scene(entry(pair + at), "planar: {normal: z}\n"))),
              Contains(HasSubstr("clumps: not in a planar scene")));
}

TEST(ClumpMistakes, OfPlacesAreFoundAsThoseOfBalls) {
  const std::string at = ", instances: [{position: [0, 0, -1]}, {position: [0, 0, 2 mm]}]";
  const std::vector<std::string> behind = texts_of(mistakes_in(
      scene(entry(pair + at), "walls: [{plane: {point: [0, 0, 0], normal: [0, 0, 1]}, material: grain}]\n")));
  ASSERT_EQ(behind.size(), 2U);  // both balls of the first
  EXPECT_THAT(behind[0], HasSubstr("scene.yaml:4: ball 0: its centre"));
  const std::string twice = ", instances: [{position: [0, 0, 0]}, {position: [0, 0, 0]}]";
  EXPECT_THAT(mistakes(entry(pair + twice)), Contains(HasSubstr("ball 2 has the centre")));
}

}  // namespace
}  // namespace eigengrain::io
