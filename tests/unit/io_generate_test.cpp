#include "unit/io_support.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>

namespace eigengrain::io {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::StartsWith;

/// A scene of one entry of balls, on line 3.
std::string scene_of(const std::string& entry, const std::string& rest = "") {
  return "materials: [{name: grain, density: 2500}]\n"
         "contacts: [{between: [any, any], law: linear, kn: 1e5}]\n"
         "balls: [{material: grain, " +
         entry + "}]\n" + rest + "\n";
}

std::vector<std::string> reported(const std::string& entry, const std::string& rest = "") {
  return texts_of(mistakes_in(scene_of(entry, rest)));
}

const std::string unit_box = "box: {min: [0, 0, 0], max: [1, 1, 1]}";

TEST(GeneratedBalls, ALatticeFillsItsBoxWithTheEntrysMaterialAndMotion) {
  const model::Scene scene = read_scene_text(
      scene_of("lattice: sc, radius: 50 mm, velocity: [0, 0, 1], box: {min: [1, 1, 1], max: [2, 2, 1.2]}"),
      ".");
  ASSERT_EQ(scene.bodies.size(), 200);
  EXPECT_THAT(scene.bodies.radius, testing::Each(0.05));
  EXPECT_THAT(scene.bodies.material, testing::Each(0));
  EXPECT_EQ(scene.bodies.velocity.back(), Vec3(0, 0, 1));
  EXPECT_EQ(scene.bodies.position.front(), Vec3::Constant(1.05));
}

TEST(GeneratedBalls, WithoutABoxTheyFillThePeriodicCell) {
  const std::string periodic = "periodic: {box: [1, 1, 1], origin: [2, 0, 0]}";
  const model::Scene scene = read_scene_text(scene_of("lattice: sc, radius: 50 mm", periodic), ".");
  EXPECT_EQ(scene.bodies.size(), 1000);
  EXPECT_EQ(scene.bodies.position.front(), Vec3(2, 0, 0));
  // A box that spans the cell in x only repeats in x only.
  const model::Scene part = read_scene_text(
      scene_of("lattice: sc, radius: 50 mm, box: {min: [2, 0.1, 0.1], max: [3, 0.9, 0.9]}", periodic), ".");
  EXPECT_EQ(part.bodies.size(), 10 * 8 * 8);
  // 0.1 + 0.05 rounds to another number than 0.15.
  EXPECT_LT((part.bodies.position.front() - Vec3(2, 0.15, 0.15)).norm(), 1e-16);
}

TEST(GeneratedBalls, SpacingAndOverlapSetTheDistance) {
  const auto count = [](const std::string& more) {
    return read_scene_text(scene_of("lattice: sc, radius: 50 mm, " + unit_box + more), ".").bodies.size();
  };
  EXPECT_EQ(count(", spacing: 0.3"), 64);      // 0.05, 0.35, 0.65, 0.95
  EXPECT_EQ(count(", overlap: 10 mm"), 1331);  // 0.05 + 0.09 k, k = 0 ... 10
}

TEST(GeneratedBalls, FillsReachTheirFractionAndNoteIt) {
  const model::Scene loose =
      read_scene_text(scene_of("fill: random, fraction: 0.2, radius: 50 mm, " + unit_box), ".");
  // 0.2/(4/3 π 0.05³) = 381.97
  EXPECT_EQ(loose.bodies.size(), 382);
  EXPECT_THAT(loose.notes, ElementsAre("balls[0]: 382 balls at a solid fraction of 0.20001; none overlap"));
  const std::string periodic = "periodic: {box: [1, 1, 1]}";
  const model::Scene dense = read_scene_text(
      scene_of("fill: dense, fraction: 0.5, sizes: {distribution: uniform, min: 40 mm, max: 60 mm}",
               periodic),
      ".");
  EXPECT_THAT(dense.notes, ElementsAre(HasSubstr("none overlap")));
  double solid = 0;
  for (const double m : dense.bodies.mass) solid += m / 2500;
  EXPECT_NEAR(solid, 0.5, model::sphere_mass(0.06, 1) / 2);
  const model::Scene pressed =
      read_scene_text(scene_of("fill: dense, mean_overlap: 1e-2, radius: 0.1", periodic), ".");
  EXPECT_THAT(pressed.notes,
              ElementsAre(testing::AllOf(HasSubstr("of r_a + r_b on average"), HasSubstr("contacts a ball"),
                                         HasSubstr("times those given"))));
}

TEST(GeneratedBalls, TheSeedDecides) {
  const auto positions = [](const std::string& more) {
    return read_scene_text(scene_of("fill: random, fraction: 0.1, radius: 0.1, " + unit_box + more), ".")
        .bodies.position;
  };
  EXPECT_EQ(positions(""), positions(", seed: 1"));
  EXPECT_NE(positions(""), positions(", seed: 2"));
}

TEST(GeneratedBalls, EveryDistributionIsRead) {
  for (const char* sizes :
       {"distribution: uniform, min: 40 mm, max: 60 mm", "distribution: normal, mean: 50 mm, deviation: 5 mm",
        "distribution: normal, mean: 50 mm, deviation: 50 mm, min: 40 mm, max: 60 mm",
        "distribution: lognormal, mean: 50 mm, deviation: 5 mm, max: 60 mm",
        "distribution: power, exponent: -3, min: 40 mm, max: 60 mm",
        "distribution: table, radii: [40 mm, 60 mm], shares: [1, 2]",
        "distribution: table, radii: [40 mm, 60 mm], passing: [0, 1], by: mass"}) {
    const model::Scene scene = read_scene_text(
        scene_of("fill: random, fraction: 0.1, sizes: {" + std::string(sizes) + "}, " + unit_box), ".");
    EXPECT_GT(scene.bodies.size(), 50) << sizes;
    EXPECT_NE(scene.bodies.radius.front(), scene.bodies.radius.back()) << sizes;
  }
}

TEST(GeneratedBalls, MistakesOfAFill) {
  const std::string rest = ", radius: 0.1, " + unit_box;
  EXPECT_THAT(
      reported("fill: rando, fraction: 0.1" + rest),
      ElementsAre(
          "scene.yaml:3: balls[0].fill: \"rando\" is none of random, dense; did you mean \"random\"?"));
  EXPECT_THAT(reported("fill: random" + rest),
              ElementsAre(StartsWith("scene.yaml:3: balls[0]: fraction is missing; add")));
  EXPECT_THAT(reported("fill: dense" + rest),
              ElementsAre(StartsWith("scene.yaml:3: balls[0]: fraction is missing, or mean_overlap; add")));
  EXPECT_THAT(reported("fill: dense, fraction: 0.6, mean_overlap: 0.01" + rest),
              ElementsAre(HasSubstr("balls[0].mean_overlap: beside fraction; one follows from the other")));
  EXPECT_THAT(reported("fill: random, mean_overlap: 0.01" + rest),
              ElementsAre(HasSubstr("balls[0].mean_overlap: has no meaning with fill: random")));
  EXPECT_THAT(reported("fill: random, fraction: 60" + rest),
              ElementsAre(HasSubstr("balls[0].fraction: \"60\" is out of")));
  EXPECT_THAT(
      reported("fill: random, fraction: 0.1, spacing: 1" + rest),
      ElementsAre("scene.yaml:3: balls[0].spacing: not beside fill, which takes radius, sizes, fraction, "
                  "mean_overlap, seed, box; remove one of the two"));
  EXPECT_THAT(reported("fill: random, fraction: 0.6" + rest),
              ElementsAre(HasSubstr("scene.yaml:3: balls[0].fill: ball ")));
  EXPECT_THAT(reported("fill: random, fraction: 0.1, " + unit_box),
              ElementsAre(StartsWith("scene.yaml:3: balls[0]: radius is missing, or sizes; add")));
}

TEST(GeneratedBalls, MistakesOfSizes) {
  const auto sizes = [](const std::string& text) {
    return reported("fill: random, fraction: 0.1, sizes: {" + text + "}, " + unit_box);
  };
  EXPECT_THAT(
      reported("fill: random, fraction: 0.1, radius: 1, sizes: {distribution: uniform, min: 1, max: 2}, " +
               unit_box),
      ElementsAre(HasSubstr("balls[0].sizes: beside radius, which gives all balls one size")));
  EXPECT_THAT(sizes("min: 0.1, max: 0.2"),
              ElementsAre(StartsWith("scene.yaml:3: balls[0].sizes: distribution is missing")));
  EXPECT_THAT(sizes("distribution: unifrm, min: 0.1, max: 0.2"),
              ElementsAre(HasSubstr("did you mean \"uniform\"?")));
  EXPECT_THAT(
      sizes("distribution: uniform, min: 0.1"),
      ElementsAre(HasSubstr("balls[0].sizes: max is missing, which distribution uniform needs; add")));
  EXPECT_THAT(sizes("distribution: uniform, min: 0.2, max: 0.1"),
              ElementsAre("scene.yaml:3: balls[0].sizes.max: 0.1 m is not above min, 0.2 m"));
  EXPECT_THAT(
      sizes("distribution: power, exponent: -2, min: 0.1, max: 0.2, mean: 0.1"),
      ElementsAre("scene.yaml:3: balls[0].sizes.mean: has no meaning with distribution power, which takes "
                  "exponent, min, max; remove it"));
  EXPECT_THAT(
      sizes("distribution: normal, mean: 0.1, deviation: 0.05"),
      ElementsAre(HasSubstr("balls[0].sizes: min is missing, and mean - 3 deviations is not positive; add")));
  EXPECT_THAT(sizes("distribution: normal, mean: 0.1, deviation: 1 mm, min: 0.2, max: 0.3"),
              ElementsAre(HasSubstr(
                  "balls[0].fill: only a part of 0 of the distribution lies between 0.2 and 0.3 m")));
  EXPECT_THAT(sizes("distribution: table, radii: [0.1, 0.2]"),
              ElementsAre(HasSubstr("balls[0].sizes: wants shares or passing beside radii")));
  EXPECT_THAT(sizes("distribution: table, radii: [0.1, 0.2], shares: [1]"),
              ElementsAre(HasSubstr("balls[0].sizes.shares: 1 values, and radii has 2; as many are wanted")));
  EXPECT_THAT(sizes("distribution: table, radii: [0.1, 0.2], shares: [0, 0]"),
              ElementsAre(HasSubstr("nothing but zeros")));
  EXPECT_THAT(sizes("distribution: table, radii: [0.2, 0.1], passing: [0, 1]"),
              ElementsAre(HasSubstr("balls[0].sizes.radii: not in increasing order")));
  EXPECT_THAT(sizes("distribution: table, radii: [0.1, 0.2], passing: [0.2, 1]"),
              ElementsAre(HasSubstr("balls[0].sizes.passing: does not increase from 0")));
  EXPECT_THAT(sizes("distribution: table, radii: [0.1, 5 s], shares: [1, 1]"),
              ElementsAre(HasSubstr("balls[0].sizes.radii[1]: \"5 s\" is a time; a length is wanted")));
}

TEST(GeneratedBalls, MistakesOfALattice) {
  EXPECT_THAT(reported("latice: fcc, radius: 1, " + unit_box),
              ElementsAre(StartsWith("scene.yaml:3: balls[0].latice: unknown key; did you mean \"lattice\"?"),
                          StartsWith("scene.yaml:3: balls[0]: neither file nor position")));
  EXPECT_THAT(
      reported("lattice: fc, radius: 0.1, " + unit_box),
      ElementsAre("scene.yaml:3: balls[0].lattice: \"fc\" is none of sc, bcc, fcc, hcp, diamond, square, "
                  "hexagonal; did you mean \"sc\"?"));
  EXPECT_THAT(reported("lattice: fcc, " + unit_box),
              ElementsAre(StartsWith("scene.yaml:3: balls[0]: radius is missing")));
  EXPECT_THAT(
      reported("lattice: fcc, radius: 0.1"),
      ElementsAre(StartsWith("scene.yaml:3: balls[0]: box is missing, which says where the balls go")));
  EXPECT_THAT(reported("lattice: fcc, radius: 0.1", "periodic: {box: [1, 1, 1], axes: [x, y]}"),
              ElementsAre(StartsWith(
                  "scene.yaml:3: balls[0]: box is missing, which the region needs, as the cell does "
                  "not repeat along z")));
  EXPECT_THAT(reported("lattice: fcc, radius: 0.1, box: {min: [0, 0, 0], mx: [1, 1, 1]}"),
              ElementsAre(StartsWith("scene.yaml:3: balls[0].box.mx: unknown key; did you mean \"max\"?"),
                          StartsWith("scene.yaml:3: balls[0].box: max is missing")));
  EXPECT_THAT(reported("lattice: fcc, radius: 0.1, box: {min: [0, 0, 0], max: [1, 0, 1]}"),
              ElementsAre("scene.yaml:3: balls[0].box.max: y = 0 m is not above the y = 0 m of min"));
  EXPECT_THAT(
      reported("lattice: fcc, radius: 0.1, spacing: 0.3, overlap: 0, " + unit_box),
      ElementsAre(
          "scene.yaml:3: balls[0].overlap: beside spacing, which says the same; remove one of the two"));
  EXPECT_THAT(reported("lattice: fcc, radius: 0.1, overlap: 0.2, " + unit_box),
              ElementsAre("scene.yaml:3: balls[0].overlap: 0.2 m is not less than the diameter of 0.2 m"));
  EXPECT_THAT(
      reported("lattice: sc, radius: 0.7, " + unit_box),
      ElementsAre(HasSubstr("balls[0].lattice: a ball of radius 0.7 m does not fit into the region")));
}

TEST(GeneratedBalls, MistakesOfABoxInAPeriodicCell) {
  const std::string periodic = "periodic: {box: [1.05, 1, 1]}";
  EXPECT_THAT(reported("lattice: sc, radius: 0.05", periodic),
              ElementsAre(HasSubstr(
                  "scene.yaml:3: balls[0].lattice: the lattice does not repeat with the cell: along x "
                  "the cell is 1.05 m long, 10.5 times")));
  EXPECT_THAT(
      reported("lattice: sc, radius: 0.05, box: {min: [0.2, 0, 0], max: [1.2, 1, 1]}", periodic),
      ElementsAre(
          "scene.yaml:3: balls[0].box: reaches out of the periodic cell, which spans 0 to 1.05 m along "
          "x"));
}

TEST(GeneratedBalls, KeysOfOtherEntriesAreNotIgnored) {
  EXPECT_THAT(
      reported("position: [0, 0, 0], radius: 1, spacing: 2, " + unit_box),
      ElementsAre(
          "scene.yaml:3: balls[0].spacing: not beside position, which takes radius; remove one of the two",
          "scene.yaml:3: balls[0].box: not beside position, which takes radius; remove one of the two"));
  EXPECT_THAT(reported("position: [0, 0, 0], radius: 1, lattice: sc"),
              ElementsAre(HasSubstr("balls[0].lattice: not beside position")));
}

}  // namespace
}  // namespace eigengrain::io
