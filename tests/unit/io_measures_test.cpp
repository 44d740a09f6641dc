// Regions in scenes and on the command line, and the columns of tables that they make.
#include "eigengrain/io/history.hpp"
#include "eigengrain/io/scene_reader.hpp"

#include "support/states.hpp"
#include "unit/io_support.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <sstream>

namespace eigengrain::io {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

std::string scene_with(const std::string& keys) {
  return "materials: [{name: grain, density: 2500}]\n"
         "contacts: [{between: [grain, grain], law: linear, kn: 1e5}]\n"
         "balls: [{position: [0, 0, 0.1], radius: 5 mm, material: grain}]\n" +
         keys + "\n";
}

std::vector<std::string> reported(const std::string& keys) {
  return texts_of(mistakes_in(scene_with(keys)));
}

TEST(Regions, AreReadWithTheirNamesAndUnits) {
  const model::Scene scene =
      read_scene_text(scene_with("measures:\n"
                                 "  - {name: middle, sphere: {centre: [1 mm, 2 cm, 3], radius: 5 mm}}\n"
                                 "  - {box: {min: [-1, 0, 0], max: [1, 1, 2]}}\n"
                                 "  - {name: all of it}\n"
                                 "histories: [{file: a.csv, measures: [all of it, middle]}]"),
                      ".");
  ASSERT_EQ(scene.measures.size(), 3U);
  const auto& sphere = std::get<model::SphereRegion>(scene.measures[0].shape);
  EXPECT_EQ(sphere.centre, Vec3(1e-3, 2e-2, 3));
  EXPECT_EQ(sphere.radius, 5e-3);
  EXPECT_EQ(scene.measures[1].name, "region 1");
  EXPECT_EQ(std::get<model::BoxRegion>(scene.measures[1].shape).max, Vec3(1, 1, 2));
  EXPECT_TRUE(std::holds_alternative<model::WholeRegion>(scene.measures[2].shape));
  ASSERT_EQ(scene.histories[0].measures.size(), 2U);
  EXPECT_EQ(scene.histories[0].measures[0].name, "all of it");
  EXPECT_EQ(scene.histories[0].measures[1].name, "middle");
}

TEST(Regions, MistakesInThem) {
  EXPECT_THAT(
      reported("measures: [{name: a, sphere: {centre: [0, 0, 0], radius: 1}, box: {min: [0, 0, 0], "
               "max: [1, 1, 1]}}]"),
      ElementsAre("scene.yaml:4: measures[0].box: a region is a sphere or a box, not both; make it two "
                  "entries"));
  EXPECT_THAT(
      reported("measures: [{sphere: {centre: [0, 0, 0], radius: 0}}]"),
      ElementsAre(HasSubstr("measures[0].sphere.radius: \"0\" is out of range; a value > 0 is wanted")));
  EXPECT_THAT(reported("measures: [{sphere: {centre: [0, 0]}}]"),
              ElementsAre(HasSubstr("measures[0].sphere: radius is missing; add e.g. \"radius: 50 mm\""),
                          HasSubstr("measures[0].sphere.centre: 2 values; three are wanted")));
  EXPECT_THAT(
      reported("measures: [{box: {min: [0, 0, 1], max: [1, 1, 1]}}]"),
      ElementsAre("scene.yaml:4: measures[0].box.max: 1 m along z, and min is 1 m; max must be larger"));
  EXPECT_THAT(
      reported("measures: [{name: a}, {name: a}]"),
      ElementsAre("scene.yaml:4: measures[1].name: \"a\" is the name of another region; choose another "
                  "one"));
  EXPECT_THAT(reported("measures: [{ball: {}}]"),
              ElementsAre(HasSubstr("measures[0].ball: unknown key (measures[] takes name, sphere, box)")));
}

TEST(Regions, ThatATableNamesMustExist) {
  EXPECT_THAT(reported("measures: [{name: middle}]\nhistories: [{file: a.csv, measures: midle}]"),
              ElementsAre("scene.yaml:5: histories[0].measures: there is no region \"midle\"; did you mean "
                          "\"middle\"? (measures: middle)"));
  EXPECT_THAT(reported("histories: [{file: a.csv, measures: all}]"),
              ElementsAre("scene.yaml:4: histories[0].measures: there is no region \"all\"; add it, e.g. "
                          "\"measures: [{name: all}]\" for all that there is"));
  EXPECT_THAT(reported("measures: [{name: a}]\nhistories: [{file: a.csv, measures: [a, a]}]"),
              ElementsAre(HasSubstr("histories[0].measures: \"a\" stands there twice; name it once")));
  // A region that was left out because of a mistake is not missed here as well.
  EXPECT_THAT(reported("measures: [{name: a, sphere: {centre: [0, 0, 0], radius: -1}}]\n"
                       "histories: [{file: a.csv, measures: [a]}]"),
              ElementsAre(HasSubstr("measures[0].sphere.radius")));
}

TEST(Regions, OfTheCommandLine) {
  const std::vector<std::string> good{"name: low, box: {min: [0, 0, 0], max: [1, 1, 5 mm]}", ""};
  const std::vector<model::Region> regions = read_regions(good);
  ASSERT_EQ(regions.size(), 2U);
  EXPECT_EQ(regions[0].name, "low");
  EXPECT_EQ(std::get<model::BoxRegion>(regions[0].shape).max.z(), 5e-3);
  EXPECT_EQ(regions[1].name, "region 1");
  const auto refusal = [](const std::string& entry) -> std::string {
    try {
      read_regions(std::vector{entry});
    } catch (const InputError& error) {
      return error.what();
    }
    return {};
  };
  EXPECT_EQ(
      refusal("sphere: {centre: [0, 0, 0]}"),
      "--region \"sphere: {centre: [0, 0, 0]}\": measures[0].sphere: radius is missing; add e.g. \"radius: "
      "50 mm\"");
  EXPECT_THAT(refusal("sphere: {centre"), HasSubstr("--region"));
  EXPECT_THAT(refusal("5 mm"), HasSubstr("--region"));
}

TEST(Frames, StressIsAskedForWithFramesOnly) {
  EXPECT_THAT(reported("outputs: {series: 10, fields: stress}"), IsEmpty());
  EXPECT_THAT(
      reported("outputs: {fields: [stress]}"),
      ElementsAre("scene.yaml:4: outputs.fields: of frames that nothing writes; add e.g. \"series: 1000\", "
                  "or remove fields"));
  EXPECT_THAT(
      reported("outputs: {series: 10, fields: [stres]}"),
      ElementsAre(HasSubstr("outputs.fields[0]: \"stres\" is none of stress; did you mean \"stress\"?")));
}

TEST(MeasureColumns, AreThoseOfTheirRegions) {
  const TemporaryFolder folder;
  const model::History table{.file = "a.csv", .balls = {}, .measures = {{"low", {}}}, .ledger = true};
  measures::Measure m;
  m.porosity = 0.4;
  m.stress << -1, -7, -5, -9, -2, -6, -5, -6, -3;
  m.fabric = {.bodies = 9,
              .coordination = 5,
              .without_rattlers = 5.5,
              .tensor = Mat3::Identity() / 4,
              .sliding = 0.25};
  measures::Ledger ledger{
      .kinetic = 1,
      .elastic = {2, 3, 4, 5},
      .gravitational = 6,
      .integrals = {.gravity = 7,
                    .applied = 7.25,
                    .growth = 7.5,
                    .prescribed = 8,
                    .walls = 9,
                    .damping = 15,
                    .contacts = {.slip = 10, .rolling = 11, .viscous = 12, .hysteresis = 13, .bonds = 14}},
      .balance_error = 16};
  {
    HistoryFile file(folder.path(), table, {});
    file.add(test::state_of(test::SceneBuilder().ball({0, 0, 0}), 0, 0), {.ledger = ledger, .regions = {m}});
  }
  std::ifstream input(folder.path() / "a.csv");
  std::ostringstream text;
  text << input.rdbuf();
  EXPECT_EQ(text.str(),
            "step,time [s],ledger kinetic [J],elastic normal [J],elastic shear [J],elastic rolling [J],"
            "elastic bonds [J],ledger gravitational [J],gravity work [J],applied work [J],growth work "
            "[J],prescribed work [J],wall work [J],"
            "slip loss [J],rolling loss [J],viscous loss [J],hysteresis loss [J],bond loss [J],"
            "damping loss [J],balance error [J],"
            "low porosity,low coordination,low coordination without rattlers,low sliding,"
            "low stress xx [Pa],low stress yy [Pa],low stress zz [Pa],low stress xy [Pa],low stress xz [Pa],"
            "low stress yz [Pa],low strain rate xx [1/s],low strain rate yy [1/s],low strain rate zz [1/s],"
            "low strain rate xy [1/s],low strain rate xz [1/s],low strain rate yz [1/s],"
            "low fabric xx,low fabric yy,low fabric zz,low fabric xy,low fabric xz,low fabric yz\n"
            "0,0,1,2,3,4,5,6,7,7.25,7.5,8,9,10,11,12,13,14,15,16,0.40000000000000002,5,5.5,0.25,-1,-2,-3,-8,-"
            "5,-6,nan,"
            "nan,nan,nan,nan,nan,"
            "0.25,0.25,0.25,0,0,0\n");
}

}  // namespace
}  // namespace eigengrain::io
