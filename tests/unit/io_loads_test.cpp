// Scene keys of what bodies have of their own (loads, damping, growth) and of mass scaling.
#include "unit/io_support.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>
#include <vector>

namespace eigengrain::io {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

std::string scene_of(const std::string& of_second, const std::string& rest = "") {
  return "materials: [{name: grain, density: 2500}]\n"
         "contacts: [{between: [any, any], law: linear, kn: 1e5, ks: 1e5, friction: 1}]\n"
         "balls:\n"
         "  - {position: [0, 0, 0], radius: 50 mm, material: grain}\n"
         "  - {position: [1, 0, 0], radius: 20 mm, material: grain" +
         of_second + "}\n" + rest;
}

std::vector<std::string> reported(const std::string& of_second, const std::string& rest = "") {
  return texts_of(mistakes_in(scene_of(of_second, rest)));
}

TEST(OwnProperties, AreReadInTheirUnits) {
  const model::Bodies bodies =
      read_scene_text(scene_of(", force: [1 kN, 0, 0], moment: [0, 2 N m, 0], damping: 0.2, "
                               "growth: {factor: 1.5, over: 500 ms, from: 2 s}"),
                      ".")
          .bodies;
  EXPECT_EQ(bodies.applied_force, (std::vector<Vec3>{Vec3::Zero(), {1000, 0, 0}}));
  EXPECT_EQ(bodies.applied_moment, (std::vector<Vec3>{Vec3::Zero(), {0, 2, 0}}));
  EXPECT_EQ(bodies.damping, (std::vector<double>{model::Bodies::scene_damping, 0.2}));
  ASSERT_EQ(bodies.ramp.size(), 2U);
  EXPECT_EQ(bodies.ramp[0].factor, 1);
  const model::RadiusRamp& ramp = bodies.ramp[1];
  EXPECT_EQ(ramp.radius, 0.02);
  EXPECT_EQ(ramp.mass, bodies.mass[1]);
  EXPECT_EQ(ramp.scale(1.9), 1);
  EXPECT_DOUBLE_EQ(ramp.scale(2.25), 1.25);
  EXPECT_EQ(ramp.scale(3), 1.5);
}

TEST(OwnProperties, AreNotThereWhereNobodyAsks) {
  const model::Scene scene = read_scene_text(scene_of(""), ".");
  EXPECT_THAT(scene.bodies.applied_force, IsEmpty());
  EXPECT_THAT(scene.bodies.applied_moment, IsEmpty());
  EXPECT_THAT(scene.bodies.damping, IsEmpty());
  EXPECT_THAT(scene.bodies.ramp, IsEmpty());
  EXPECT_THAT(scene.bodies.mass_factor, IsEmpty());
  EXPECT_FALSE(scene.mass_scaling.has_value());
}

TEST(OwnProperties, MistakesSayWhatToWrite) {
  EXPECT_THAT(reported(", force: [1 m, 0, 0]"), ElementsAre(HasSubstr("balls[1].force")));
  EXPECT_THAT(reported(", damping: 1"), ElementsAre(HasSubstr("balls[1].damping")));
  EXPECT_THAT(reported(", growth: {factor: 0, over: 1 s}"), ElementsAre(HasSubstr("balls[1].growth.factor")));
  EXPECT_THAT(reported(", growth: {factor: 1.2}"), ElementsAre(HasSubstr("over is missing")));
  EXPECT_THAT(reported("",
                       "clumps:\n  - balls: [{at: [0, 0, 0], radius: 1 mm}]\n    material: grain\n"
                       "    growth: {factor: 2, over: 1 s}\n    instances: [{position: [5, 0, 0]}]\n"),
              ElementsAre(HasSubstr("clumps[0].growth: of a clump; only the radii of single balls change")));
}

TEST(OwnProperties, LoadsStayInThePlane) {
  const std::string planar = "planar: {normal: y}\n";
  EXPECT_THAT(reported(", force: [1, 2, 0]", planar),
              ElementsAre(HasSubstr("ball 1: a force of 2 N along y, across the plane")));
  EXPECT_THAT(reported(", moment: [0, 1, 3]", planar),
              ElementsAre(HasSubstr("ball 1: a moment of 3 N m about z")));
  EXPECT_THAT(reported(", force: [1, 0, 2], moment: [0, 1, 0]", planar), IsEmpty());
}

TEST(MassScalingKeys, AreRead) {
  const model::Scene scene = read_scene_text(scene_of("", "mass_scaling: {dt: 2 s}\n"), ".");
  ASSERT_TRUE(scene.mass_scaling.has_value());
  EXPECT_EQ(scene.mass_scaling->form, model::MassScaling::Form::differential);
  EXPECT_EQ(scene.mass_scaling->dt, 2);
  const model::Scene other = read_scene_text(scene_of("", "mass_scaling: {form: uniform, dt: 1}\n"), ".");
  EXPECT_EQ(other.mass_scaling->form, model::MassScaling::Form::uniform);
  EXPECT_FALSE(read_scene_text(scene_of("", "mass_scaling: {form: none, dt: 1}\n"), ".").mass_scaling);
}

TEST(MassScalingKeys, RefuseWhatHasNoMeaningBeside) {
  EXPECT_THAT(reported("", "mass_scaling: {form: uniform}\n"), ElementsAre(HasSubstr("dt is missing")));
  EXPECT_THAT(reported("", "mass_scaling: {dt: 1}\ntimestep: {policy: fixed, dt: 1e-5}\n"),
              ElementsAre(HasSubstr("mass_scaling.dt: beside a timestep of policy fixed")));
  EXPECT_THAT(reported("", "mass_scaling: {dt: 1}\nhistories: [{file: a.csv, of: [ledger]}]\n"),
              ElementsAre(HasSubstr("mass_scaling: beside a table of the ledger")));
  const std::string dashpots =
      "materials: [{name: grain, density: 2500}]\n"
      "contacts: [{between: [any, any], law: linear, kn: 1e5, beta_n: 0.1}]\n"
      "balls: [{position: [0, 0, 0], radius: 1 mm, material: grain}]\nmass_scaling: {dt: 1}\n";
  EXPECT_THAT(texts_of(mistakes_in(dashpots)),
              ElementsAre(HasSubstr("mass_scaling: beside the dashpots of contacts[0]")));
}

}  // namespace
}  // namespace eigengrain::io
