#include "io/settings_reader.hpp"
#include "unit/io_support.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <numbers>
#include <string>

namespace eigengrain::io {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

std::string scene_of(const std::string& planar, const std::string& more_of_second = "",
                     const std::string& rest = "") {
  return "planar: {" + planar +
         "}\n"
         "materials: [{name: grain, density: 2500}]\n"
         "contacts: [{between: [any, any], law: linear, kn: 1e5, ks: 1e5, friction: 1}]\n"
         "balls:\n"
         "  - {position: [0, 0.2, 0.5], radius: 50 mm, material: grain, fix: [x]}\n"
         "  - {position: [1, 0.2, 0], radius: 20 mm, material: grain" +
         more_of_second + "}\n" + rest;
}

std::vector<std::string> reported(const std::string& planar, const std::string& more_of_second,
                                  const std::string& rest = "") {
  return texts_of(mistakes_in(scene_of(planar, more_of_second, rest)));
}

TEST(Planar, LeavesThreeUnknownsToABody) {
  const model::Bodies bodies = read_scene_text(scene_of("normal: y"), ".").bodies;
  EXPECT_EQ(bodies.fixed[1], model::FixedComponents(0b101010));  // y, wx, wz
  EXPECT_EQ(bodies.fixed[0], model::FixedComponents(0b101011));
}

TEST(Planar, SpheresKeepTheirMassesAndDisksHaveTheirs) {
  const model::Bodies spheres = read_scene_text(scene_of("normal: y"), ".").bodies;
  EXPECT_EQ(spheres.mass[0], model::sphere_mass(0.05, 2500));
  const model::Bodies disks = read_scene_text(scene_of("normal: y, shape: disk"), ".").bodies;
  EXPECT_DOUBLE_EQ(disks.mass[0], std::numbers::pi * 0.05 * 0.05 * 2500);
  EXPECT_DOUBLE_EQ(disks.inertia[0], 0.5 * disks.mass[0] * 0.05 * 0.05);
}

TEST(Planar, ReportsWhatLeavesThePlane) {
  EXPECT_THAT(
      reported("normal: z", ""),
      ElementsAre(HasSubstr("ball 1: z = 0 m, and ball 0 has z = 0.5 m; the balls of a planar scene")));
  EXPECT_THAT(reported("normal: y", ", velocity: [1, 2, 0]"),
              ElementsAre(HasSubstr("ball 1: a velocity of 2 m/s along y leaves the plane")));
  EXPECT_THAT(reported("normal: y", ", spin: [0, 1, 3]"),
              ElementsAre(HasSubstr("ball 1: a spin of 3 rad/s about z")));
  EXPECT_THAT(reported("normal: y", "", "gravity: [0, -9.81, 0]\n"),
              ElementsAre(HasSubstr("gravity: -9.81 m/s2 along y, across the plane")));
}

TEST(Planar, IsSettledWhereAStateBegan) {
  const model::Scene scene = read_scene_text(scene_of("normal: y, shape: disk"), ".");
  EXPECT_NO_THROW(read_settings_text(scene.document, ".", "settings", {}, scene.bodies.material));
  const std::vector<std::string> other{"planar.shape=sphere"};
  try {
    read_settings_text(scene.document, ".", "settings", other, scene.bodies.material);
    FAIL();
  } catch (const InputError& error) {
    EXPECT_THAT(texts_of(error.mistakes()),
                ElementsAre(HasSubstr("planar: a state keeps the plane and the masses")));
  }
}

TEST(Planar, CentresMayBeRoundedInFiles) {
  EXPECT_THAT(reported("normal: y", ""), ElementsAre());
  const std::string rounded =
      "planar: {}\nmaterials: [{name: grain, density: 2500}]\n"
      "contacts: [{between: [any, any], law: linear, kn: 1e5}]\n"
      "balls:\n"
      "  - {position: [0, 0, 0.3], radius: 50 mm, material: grain}\n"
      "  - {position: [1, 0, 0.30000001], radius: 50 mm, material: grain}\n";
  EXPECT_THAT(texts_of(mistakes_in(rounded)), ElementsAre());
}

}  // namespace
}  // namespace eigengrain::io
