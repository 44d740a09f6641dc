// Parameters of contacts that come from the materials of the two sides.
#include "eigengrain/contact/law_table.hpp"

#include "unit/io_support.hpp"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace eigengrain::io {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

std::string scene_text(const std::string& materials, const std::string& contacts) {
  return fmt::format(R"(materials: [{}]
contacts: [{}]
balls:
  - {{position: [0, 0, 1], radius: 0.1, material: glass}}
  - {{position: [0, 0, 2], radius: 0.1, material: glass}}
  - {{position: [0, 0, 3], radius: 0.1, material: steel}}
walls: [{{plane: {{point: [0, 0, 0], normal: [0, 0, 1]}}, material: floor}}]
)",
                     materials, contacts);
}

model::Scene scene_of(const std::string& materials, const std::string& contacts) {
  return read_scene_text(scene_text(materials, contacts), ".", "scene.yaml");
}

std::vector<std::string> reported(const std::string& materials, const std::string& contacts) {
  return texts_of(mistakes_in(scene_text(materials, contacts)));
}

/// Value of a parameter for two materials, by their places.
double value(const model::Scene& scene, std::int32_t a, std::int32_t b, std::string_view parameter) {
  const model::ContactRule& rule = scene.contacts[static_cast<std::size_t>(scene.rule_for(a, b))];
  const auto parameters = contact::find_law(rule.law)->parameters;
  for (std::size_t k = 0; k < parameters.size(); ++k)
    if (parameters[k].name == parameter) return rule.parameters[k];
  return -1;
}

const std::string springs =
    "{name: glass, density: 2500, kn: 3e5, ks: 2e5}, {name: steel, density: 7850, kn: 6e5}, "
    "{name: floor, rigid: true}";

TEST(MaterialsInSeries, GiveTheLinearStiffness) {
  const model::Scene scene = scene_of(springs, "{between: [any, any], law: linear, friction: 0.5}");
  EXPECT_NEAR(value(scene, 0, 0, "kn"), 1.5e5, 1e-9);
  EXPECT_NEAR(value(scene, 0, 1, "kn"), 2e5, 1e-9);
  EXPECT_NEAR(value(scene, 1, 0, "kn"), 2e5, 1e-9);
  EXPECT_EQ(value(scene, 0, 2, "kn"), 3e5);  // a rigid floor leaves the ball's own
  EXPECT_NEAR(value(scene, 0, 0, "ks"), 1e5, 1e-9);
  EXPECT_EQ(value(scene, 0, 1, "ks"), 0);  // steel says nothing: the default
  EXPECT_EQ(value(scene, 0, 1, "friction"), 0.5);
}

TEST(MaterialsInSeries, StandBehindWhatThePairSays) {
  const model::Scene scene = scene_of(
      springs, "{between: [glass, floor], law: linear, kn: 7e5}, {between: [any, any], law: linear, ks: 1}");
  EXPECT_EQ(value(scene, 0, 2, "kn"), 7e5);
  EXPECT_EQ(value(scene, 1, 2, "kn"), 6e5);
  EXPECT_EQ(value(scene, 0, 1, "ks"), 1);
  EXPECT_EQ(scene.contacts[static_cast<std::size_t>(scene.rule_for(0, 2))].entry, 0);
  EXPECT_EQ(scene.contacts[static_cast<std::size_t>(scene.rule_for(1, 2))].entry, 1);
}

// 1/E* = Σ(1 - ν²)/E, 1/G* = Σ(2 - ν)/G, G = E/2(1 + ν); glass and steel of Chung and Ooi.
TEST(MaterialsInSeries, GiveTheModuliOfHertz) {
  const model::Scene scene = scene_of(
      "{name: glass, density: 2800, young: 48 GPa, poisson: 0.2}, {name: steel, density: 7850, young: 208 "
      "GPa, "
      "poisson: 0.3}, {name: floor, rigid: true}",
      "{between: [any, any], law: hertz, friction: 0.3}");
  EXPECT_NEAR(value(scene, 0, 0, "effective_young") / 25e9, 1, 1e-14);
  EXPECT_NEAR(value(scene, 0, 1, "effective_young") / (1 / (0.96 / 48e9 + 0.91 / 208e9)), 1, 1e-14);
  EXPECT_NEAR(value(scene, 0, 2, "effective_young") / 50e9, 1, 1e-14);
  EXPECT_NEAR(value(scene, 0, 1, "effective_shear") / (1 / (1.8 / 20e9 + 1.7 / 80e9)), 1, 1e-14);
}

TEST(MaterialsInSeries, AreMissedByName) {
  EXPECT_THAT(
      reported("{name: glass, density: 2500, kn: 3e5}, {name: steel, density: 7850}, {name: floor}",
               "{between: [any, any], law: linear}"),
      ElementsAre("scene.yaml:2: contacts[0]: kn is missing; add e.g. \"kn: 1 N/m\", or give kn to the "
                  "material \"floor\" and the material \"steel\""));
  EXPECT_THAT(
      reported("{name: glass, density: 2500, young: 1 GPa}, {name: steel, rigid: true, density: 1}, "
               "{name: floor, rigid: true}",
               "{between: [any, any], law: hertz, effective_shear: 0}"),
      ElementsAre(HasSubstr("contacts[0]: effective_young is missing; add e.g. \"effective_young: 1 Pa\", or "
                            "give young and poisson to the material \"glass\"")));
  EXPECT_THAT(
      reported("{name: glass, density: 2500, kn: 1}, {name: steel, rigid: true, density: 1}, {name: floor, "
               "rigid: true}",
               "{between: [any, any], law: linear}"),
      ElementsAre(HasSubstr("contacts[0]: kn is left to the materials, and two rigid ones can meet; give kn "
                            "here, or take `rigid` from one of them")));
}

// What never meets needs nothing: here floor and floor, and steel and steel with one ball of it.
TEST(MaterialsInSeries, AreAskedOnlyWhereBallsCanMeet) {
  EXPECT_THAT(
      reported("{name: glass, density: 2500, kn: 3e5}, {name: steel, density: 7850, kn: 1}, {name: floor, "
               "kn: 1}, {name: dust}",
               "{between: [any, any], law: linear}"),
      IsEmpty());
}

TEST(Dashpots, AreGivenInOneWayOnly) {
  const std::string materials = "{name: glass, density: 1}, {name: steel, density: 1}, {name: floor}";
  for (const std::string law : {"linear, kn: 1", "hertz, effective_young: 1 GPa, effective_shear: 0"}) {
    EXPECT_THAT(
        reported(materials, "{between: [any, any], law: " + law + ", beta_n: 0.2, restitution: 0.5}"),
        ElementsAre(HasSubstr("contacts[0]: both beta_n and restitution are given, and each says how strong "
                              "the dashpot along the normal is; keep one of the two")));
    EXPECT_THAT(
        reported(materials, "{between: [any, any], law: " + law + ", restitution: 1.5}"),
        ElementsAre(HasSubstr("contacts[0].restitution: \"1.5\" is out of range; a value > 0 and <= 1 is "
                              "wanted")));
  }
}

TEST(Shear, IsCarriedInOneWayOnly) {
  EXPECT_THAT(
      reported("{name: glass, density: 1}, {name: steel, density: 1}, {name: floor}",
               "{between: [any, any], law: linear, kn: 1, small_angle: true, projected: true}"),
      ElementsAre(HasSubstr("contacts[0]: small_angle and projected are two ways to carry the shear force")));
}

TEST(Hysteretic, WantsItsRestitution) {
  const std::string materials = "{name: glass, density: 1}, {name: steel, density: 1}, {name: floor}";
  EXPECT_THAT(reported(materials, "{between: [any, any], law: hysteretic, kn: 1}"),
              ElementsAre(HasSubstr("contacts[0]: restitution is missing; add e.g. \"restitution: 1\"")));
}

}  // namespace
}  // namespace eigengrain::io
