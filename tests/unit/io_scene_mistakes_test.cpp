#include "unit/io_support.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>

namespace eigengrain::io {
namespace {

using testing::AllOf;
using testing::Contains;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::StartsWith;

/// A valid scene, one section a line, any of which a test replaces. A line that is replaced by "" is empty,
/// so that every section keeps its line.
struct SceneText {
  std::string gravity = "gravity: [0, 0, -9.81]";                                                  // line 1
  std::string materials = "materials: [{name: grain, density: 2500}, {name: steel}]";              // line 2
  std::string contacts = "contacts: [{between: [any, any], law: linear, kn: 1e5}]";                // line 3
  std::string balls = "balls: [{position: [0.1, 0.1, 0.1], radius: 5 mm, material: grain}]";       // line 4
  std::string walls = "walls: [{plane: {point: [0, 0, 0], normal: [0, 0, 1]}, material: steel}]";  // line 5
  std::string rest{};                                                                              // line 6

  std::string text() const {
    return gravity + "\n" + materials + "\n" + contacts + "\n" + balls + "\n" + walls + "\n" + rest + "\n";
  }
};

std::vector<std::string> reported(const SceneText& scene, const std::filesystem::path& folder = ".") {
  return texts_of(mistakes_in(scene.text(), {}, folder));
}

TEST(Mistakes, NoneInTheSceneThatTheTestsStartFrom) {
  EXPECT_THAT(reported({}), IsEmpty());
}

TEST(Mistakes, AllOfAFileAreReportedAtOnceInTheOrderOfItsLines) {
  const std::vector<std::string> all = reported({
      .gravity = "gravty: [0, 0, -9.81]",
      .materials = "materials: [{name: grain, density: 2500 kg}, {name: steel}]",
      .contacts = "contacts: [{between: [any, any], law: linear, kn: 1e5, fricton: 0.5}]",
      .balls = "balls: [{position: [0.1, nan, 0.1], radius: 0, material: grian}]",
      .walls = "walls: [{plane: {point: [0, 0], normal: [0, 0, 0]}, material: steel}]",
      .rest = "timestep: {safety: 2, policy: fxed}",
  });
  EXPECT_THAT(
      all,
      ElementsAre(
          StartsWith("scene.yaml:1: gravty: unknown key; did you mean \"gravity\"?"),
          "scene.yaml:2: materials[0].density: \"2500 kg\" is a mass; a density is wanted, e.g. "
          "\"2500 kg/m3\"",
          StartsWith("scene.yaml:3: contacts[0].fricton: unknown key; did you mean \"friction\"? "
                     "(a linear contact takes kn, ks, friction, tension"),
          HasSubstr("scene.yaml:4: balls[0].material: unknown material \"grian\"; did you mean "
                    "\"grain\"?"),
          "scene.yaml:4: balls[0].position[1]: \"nan\" is not a finite number",
          HasSubstr("scene.yaml:4: balls[0].radius: \"0\" is out of range; a value > 0 is wanted"),
          HasSubstr("scene.yaml:5: walls[0].plane.point: 2 values; three are wanted"),
          HasSubstr("scene.yaml:5: walls[0].plane.normal: zero, which has no direction"),
          HasSubstr("scene.yaml:6: timestep.safety: \"2\" is out of range; a value > 0 and <= 1"),
          HasSubstr("scene.yaml:6: timestep.policy: \"fxed\" is none of estimate, fixed, bound, tracked; "
                    "did you mean \"fixed\"?")));
}

TEST(Mistakes, LinesAreThoseOfTheKeys) {
  const std::vector<std::string> all = texts_of(mistakes_in(R"(materials:
  - name: grain
    density: 2500
contacts:
  - between: [grain, grain]
    law: linear

    kn: -5
    # a comment
    tension: 3
balls:
  - position: [0,
               0,
               1 s]
    radius: 1
    material: grain
  - radius: 1
    material: grain
)"));
  EXPECT_THAT(
      all,
      ElementsAre(StartsWith("scene.yaml:8: contacts[0].kn: \"-5\" is out of range; a value > 0"),
                  "scene.yaml:10: contacts[0].tension: \"3\"; write true or false",
                  StartsWith("scene.yaml:14: balls[0].position[2]: \"1 s\" is a time; a length is wanted"),
                  StartsWith("scene.yaml:17: balls[1]: neither file nor position")));
}

TEST(Mistakes, SyntaxIsOneMistakeWithItsLine) {
  EXPECT_THAT(reported({.contacts = "contacts: [{between: [any, any]"}),
              ElementsAre(AllOf(StartsWith("scene.yaml:4: not valid YAML: "))));
  EXPECT_THAT(reported({.rest = "run: {steps: 5}\n---\nrun: {steps: 6}"}),
              ElementsAre(HasSubstr("a second document begins; one file holds one scene")));
  EXPECT_THAT(reported({.rest = "run: {steps: *nothing}"}),
              ElementsAre(StartsWith("scene.yaml:6: not valid YAML")));
  EXPECT_THAT(texts_of(mistakes_in("- a\n- b\n")),
              ElementsAre("scene.yaml:1: a scene is a section of keys such as \"balls:\", not a list"));
}

TEST(Mistakes, KeysGivenTwice) {
  EXPECT_THAT(
      reported({.rest = "run: {steps: 5, steps: 6}"}),
      ElementsAre("scene.yaml:6: the key \"steps\" stands twice in one section, first on line 6; keep one of "
                  "the two"));
  EXPECT_THAT(reported({.rest = "gravity: [0, 0, 0]"}),
              ElementsAre(HasSubstr(
                  "scene.yaml:6: the key \"gravity\" stands twice in one section, first on line 1")));
  EXPECT_THAT(reported({.rest = "[a, b]: 5"}), Contains(HasSubstr("a list stands where a key is wanted")));
}

TEST(Mistakes, WrongKindsOfValues) {
  EXPECT_THAT(
      reported({.gravity = "gravity: 9.81"}),
      ElementsAre("scene.yaml:1: gravity: a single value stands where a list of three values is wanted, e.g. "
                  "\"gravity: [0, 0, -9.81]\""));
  EXPECT_THAT(reported({.gravity = "gravity: [[0], 0, {a: 1}]"}),
              ElementsAre("scene.yaml:1: gravity[0]: a list stands where a number is wanted",
                          "scene.yaml:1: gravity[2]: a section stands where a number is wanted"));
  EXPECT_THAT(
      reported({.materials = "materials: [{name: grain, density: [2500]}, {name: steel}]"}),
      ElementsAre("scene.yaml:2: materials[0].density: a list stands where a single value is wanted, e.g. "
                  "\"density: 2500 kg/m3\""));
  EXPECT_THAT(
      reported({.balls = "balls: {position: [0, 0, 1], radius: 1, material: grain}"}),
      ElementsAre(StartsWith("scene.yaml:4: balls: a section stands where a list of sections is wanted")));
  EXPECT_THAT(
      reported({.walls = "walls: [steel]"}),
      ElementsAre(StartsWith("scene.yaml:5: walls[0]: a single value stands where a section is wanted")));
  EXPECT_THAT(reported({.walls = "walls:"}),
              ElementsAre(StartsWith("scene.yaml:5: walls: empty; give it a value, e.g. \"walls: [{plane:")));
  EXPECT_THAT(reported({.rest = "run: 5"}),
              ElementsAre(StartsWith("scene.yaml:6: run: a single value stands where a "
                                     "section is wanted, e.g. \"run: {steps: 10000}\"")));
}

TEST(Mistakes, Materials) {
  EXPECT_THAT(
      reported({.materials = "materials: [{name: grain, density: 2500}, {name: steel}, {name: grain}]"}),
      ElementsAre("scene.yaml:2: materials[2].name: \"grain\" is the name of a material on line 2 already; "
                  "choose another name"));
  EXPECT_THAT(
      reported({.materials = "materials: [{name: grain, density: 0}, {name: steel}]"}),
      ElementsAre(StartsWith("scene.yaml:2: materials[0].density: \"0\" is out of range; a value > 0")));
  EXPECT_THAT(
      reported({.materials = "materials: [{name: grain}, {name: steel}]"}),
      ElementsAre("scene.yaml:2: materials[0]: density is missing, and balls are made of \"grain\"; add e.g. "
                  "\"density: 2500 kg/m3\""));
  EXPECT_THAT(
      reported({.materials = "materials: [{name: grain, density: 2500}, {name: steel}, {density: 1}]"}),
      ElementsAre("scene.yaml:2: materials[2]: name is missing; add e.g. \"name: grain\""));
  EXPECT_THAT(
      reported({.materials = "materials: [{name: grain, density: 2500}, {name: steel}, {name: any}]"}),
      ElementsAre(HasSubstr("materials[2].name: \"any\" stands for every material; choose another name")));
  EXPECT_THAT(
      reported({.materials = ""}),
      Contains(HasSubstr("balls[0].material: unknown material \"grain\"; add \"- {name: grain, density: 2500 "
                         "kg/m3}\" to materials")));
}

TEST(Mistakes, ContactsThatAreWrong) {
  const auto contacts = [](const std::string& entries) {
    return reported({.contacts = "contacts: [" + entries + "]"});
  };
  EXPECT_THAT(contacts("{between: [any, any], law: linar, kn: 1e5}"),
              ElementsAre(AllOf(HasSubstr("contacts[0].law: \"linar\" is none of"),
                                HasSubstr("did you mean \"linear\"?"))));
  EXPECT_THAT(contacts("{between: [any, any], kn: 1e5}"),
              ElementsAre(HasSubstr("contacts[0]: law is missing; add e.g. \"law: linear\"")));
  EXPECT_THAT(contacts("{between: [any, any], law: linear}"),
              ElementsAre(HasSubstr("contacts[0]: kn is missing; add e.g. \"kn: ")));
  EXPECT_THAT(contacts("{between: [any, any], law: none, kn: 1e5}"),
              ElementsAre(HasSubstr("contacts[0].kn: unknown key (a none contact takes no parameters)")));
  EXPECT_THAT(contacts("{between: [any, any], law: linear, kn: 0}"),
              ElementsAre(HasSubstr("contacts[0].kn: \"0\" is out of range; a value > 0 is wanted")));
  EXPECT_THAT(contacts("{between: [any, any], law: linear, kn: 1, friction: -1}"),
              ElementsAre(HasSubstr("contacts[0].friction: \"-1\" is out of range; a value >= 0 is wanted")));
  EXPECT_THAT(
      contacts("{between: [any, stel], law: none}"),
      ElementsAre(HasSubstr("contacts[0].between: unknown material \"stel\"; did you mean \"steel\"?")));
  EXPECT_THAT(contacts("{between: [any], law: none}"),
              ElementsAre(HasSubstr("contacts[0].between: 1 names; two are wanted")));
  EXPECT_THAT(contacts("{law: none}"), ElementsAre(HasSubstr("contacts[0]: between is missing")));
  EXPECT_THAT(contacts("{between: [grain, steel], law: none}, {between: [steel, grain], law: none}"),
              ElementsAre(HasSubstr(
                  "contacts[1].between: never used: contacts[0] (line 3) matches all of its pairs")));
  EXPECT_THAT(contacts("{between: [any, any], law: none}, {between: [grain, grain], law: linear, kn: 1}"),
              ElementsAre(HasSubstr("contacts[1].between: never used: contacts[0] (line 3)")));
  // An entry that another covers only in part, or that covers another, is how exceptions are written.
  EXPECT_THAT(contacts("{between: [grain, steel], law: none}, {between: [any, any], law: none}"), IsEmpty());
}

TEST(Mistakes, PairsWithoutAContactLaw) {
  const std::string two =
      "balls: [{position: [0, 0, 1], radius: 0.1, material: grain}, "
      "{position: [0, 0, 2], radius: 0.1, material: grain}]";
  EXPECT_THAT(
      reported({.contacts = "contacts: [{between: [grain, steel], law: none}]", .balls = two}),
      ElementsAre(
          "scene.yaml:3: contacts: no entry for \"grain\" and \"grain\", which can meet; add e.g. "
          "\"- {between: [grain, grain], law: linear, kn: 1e5 N/m}\", or \"law: none\" if they do not "
          "see each other"));
  EXPECT_THAT(reported({.contacts = "contacts: [{between: [grain, grain], law: none}]"}),
              ElementsAre(HasSubstr("no entry for \"grain\" and \"steel\", which can meet")));
  // One ball meets nobody of its own kind, but its own image if the cell repeats.
  const SceneText one{.contacts = "contacts: [{between: [grain, steel], law: none}]"};
  EXPECT_THAT(reported(one), IsEmpty());
  EXPECT_THAT(reported({.contacts = one.contacts, .rest = "periodic: {box: [1, 1, 1], axes: [x]}"}),
              ElementsAre(HasSubstr("no entry for \"grain\" and \"grain\", which can meet")));
  EXPECT_THAT(reported({.contacts = ""}), ElementsAre(StartsWith("scene.yaml:1: contacts: no entry for")));
}

TEST(Mistakes, Balls) {
  const auto balls = [](const std::string& entries) {
    return reported({.balls = "balls: [" + entries + "]"});
  };
  EXPECT_THAT(reported({.balls = ""}), ElementsAre(HasSubstr("balls is missing; add e.g.")));
  EXPECT_THAT(balls(""), ElementsAre(StartsWith("scene.yaml:4: balls: no balls; add e.g.")));
  EXPECT_THAT(balls("{position: [0, 0, 1], radius: -1, material: grain}"),
              ElementsAre(HasSubstr("balls[0].radius: \"-1\" is out of range; a value > 0 is wanted")));
  EXPECT_THAT(balls("{position: [0, 0, 1], material: grain}"),
              ElementsAre(HasSubstr("balls[0]: radius is missing")));
  EXPECT_THAT(balls("{position: [0, 0, 1], radius: 1}"),
              ElementsAre(HasSubstr("balls[0]: material is missing")));
  EXPECT_THAT(balls("{radius: 1, material: grain}"),
              ElementsAre(HasSubstr("balls[0]: neither file nor position")));
  EXPECT_THAT(balls("{position: [0, 0, 1], radius: 1, material: grain, fix: [x, wq]}"),
              ElementsAre(HasSubstr("balls[0].fix[1]: \"wq\" is none of x, y, z, wx, wy, wz, all")));
  EXPECT_THAT(balls("{position: [0, 0, 1], radius: 1e-200, material: grain}"),
              ElementsAre(HasSubstr("scene.yaml:4: radius 1e-200 m makes a mass of 0 kg")));
}

TEST(Mistakes, PackingFiles) {
  const TemporaryFolder folder;
  folder.write("packing.txt", "0 0 1 0.1\n0 0 2 0.1\n0 0 3 -0.1\n0 0 4 0.1 0\n");
  EXPECT_THAT(reported({.balls = "balls: [{file: packing.txt, material: grain}]"}, folder.path()),
              ElementsAre((folder.path() / "packing.txt").string() + ":3: radius -0.1 m is not positive",
                          (folder.path() / "packing.txt").string() +
                              ":4: 5 columns; four are wanted: x y z r, in m"));
  EXPECT_THAT(reported({.balls = "balls: [{file: paking.txt, material: grain}]"}, folder.path()),
              ElementsAre("scene.yaml:4: there is no file \"" + (folder.path() / "paking.txt").string() +
                          "\"; did you mean \"packing.txt\"?"));
  // The line is that of the key, not of the entry.
  EXPECT_THAT(reported({.balls = "balls:\n  - material: grain\n    file: paking.txt"}, folder.path()),
              ElementsAre(StartsWith("scene.yaml:6: there is no file")));
  EXPECT_THAT(reported({.balls = "balls: [{file: packing.txt, radius: 5, material: grain}]"}, folder.path()),
              Contains(HasSubstr("balls[0].radius: not beside file")));
}

TEST(Mistakes, BallsAtOnePlace) {
  const TemporaryFolder folder;
  folder.write("packing.txt", "# a comment\n0 0 1 0.1\n0 0 2 0.1\n0 0 1 0.2\n0 0 1 0.3\n");
  const std::string file = (folder.path() / "packing.txt").string();
  EXPECT_THAT(
      reported({.balls = "balls: [{file: packing.txt, material: grain}]"}, folder.path()),
      ElementsAre(file + ":4: ball 2 has the centre (0, 0, 1) of ball 0 (" + file +
                      ":2), so their contact has no direction; move or remove one",
                  StartsWith(file + ":5: ball 3 has the centre (0, 0, 1) of ball 0 (" + file + ":2)")));
  EXPECT_THAT(reported({.balls = "balls: [{file: packing.txt, material: grain}, "
                                 "{position: [0, 0, 2.0000000001], radius: 1, material: grain}]"},
                       folder.path()),
              Contains(HasSubstr("scene.yaml:4: ball 4 has the centre (0, 0, 2.0000000001) of ball 1 (" +
                                 file + ":3)")));
}

TEST(Mistakes, BallsAtOnePlaceThroughTheCell) {
  const auto balls = [](const std::string& x) {
    return reported({.balls = "balls: [{position: [" + x +
                              ", 0, 1], radius: 0.1, material: grain}, "
                              "{position: [0, 4, 1], radius: 0.1, material: grain}]",
                     .rest = "periodic: {box: [2, 4, 0], axes: [x, y]}"});
  };
  EXPECT_THAT(balls("4"), ElementsAre(HasSubstr("ball 1 has the centre (0, 0, 1) of ball 0 (scene.yaml:4)")));
  EXPECT_THAT(balls("-1e-12"),
              ElementsAre(HasSubstr("ball 1 has the centre (0, 0, 1) of ball 0 (scene.yaml:4)")));
  EXPECT_THAT(balls("1"), IsEmpty());
  EXPECT_THAT(balls("-1e-6"), IsEmpty());
}

TEST(Mistakes, ManyBallsAtOnePlaceAreCounted) {
  const TemporaryFolder folder;
  std::string text;
  for (int k = 0; k < 5000; ++k) text += "0 0 1 0.1\n";
  folder.write("packing.txt", text);
  const std::vector<std::string> all =
      reported({.balls = "balls: [{file: packing.txt, material: grain}]"}, folder.path());
  ASSERT_EQ(all.size(), 21U);
  EXPECT_THAT(all.back(), HasSubstr("and 4,979 more like it"));
}

TEST(Mistakes, Walls) {
  const auto walls = [](const std::string& entry) { return reported({.walls = "walls: [{" + entry + "}]"}); };
  EXPECT_THAT(walls("material: steel"),
              ElementsAre(StartsWith("scene.yaml:5: walls[0]: either a plane or a box")));
  EXPECT_THAT(walls("material: steel, plane: {point: [0, 0, 0]}"),
              ElementsAre(HasSubstr("walls[0].plane: normal is missing; add e.g. \"normal: [0, 0, 1]\"")));
  EXPECT_THAT(walls("plane: {point: [0, 0, 0], normal: [0, 0, 1]}"),
              ElementsAre(HasSubstr("walls[0]: material is missing")));
  EXPECT_THAT(walls("material: steel, plane: {point: [0, 0, 0], normal: [0, 0, 0]}"),
              ElementsAre(HasSubstr("walls[0].plane.normal: zero, which has no direction")));
  EXPECT_THAT(walls("material: steel, plane: {point: [0, 0, 0], normal: [0, 0, 1e-320]}"), IsEmpty());
  EXPECT_THAT(walls("material: steel, plane: {point: [0, 0, 0], normal: [0, 0, 1e300]}"), IsEmpty());
  EXPECT_THAT(walls("material: steel, box: {min: [0, 0, 0], max: [1, 0, 1]}"),
              ElementsAre(HasSubstr("walls[0].box.max: y = 0 m is not above the y = 0 m of min")));
  EXPECT_THAT(walls("material: steel, box: {min: [0, 0, 0], max: [1, 1, 1], open: [-x, +x, -y, +y, -z, +z]}"),
              ElementsAre(HasSubstr("walls[0].box.open: all six sides")));
  EXPECT_THAT(walls("material: steel, box: {min: [0, 0, 0], max: [1, 1, 1], open: [z]}"),
              ElementsAre(HasSubstr("walls[0].box.open[0]: \"z\" is none of -x, +x, -y, +y, -z, +z")));
}

TEST(Mistakes, BallsOnOrBehindAWall) {
  EXPECT_THAT(
      reported({.balls = "balls: [{position: [0, 0, 0], radius: 1, material: grain}]"}),
      ElementsAre("scene.yaml:4: ball 0: its centre (0, 0, 0) lies on wall 1 (plane), whose normal (0, 0, 1) "
                  "points to the active side; move the ball, or turn the wall around"));
  EXPECT_THAT(reported({.balls = "balls: [{position: [0, 0, 1], radius: 0.1, material: grain}, "
                                 "{position: [0, 0, -0.25], radius: 0.1, material: grain}]"}),
              ElementsAre(StartsWith(
                  "scene.yaml:4: ball 1: its centre (0, 0, -0.25) lies 0.25 m behind wall 1 (plane)")));
  EXPECT_THAT(reported({.balls = "balls: [{position: [0, 0, -1], radius: 0.1, material: grain}, "
                                 "{position: [0, 0, -0.25], radius: 0.1, material: grain}]"}),
              ElementsAre(StartsWith("scene.yaml:5: wall 1 (plane): every ball lies behind it")));
}

TEST(Mistakes, Periodic) {
  const auto periodic = [](const std::string& keys) {
    return reported({.rest = "periodic: {" + keys + "}"});
  };
  EXPECT_THAT(periodic("box: [1, 1, 1], axes: [x, y]"), IsEmpty());
  EXPECT_THAT(periodic("box: [1, 1, 1]"),
              ElementsAre(HasSubstr(
                  "scene.yaml:5: walls[0].plane.normal: has a component along z, which is periodic")));
  EXPECT_THAT(periodic("box: [1, 0, 1], axes: [x, y]"),
              ElementsAre(HasSubstr(
                  "scene.yaml:6: periodic.box: length 0 m along y; a periodic axis wants a length")));
  EXPECT_THAT(periodic("box: [1, 1, 1], axes: []"), ElementsAre(HasSubstr("periodic.axes: empty")));
  EXPECT_THAT(periodic("box: [1, 1, 1], axes: [w]"),
              ElementsAre(HasSubstr("periodic.axes[0]: \"w\" is none of x, y, z")));
  EXPECT_THAT(periodic("axes: [x]"), ElementsAre(HasSubstr("periodic: box is missing")));
  EXPECT_THAT(
      reported({.walls = "walls: [{box: {min: [0, 0, 0], max: [1, 1, 1], open: [+z, +x]}, material: steel}]",
                .rest = "periodic: {box: [1, 1, 1], axes: [x]}"}),
      ElementsAre(
          HasSubstr("scene.yaml:5: walls[0].box.open: the sides -x stand across axes that are periodic")));
}

TEST(Mistakes, Settings) {
  const auto rest = [](const std::string& text) { return reported({.rest = text}); };
  EXPECT_THAT(rest("damping: {local: 1}"),
              ElementsAre(HasSubstr("damping.local: \"1\" is out of range; a value >= 0 "
                                    "and < 1 is wanted")));
  EXPECT_THAT(rest("damping: {local: -0.1}"),
              ElementsAre(HasSubstr("damping.local: \"-0.1\" is out of range")));
  EXPECT_THAT(rest("timestep: {policy: fixed}"),
              ElementsAre(HasSubstr("timestep: dt is missing, which policy fixed "
                                    "needs; add e.g. \"dt: 10 us\"")));
  EXPECT_THAT(rest("timestep: {dt: 1e-5}"),
              ElementsAre(HasSubstr("timestep.dt: has no meaning with policy estimate")));
  EXPECT_THAT(rest("timestep: {policy: fixed, dt: 0}"),
              ElementsAre(HasSubstr("timestep.dt: \"0\" is out of range")));
  EXPECT_THAT(rest("timestep: {policy: fixed, dt: 1 mm}"),
              ElementsAre(HasSubstr("is a length; a time is wanted")));
  EXPECT_THAT(rest("timestep: {safety: 0}"),
              ElementsAre(HasSubstr("timestep.safety: \"0\" is out of range")));
  EXPECT_THAT(rest("run: {}"), ElementsAre(HasSubstr("run: says nothing")));
  EXPECT_THAT(rest("run: {time: 0}"), ElementsAre(HasSubstr("run.time: \"0\" is out of range; a value > 0")));
  EXPECT_THAT(rest("run: {time: 5 m}"), ElementsAre(HasSubstr("\"5 m\" is a length; a time is wanted")));
  EXPECT_THAT(rest("run: {steps: 0}"), ElementsAre(HasSubstr("run.steps: 0; a whole number >= 1 is wanted")));
  EXPECT_THAT(rest("run: {steps: 1.5}"), ElementsAre(HasSubstr("run.steps: \"1.5\" is not a whole number")));
  EXPECT_THAT(rest("run: {until: {}}"),
              ElementsAre(HasSubstr("run.until: says nothing; add e.g. \"unbalanced: 1e-5\"")));
  EXPECT_THAT(rest("run: {until: {unbalanced: 0}}"),
              ElementsAre(HasSubstr("run.until.unbalanced: \"0\" is out of")));
}

TEST(Mistakes, Velocities) {
  const auto ball = [](const std::string& keys) {
    return reported({.balls = "balls: [{position: [0, 0, 1], radius: 0.1, material: grain, " + keys + "}]"});
  };
  EXPECT_THAT(
      ball("velocity: [1, 0, 2 m]"),
      ElementsAre("scene.yaml:4: balls[0].velocity[2]: \"2 m\" is a length; a velocity is wanted, e.g. "
                  "\"2 m/s\""));
  EXPECT_THAT(ball("velocity: 1"),
              ElementsAre(HasSubstr("a list of three values is wanted, e.g. \"velocity: [")));
  EXPECT_THAT(ball("spin: [0, 1]"), ElementsAre(HasSubstr("balls[0].spin: 2 values; three are wanted")));
  EXPECT_THAT(ball("spin: [0, 0, 1 m/s]"),
              ElementsAre(HasSubstr("\"1 m/s\" is a velocity; a rate is wanted, e.g. \"1 rad/s\"")));
  EXPECT_THAT(ball("spin: [0, 0, inf]"),
              ElementsAre(HasSubstr("balls[0].spin[2]: \"inf\" is not a finite number")));
}

TEST(Mistakes, Histories) {
  const auto histories = [](const std::string& entries) {
    return reported({.rest = "histories: [" + entries + "]"});
  };
  EXPECT_THAT(histories("{file: a.csv, every: 5, of: [energies, walls], balls: [0]}"), IsEmpty());
  EXPECT_THAT(histories(""), IsEmpty());
  EXPECT_THAT(histories("{of: energies}"),
              ElementsAre("scene.yaml:6: histories[0]: file is missing; add e.g. \"file: energies.csv\""));
  EXPECT_THAT(histories("{file: a.txt, of: energies}"),
              ElementsAre("scene.yaml:6: histories[0].file: \"a.txt\": does not end in .csv; write e.g. "
                          "\"a.txt.csv\""));
  EXPECT_THAT(histories("{file: .csv, of: energies}"),
              ElementsAre(HasSubstr("has nothing before .csv; write")));
  EXPECT_THAT(histories("{file: out/a.csv, of: energies}"),
              ElementsAre(HasSubstr("\"out/a.csv\": a name without folders is wanted")));
  EXPECT_THAT(histories("{file: a.csv, of: energies}, {file: a.csv, of: walls}"),
              ElementsAre("scene.yaml:6: histories[1].file: \"a.csv\" is the file of another table already "
                          "(scene.yaml:6); choose another name"));
  EXPECT_THAT(histories("{file: a.csv, every: 0, of: energies}"),
              ElementsAre(HasSubstr("histories[0].every: 0; a whole number >= 1 is wanted")));
  EXPECT_THAT(histories("{file: a.csv, of: [energy]}"),
              ElementsAre(HasSubstr(
                  "histories[0].of[0]: \"energy\" is none of energies, unbalanced, walls, wall_moments, "
                  "wall_positions, ledger")));
  EXPECT_THAT(
      histories("{file: a.csv}"),
      ElementsAre("scene.yaml:6: histories[0]: no columns; add e.g. \"of: [energies, unbalanced, walls]\", "
                  "or the numbers of balls, \"balls: [0]\""));
  EXPECT_THAT(
      histories("{file: a.csv, balls: [1]}"),
      ElementsAre("scene.yaml:6: histories[0].balls: there is no ball 1; the 1 of the scene are numbered "
                  "from 0 to 0"));
  EXPECT_THAT(histories("{file: a.csv, balls: [0, 0]}"), ElementsAre(HasSubstr("ball 0 stands there twice")));
  EXPECT_THAT(histories("{file: a.csv, balls: [-1, 0.5, [0]]}"),
              ElementsAre("scene.yaml:6: histories[0].balls[0]: -1; a whole number >= 0 is wanted",
                          HasSubstr("histories[0].balls[1]: \"0.5\" is not a whole number"),
                          HasSubstr("histories[0].balls[2]: a list stands where a whole number is wanted")));
  EXPECT_THAT(histories("{file: a.csv, balls: {a: 1}}"),
              ElementsAre(HasSubstr(
                  "a section stands where a list of whole numbers is wanted, e.g. \"balls: [0]\"")));
  EXPECT_THAT(
      reported({.walls = "", .rest = "histories: [{file: a.csv, of: [energies, walls]}]"}),
      ElementsAre("scene.yaml:6: histories[0].of: walls, and the scene has none; remove the word, or add "
                  "walls"));
  // What a mistake elsewhere left out is not missed here as well.
  EXPECT_THAT(reported({.balls = "balls: [{position: [0, 0, 1], radius: -1, material: grain}]",
                        .walls = "walls: [{plane: {point: [0, 0, 0]}, material: steel}]",
                        .rest = "histories: [{file: a.csv, of: [walls], balls: [0]}]"}),
              ElementsAre(HasSubstr("balls[0].radius"), HasSubstr("walls[0].plane: normal is missing")));
}

TEST(Mistakes, Outputs) {
  const auto outputs = [](const std::string& keys) { return reported({.rest = "outputs: {" + keys + "}"}); };
  EXPECT_THAT(outputs(""), IsEmpty());
  EXPECT_THAT(outputs("checkpoint: 10, series: 5"), IsEmpty());
  EXPECT_THAT(outputs("checkpoint: 0"),
              ElementsAre("scene.yaml:6: outputs.checkpoint: 0; a whole number >= 1 is wanted"));
  EXPECT_THAT(outputs("series: 1 s"),
              ElementsAre(HasSubstr("outputs.series: \"1 s\" is not a whole number")));
  EXPECT_THAT(outputs("frames: 5"),
              ElementsAre(HasSubstr("frames: unknown key (outputs takes checkpoint, series, fields)")));
}

TEST(Mistakes, ThatABigSceneRepeatsAreCounted) {
  std::string balls = "balls:";
  for (int k = 1; k <= 1020; ++k)
    balls += "\n  - {position: [0, 0, " + std::to_string(k) + "], radius: 0, colour: red, material: stone}";
  const std::vector<std::string> all = reported({.balls = balls});
  EXPECT_EQ(all.size(), 63U);
  EXPECT_THAT(all, Contains(HasSubstr("and 1,000 more like it")).Times(3));
}

TEST(Mistakes, ASceneFileThatIsNotThere) {
  const TemporaryFolder folder;
  folder.write("scene.yaml", "");
  try {
    read_scene(folder.path() / "scen.yaml");
    FAIL();
  } catch (const InputError& error) {
    EXPECT_EQ(error.what(), "there is no file \"" + (folder.path() / "scen.yaml").string() +
                                "\"; did you mean \"scene.yaml\"?");
  }
}

}  // namespace
}  // namespace eigengrain::io
