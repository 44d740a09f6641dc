#include "eigengrain/io/scene_reader.hpp"

#include "unit/io_support.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace eigengrain::io {
namespace {

using testing::ElementsAre;

/// The scene of the user guide, with a packing of three balls.
constexpr std::string_view smallest = R"(
gravity: [0, 0, -9.81]                # m/s2; default none
materials:
  - {name: grain, density: 2500}      # kg/m3
contacts:                             # the first entry that matches a pair holds
  - between: [grain, grain]
    law: linear
    kn: 1.0e5                         # N/m, of the pair
    ks: 5.0e4
    friction: 0.5
balls:
  - {file: packing.txt, material: grain}            # x y z r per line, m
  - {position: [0.1, 0.1, 0.3], radius: 0.005, material: grain, fix: [x, wy]}
walls:
  - {plane: {point: [0, 0, 0], normal: [0, 0, 2]}, material: grain}
  - {box: {min: [0, 0, 0], max: [0.21, 0.21, 0.254], open: [+z]}, material: grain}
damping: {local: 0.3}
timestep: {policy: bound, safety: 0.5}
run: {steps: 10000, until: {unbalanced: 1.0e-5}}
)";
constexpr std::string_view packing =
    "# three balls\n0.05 0.05 0.01 0.005\n0.10 0.05 0.01 0.004\n\n0.15 0.05 0.01 0.003\n";

TEST(ReadScene, SmallestScene) {
  const TemporaryFolder folder;
  folder.write("packing.txt", packing);
  const auto file = folder.write("scene.yaml", smallest);
  const model::Scene scene = read_scene(file);

  EXPECT_EQ(scene.name, file.string());
  EXPECT_EQ(scene.gravity, Vec3(0, 0, -9.81));
  ASSERT_EQ(scene.materials.size(), 1U);
  EXPECT_EQ(scene.materials[0].name, "grain");
  EXPECT_EQ(scene.materials[0].density, 2500);
  ASSERT_EQ(scene.contacts.size(), 1U);
  EXPECT_EQ(scene.contacts[0].law, "linear");
  ASSERT_GE(scene.contacts[0].parameters.size(), 3U);
  EXPECT_EQ(scene.contacts[0].parameters[0], 1e5);
  EXPECT_EQ(scene.contacts[0].parameters[1], 5e4);
  EXPECT_EQ(scene.contacts[0].parameters[2], 0.5);
  EXPECT_EQ(scene.rule_for(0, 0), 0);
  EXPECT_EQ(scene.local_damping, 0.3);
  EXPECT_EQ(scene.timestep.policy, model::TimestepPolicy::bound);
  EXPECT_EQ(scene.timestep.safety, 0.5);
  EXPECT_FALSE(scene.timestep.dt.has_value());
  EXPECT_EQ(scene.run.steps, 10000);
  EXPECT_EQ(scene.run.unbalanced, 1e-5);
  EXPECT_FALSE(scene.cell.any());
}

TEST(ReadScene, FillsEveryColumnOfTheBodiesInTheOrderOfTheScene) {
  const TemporaryFolder folder;
  folder.write("packing.txt", packing);
  const model::Bodies bodies = read_scene(folder.write("scene.yaml", smallest)).bodies;
  ASSERT_EQ(bodies.size(), 4);
  EXPECT_THAT(bodies.identity, ElementsAre(0, 1, 2, 3));
  EXPECT_THAT(bodies.radius, ElementsAre(0.005, 0.004, 0.003, 0.005));
  EXPECT_EQ(bodies.position[2], Vec3(0.15, 0.05, 0.01));
  EXPECT_EQ(bodies.position[3], Vec3(0.1, 0.1, 0.3));
  EXPECT_THAT(bodies.material, ElementsAre(0, 0, 0, 0));
  EXPECT_EQ(bodies.mass[1], model::sphere_mass(0.004, 2500));
  EXPECT_EQ(bodies.inertia[1], model::sphere_inertia(0.004, bodies.mass[1]));
  EXPECT_EQ(bodies.fixed[0].bits(), 0);
  EXPECT_EQ(bodies.fixed[3].bits(), 0b010001);
}

TEST(ReadScene, BoxesBecomePlanesThatFaceInwards) {
  const TemporaryFolder folder;
  folder.write("packing.txt", packing);
  const std::vector<model::Plane> walls = read_scene(folder.write("scene.yaml", smallest)).walls;
  ASSERT_EQ(walls.size(), 6U);
  EXPECT_EQ(walls[0].name, "wall 1 (plane)");
  EXPECT_EQ(walls[0].normal, Vec3(0, 0, 1));
  const std::vector<std::string> names{"-x", "+x", "-y", "+y", "-z"};
  for (std::size_t k = 0; k < names.size(); ++k)
    EXPECT_EQ(walls[k + 1].name, "wall 2 (box " + names[k] + ")");
  EXPECT_EQ(walls[2].normal, Vec3(-1, 0, 0));
  EXPECT_EQ(walls[2].point, Vec3(0.21, 0.21, 0.254));
  EXPECT_EQ(walls[5].normal, Vec3(0, 0, 1));
  EXPECT_EQ(walls[5].material, 0);
}

constexpr std::string_view one_ball = R"(
materials: [{name: grain, density: 2.5 g/cm3}, {name: steel}]
contacts:
  - {between: [steel, any], law: linear, kn: 1 kN/mm, tension: true}
  - {between: [any, any], law: none}
balls: [{position: [5 mm, 0, -2 cm], radius: 5 mm, material: grain, fix: all}]
)";

TEST(ReadScene, DefaultsAreThoseOfTheModel) {
  const model::Scene scene = read_scene_text(one_ball, ".");
  const model::Scene defaults;
  EXPECT_EQ(scene.name, "scene");
  EXPECT_EQ(scene.gravity, Vec3(0, 0, 0));
  EXPECT_EQ(scene.local_damping, defaults.local_damping);
  EXPECT_EQ(scene.timestep.policy, defaults.timestep.policy);
  EXPECT_EQ(scene.timestep.safety, defaults.timestep.safety);
  EXPECT_FALSE(scene.run.steps.has_value());
  EXPECT_FALSE(scene.run.unbalanced.has_value());
  EXPECT_FALSE(scene.run.time.has_value());
  EXPECT_TRUE(scene.walls.empty());
  EXPECT_TRUE(scene.bodies.velocity.empty());
  EXPECT_TRUE(scene.bodies.spin.empty());
  EXPECT_TRUE(scene.histories.empty());
  EXPECT_EQ(scene.outputs.checkpoint_every, 10000);
  EXPECT_EQ(scene.outputs.series_every, 0);
  // An empty section is the same as none.
  const model::Scene empty = read_scene_text(std::string(one_ball) + "timestep: {}\ndamping: {}\n", ".");
  EXPECT_EQ(empty.local_damping, defaults.local_damping);
  EXPECT_EQ(empty.timestep.policy, defaults.timestep.policy);
  EXPECT_EQ(empty.timestep.safety, defaults.timestep.safety);
}

TEST(ReadScene, QuantitiesWithUnitsAndRulesForAny) {
  const model::Scene scene = read_scene_text(one_ball, ".");
  EXPECT_EQ(scene.materials[0].density, 2500);
  EXPECT_EQ(scene.bodies.position[0], Vec3(0.005, 0, -0.02));
  EXPECT_TRUE(scene.bodies.fixed[0].all());
  EXPECT_EQ(scene.contacts[0].first, 1);
  EXPECT_EQ(scene.contacts[0].second, model::ContactRule::any_material);
  EXPECT_EQ(scene.contacts[0].parameters[0], 1e6);
  EXPECT_EQ(scene.contacts[1].law, "none");
  EXPECT_TRUE(scene.contacts[1].parameters.empty());
  EXPECT_EQ(scene.rule_for(0, 1), 0);
  EXPECT_EQ(scene.rule_for(0, 0), 1);
}

TEST(ReadScene, VelocitiesAreColumnsOnlyWhereSomeBallMoves) {
  const TemporaryFolder folder;
  folder.write("packing.txt", packing);
  const auto bodies_with = [&](const std::string& of_file, const std::string& of_last) {
    return read_scene_text(
               "materials: [{name: grain, density: 2500}]\n"
               "contacts: [{between: [any, any], law: none}]\n"
               "balls:\n"
               "  - {position: [0, 0, 1], radius: 0.1, material: grain}\n"
               "  - {file: packing.txt, material: grain" +
                   of_file +
                   "}\n"
                   "  - {position: [0, 0, 2], radius: 0.1, material: grain" +
                   of_last + "}\n",
               folder.path())
        .bodies;
  };
  const model::Bodies at_rest = bodies_with(", velocity: [0, 0, 0]", ", spin: [0, 0, 0]");
  EXPECT_TRUE(at_rest.velocity.empty());
  EXPECT_TRUE(at_rest.spin.empty());

  const Vec3 v(0.001, 0, -2);
  const Vec3 w(0, 0.5, 10);
  const model::Bodies moving =
      bodies_with(", velocity: [1 mm/s, 0, -2]", ", spin: [0, 500 mrad/s, 10], fix: [wx]");
  EXPECT_THAT(moving.velocity, ElementsAre(Vec3(0, 0, 0), v, v, v, Vec3(0, 0, 0)));
  EXPECT_THAT(moving.spin, ElementsAre(Vec3(0, 0, 0), Vec3(0, 0, 0), Vec3(0, 0, 0), Vec3(0, 0, 0), w));
  EXPECT_EQ(moving.fixed[4].bits(), 0b001000);
  EXPECT_TRUE(bodies_with("", ", velocity: [1, 0, 0]").spin.empty());
}

TEST(ReadScene, WhatARunWrites) {
  const model::Scene scene = read_scene_text(std::string(one_ball) + R"(
run: {time: 20 ms}
walls: [{plane: {point: [0, 0, -1], normal: [0, 0, 1]}, material: steel}]
histories:
  - {file: energies.csv, every: 1e2, of: [energies, unbalanced]}
  - {file: rest.csv, of: walls, balls: [0]}
outputs: {checkpoint: 5000, series: 100}
)",
                                             ".");
  EXPECT_FALSE(scene.run.steps.has_value());
  EXPECT_EQ(scene.run.time, 0.02);
  ASSERT_EQ(scene.histories.size(), 2U);
  const model::History& energies = scene.histories[0];
  EXPECT_EQ(energies.file, "energies.csv");
  EXPECT_EQ(energies.every, 100);
  EXPECT_TRUE(energies.energies && energies.unbalanced && !energies.walls);
  EXPECT_TRUE(energies.balls.empty());
  const model::History& rest = scene.histories[1];
  EXPECT_EQ(rest.every, 1);
  EXPECT_TRUE(!rest.energies && !rest.unbalanced && rest.walls);
  EXPECT_THAT(rest.balls, ElementsAre(0));
  EXPECT_EQ(scene.outputs.checkpoint_every, 5000);
  EXPECT_EQ(scene.outputs.series_every, 100);
}

TEST(ReadScene, PeriodicCellWrapsTheCentres) {
  const model::Scene scene = read_scene_text(R"(
materials: [{name: grain, density: 2500}]
contacts: [{between: [grain, grain], law: none}]
balls: [{position: [2.5, -1, 7], radius: 0.1, material: grain}]
periodic: {box: [2, 4, 0], origin: [-1, 0, 0], axes: [x, y]}
)",
                                             ".");
  EXPECT_EQ(scene.cell.periodic, (std::array{true, true, false}));
  EXPECT_EQ(scene.cell.edges, Mat3(Vec3(2, 4, 0).asDiagonal()));
  EXPECT_EQ(scene.cell.origin, Vec3(-1, 0, 0));
  EXPECT_EQ(scene.bodies.position[0], Vec3(0.5, 3, 7));
}

TEST(ReadScene, AnchorsMayRepeatAnEntry) {
  const model::Scene scene = read_scene_text(R"(
materials: [{name: grain, density: &d 2500}, {name: other, density: *d}]
balls: [{position: [0, 0, 0], radius: 1, material: other}]
)",
                                             ".");
  EXPECT_EQ(scene.materials[1].density, 2500);
}

TEST(ReadScene, ExampleFilesOfTheSeed) {
  const model::Scene scene = read_scene_text(R"(
materials: [{name: grain, density: 2500}]
contacts: [{between: [any, any], law: linear, kn: 1e5}]
balls: [{file: data/packing_10k.txt, material: grain}]
walls: [{box: {min: [0, 0, 0], max: [0.21, 0.21, 0.254], open: [+z]}, material: grain}]
)",
                                             EIGENGRAIN_EXAMPLES);
  EXPECT_EQ(scene.bodies.size(), 10000);
}

TEST(Overrides, ActAsIfTheFileSaidSo) {
  const std::vector<std::string> overrides{
      "contacts.0.kn=2e5",
      "contacts[0].friction=0.25",
      "timestep.safety=0.5",
      "run={steps: 7}",
      "gravity=[0, -9.81 m/s2, 0]",
      "balls.0.fix=[y]",
      "run.until.unbalanced = 1e-3",
      "materials.0.density=2000 kg/m3",
      "run.steps=9",
  };
  const model::Scene scene = read_scene_text(one_ball, ".", "scene", overrides);
  EXPECT_EQ(scene.contacts[0].parameters[0], 2e5);
  EXPECT_EQ(scene.contacts[0].parameters[2], 0.25);
  EXPECT_EQ(scene.timestep.safety, 0.5);
  EXPECT_EQ(scene.run.steps, 9);
  EXPECT_EQ(scene.run.unbalanced, 1e-3);
  EXPECT_EQ(scene.gravity, Vec3(0, -9.81, 0));
  EXPECT_EQ(scene.bodies.fixed[0].bits(), 0b10);
  EXPECT_EQ(scene.materials[0].density, 2000);
}

TEST(Overrides, MistakesNameTheOverride) {
  const auto text = [](const std::string& assignment) {
    const std::vector<Mistake> mistakes = mistakes_in(one_ball, {assignment});
    return mistakes.empty() ? std::string("none") : mistakes.front().text();
  };
  using testing::StartsWith;
  EXPECT_THAT(text("timestep.safety=2"),
              StartsWith("--set timestep.safety=2: timestep.safety: \"2\" is out of range"));
  EXPECT_THAT(text("timestep.safty=0.5"),
              StartsWith("--set timestep.safty=0.5: timestep.safty: unknown key; did you mean \"safety\"?"));
  EXPECT_THAT(text("timstep.safety=0.5"),
              StartsWith("--set timstep.safety=0.5: timstep: unknown key; did you mean \"timestep\"?"));
  EXPECT_THAT(
      text("contacts.0.kn=5 m"),
      StartsWith("--set contacts.0.kn=5 m: contacts[0].kn: \"5 m\" is a length; a stiffness is wanted"));
  EXPECT_THAT(text("contacts.2.kn=5"),
              StartsWith("--set contacts.2.kn=5: \"2\" is no entry of the list; its 2 "
                         "entries are numbered from 0 to 1"));
  EXPECT_THAT(text("contacts.first.kn=5"), testing::HasSubstr("\"first\" is no entry of the list"));
  EXPECT_THAT(text("contacts.0.kn.x=5"), testing::HasSubstr("is a single value and has no keys"));
  EXPECT_THAT(text("safety"), StartsWith("--set safety: not of the form key=value"));
  EXPECT_THAT(text("=5"), testing::HasSubstr("not of the form key=value"));
  EXPECT_THAT(text("a..b=5"), testing::HasSubstr("not of the form key=value"));
  EXPECT_THAT(text("gravity=[1, 2"), StartsWith("--set gravity=[1, 2: not valid YAML"));
  EXPECT_THAT(text("damping.local="), StartsWith("--set damping.local=: damping.local: empty"));
}

}  // namespace
}  // namespace eigengrain::io
