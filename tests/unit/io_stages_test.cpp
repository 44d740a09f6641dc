// Groups and stages in scenes.
#include "eigengrain/io/scene_reader.hpp"

#include "unit/io_support.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace eigengrain::io {
namespace {

using testing::AllOf;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::UnorderedElementsAre;

std::string scene_with(const std::string& keys) {
  return "materials: [{name: grain, density: 2500}, {name: dust, density: 2500}]\n"
         "contacts: [{between: [grain, grain], law: linear, kn: 1e5, friction: 0.5}]\n"
         "balls: [{position: [0, 0, 0.1], radius: 5 mm, material: grain}]\n" +
         keys + "\n";
}

std::vector<std::string> reported(const std::string& keys) {
  return texts_of(mistakes_in(scene_with(keys)));
}

TEST(Stages, AreReadInTheirOrder) {
  const model::Scene scene = read_scene_text(
      scene_with(
          "groups: [{name: all of them}, {name: first, balls: 0, material: grain}]\n"
          "stages:\n"
          "  - {name: settle, run: {steps: 500, until: {unbalanced: 1e-4, kinetic: 1 uJ}}}\n"
          "  - set: {contacts.0.friction: 0.2, gravity: [0, 0, -9.81]}\n"
          "    repeat: 3\n"
          "    balls: [{fill: random, fraction: 0.1, radius: 5 mm, material: grain,\n"
          "             box: {min: [0, 0, 0.2], max: [0.1, 0.1, 0.3]}}]\n"
          "    groups: [{name: lid, box: {min: [0, 0, 0], max: [1, 1, 1]}}]\n"
          "    bodies: [{group: lid, fix: [x, wy], free: z, velocity: [0, 0, 1], growth: {factor: 1.1}}]\n"
          "    relax: {tolerance: 1e-8}\n"
          "    save: end.h5\n"),
      ".");
  ASSERT_EQ(scene.groups.size(), 2U);
  EXPECT_THAT(*scene.groups[1].of.balls, ElementsAre(0));
  EXPECT_EQ(scene.groups[1].of.material, 0);
  ASSERT_EQ(scene.stages.size(), 2U);
  const model::Stage& settle = scene.stages[0];
  EXPECT_EQ(settle.name, "settle");
  EXPECT_EQ(settle.repeat, 1);
  EXPECT_EQ(settle.run.steps, 500);
  EXPECT_EQ(settle.run.unbalanced, 1e-4);
  EXPECT_EQ(settle.run.kinetic, 1e-6);
  const model::Stage& next = scene.stages[1];
  EXPECT_THAT(next.settings, ElementsAre("contacts.0.friction=\"0.2\"", "gravity=[\"0\", \"0\", \"-9.81\"]"));
  EXPECT_EQ(next.repeat, 3);
  EXPECT_TRUE(next.adds_balls);
  ASSERT_EQ(next.bodies.size(), 1U);
  EXPECT_EQ(next.bodies[0].of.group, "lid");
  EXPECT_EQ(next.bodies[0].fix.bits(), 0b010001);
  EXPECT_EQ(next.bodies[0].free.bits(), 0b000100);
  EXPECT_EQ(next.bodies[0].velocity, Vec3(0, 0, 1));
  EXPECT_EQ(next.bodies[0].growth, 1.1);
  EXPECT_FALSE(next.run.any());
  EXPECT_EQ(next.relax->tolerance, 1e-8);
  EXPECT_EQ(next.relax->max_steps, 1000000);
  EXPECT_EQ(next.save, "end.h5");
}

TEST(Stages, ABallThatComesInHasASeedOfItsRepetition) {
  const model::Scene scene = read_scene_text(
      scene_with("stages: [{repeat: 2, balls: [{fill: random, fraction: 0.1, radius: 5 mm, material: grain, "
                 "box: {min: [0, 0, 0.2], max: [0.1, 0.1, 0.3]}}]}]"),
      ".");
  const model::Bodies first = read_added_balls(scene, 0, 0);
  const model::Bodies second = read_added_balls(scene, 0, 1);
  ASSERT_EQ(first.size(), second.size());
  EXPECT_NE(first.position[0], second.position[0]);
  EXPECT_EQ(first.position[0], read_added_balls(scene, 0, 0).position[0]);
  EXPECT_NEAR(first.mass[0], model::sphere_mass(5e-3, 2500), 1e-18);
}

TEST(Stages, MistakesInThem) {
  EXPECT_THAT(reported("stages: [{run: {steps: 10}, relax: {tolerance: 1e-8}}]"),
              ElementsAre(HasSubstr("stages[0].relax: not beside run; make it a stage of its own")));
  EXPECT_THAT(reported("run: {steps: 3}\nstages: [{run: {steps: 10}}]"),
              ElementsAre(HasSubstr("run: not beside stages")));
  EXPECT_THAT(
      reported("groups: [{name: lid}]\nstages: [{bodies: [{group: led, fix: x}]}]"),
      ElementsAre("scene.yaml:5: stages[0].bodies[0].group: there is no group \"led\"; did you mean \"lid\"? "
                  "(groups: lid)"));
  EXPECT_THAT(
      reported("stages: [{bodies: [{fix: x, free: x}, {balls: [0]}]}]"),
      UnorderedElementsAre(HasSubstr("stages[0].bodies[0].free: a component cannot be fixed and freed"),
                           HasSubstr("stages[0].bodies[1]: changes nothing; add e.g.")));
  EXPECT_THAT(reported("stages: [{save: a/b.h5}, {save: b.yaml}]"),
              ElementsAre(HasSubstr("stages[0].save: \"a/b.h5\": a name without folders that ends in .h5"),
                          HasSubstr("stages[1].save: \"b.yaml\"")));
  EXPECT_THAT(reported("stages: [{set: {balls: [], stages.0.name: a, run.steps: 5}}]"),
              UnorderedElementsAre(HasSubstr("stages[0].set: balls: balls come in with `balls` of the stage"),
                                   HasSubstr("stages[0].set: stages.0.name: "),
                                   HasSubstr("stages[0].set: run.steps: a stage has a `run` of its own")));
  EXPECT_THAT(reported("stages: [{name: a}]"), ElementsAre(HasSubstr("stages[0]: does nothing; add e.g.")));
  EXPECT_THAT(reported("stages: [{run: {until: {}}}]"),
              ElementsAre(HasSubstr("stages[0].run.until: says nothing; add e.g. \"unbalanced: 1e-5\"")));
  EXPECT_THAT(reported("stages: [{run: {until: {wall_force: {wall: lid, at_least: 3 N}}}}]"),
              ElementsAre(HasSubstr("there is no wall \"lid\", as the scene has none")));
  EXPECT_THAT(reported("stages: [{bodies: [{growth: {factor: 0}}]}]"),
              ElementsAre(HasSubstr("growth.factor: \"0\" is out of range")));
}

TEST(Stages, WhatTheySetIsTriedOutBeforeAnythingRuns) {
  EXPECT_THAT(reported("stages: [{run: {steps: 5}}, {set: {contacts.0.fricton: 0.3}}]"),
              ElementsAre(AllOf(HasSubstr("scene.yaml:4: stages[1].set: "),
                                HasSubstr("contacts[0].fricton: unknown key; did you mean \"friction\"?"))));
  EXPECT_THAT(
      reported("stages: [{set: {materials.0.density: 3000}}]"),
      ElementsAre(HasSubstr("stages[0].set: materials[0].density: 3000 kg/m3; the balls of a state have")));
  // What one stage sets is there for the next.
  EXPECT_THAT(
      reported("stages:\n"
               "  - {set: {walls: [{plane: {point: [0, 0, 0], normal: [0, 0, 1]}, material: grain}]}}\n"),
      ElementsAre(HasSubstr("walls: 1 planes; the state has 0")));
  EXPECT_THAT(
      reported("histories: [{file: a.csv, of: [energies]}]\nstages: [{set: {histories.0.of: [unbalanced]}}]"),
      ElementsAre(HasSubstr("stages[0].set: the table \"a.csv\" would go on with other columns")));
  EXPECT_THAT(reported("stages:\n"
                       "  - {set: {measures: [{name: all}]}}\n"
                       "  - {set: {histories: [{file: a.csv, measures: [all]}]}}\n"),
              IsEmpty());
}

TEST(Stages, BallsThatComeInAreTriedOutToo) {
  EXPECT_THAT(reported("stages: [{balls: [{position: [0, 0, 1], radius: 1 mm, material: sand}]}]"),
              ElementsAre(HasSubstr("stages[0].balls[0].material: unknown material \"sand\"")));
  EXPECT_THAT(reported("stages: [{balls: [{position: [0, 0, 1], radius: 1 mm, material: dust}]}]"),
              ElementsAre(HasSubstr("contacts: no entry for \"grain\" and \"dust\", which can meet"),
                          HasSubstr("contacts: no entry for \"dust\" and \"dust\"")));
  EXPECT_THAT(
      reported("stages: [{balls: [{fill: dense, fraction: 0.3, radius: 1 mm, material: grain, box: {min: "
               "[0, 0, 0], max: [0.01, 0.01, 0.01]}}]}]"),
      ElementsAre(HasSubstr("stages[0].balls[0].fill: \"dense\" is none of random")));
}

}  // namespace
}  // namespace eigengrain::io
