// Bonds as scene files ask for them.
#include "eigengrain/assembly/bonds.hpp"
#include "eigengrain/assembly/contact_list.hpp"
#include "eigengrain/io/scene_reader.hpp"

#include "unit/io_support.hpp"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <limits>

namespace eigengrain::io {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

std::string scene(const std::string& law, const std::string& bond) {
  return fmt::format(R"(materials: [{{name: grain, density: 2500}}, {{name: steel}}]
contacts: [{{between: [grain, grain], {}, bond: {}}}, {{between: [any, any], law: linear, kn: 1e5}}]
balls:
  - {{position: [0, 0, 0], radius: 5 mm, material: grain}}
  - {{position: [10 mm, 0, 0], radius: 5 mm, material: grain}}
  - {{position: [0, 10.1 mm, 0], radius: 5 mm, material: grain}}
walls: [{{plane: {{point: [0, 0, -5 mm], normal: [0, 0, 1]}}, material: steel}}]
)",
                     law, bond);
}

std::vector<std::string> mistakes(const std::string& law, const std::string& bond) {
  return texts_of(mistakes_in(scene(law, bond)));
}

constexpr const char* springs = "law: linear, kn: 1e5";

TEST(BondScene, GivesWhatItSays) {
  const model::Scene read = read_scene_text(
      scene(springs, "{kind: parallel, radius: 0.5, kn: 2 GPa/m, ks: 1e9, tension: 3 MPa, gap: 0.2 mm}"), ".",
      "");
  ASSERT_TRUE(read.contacts[0].bond);
  const model::BondRule& bond = *read.contacts[0].bond;
  EXPECT_EQ(bond.kind, "parallel");
  EXPECT_THAT(bond.parameters, ElementsAre(0.5, 2e9, 1e9, 3e6, std::numeric_limits<double>::infinity(), 0));
  EXPECT_DOUBLE_EQ(bond.gap, 2e-4);
  EXPECT_FALSE(read.contacts[1].bond);
  const assembly::Model model = assembly::build_model(read);
  EXPECT_EQ(assembly::count_bonds(model), 2);  // none with the wall
  EXPECT_TRUE(assembly::needs_rotation(read));
  EXPECT_TRUE(assembly::needs_orientation(read));
}

TEST(BondScene, HasDefaults) {
  const model::Scene read = read_scene_text(scene(springs, "{kind: contact}"), ".", "");
  EXPECT_THAT(read.contacts[0].bond->parameters,
              ElementsAre(std::numeric_limits<double>::infinity(), std::numeric_limits<double>::infinity()));
  EXPECT_EQ(read.contacts[0].bond->gap, 0);
  EXPECT_FALSE(assembly::needs_orientation(read));
}

TEST(BondScene, ParallelBondsNeedNoLawBesideThem) {
  const model::Scene read =
      read_scene_text(scene("law: none", "{kind: parallel, kn: 1e9, gap: 1 um}"), ".", "");
  EXPECT_EQ(assembly::count_bonds(assembly::build_model(read)), 1);
}

TEST(BondScene, SaysWhatIsWrongAndWhatToWrite) {
  EXPECT_THAT(
      mistakes(springs, "{kind: paralel, kn: 1e9}"),
      ElementsAre(HasSubstr("scene.yaml:2: contacts[0].bond.kind: \"paralel\" is none of parallel, contact; "
                            "did you mean \"parallel\"?")));
  EXPECT_THAT(mistakes(springs, "{kn: 1e9}"), ElementsAre(HasSubstr("contacts[0].bond: kind is missing")));
  EXPECT_THAT(mistakes(springs, "{kind: parallel}"),
              ElementsAre(HasSubstr("contacts[0].bond: kn is missing")));
  EXPECT_THAT(mistakes(springs, "{kind: parallel, kn: 1e9 N/m}"),
              ElementsAre(HasSubstr("contacts[0].bond.kn: \"1e9 N/m\"")));
  EXPECT_THAT(mistakes(springs, "{kind: parallel, kn: -1}"),
              ElementsAre(HasSubstr("contacts[0].bond.kn: \"-1\" is out of range; a value > 0 is wanted")));
  EXPECT_THAT(mistakes(springs, "{kind: parallel, kn: 1, radius: 0}"),
              ElementsAre(HasSubstr("contacts[0].bond.radius: \"0\" is out of range")));
  EXPECT_THAT(
      mistakes(springs, "{kind: parallel, kn: 1, gap: -1 mm}"),
      ElementsAre(HasSubstr("contacts[0].bond.gap: \"-1 mm\" is out of range; a value >= 0 is wanted")));
  EXPECT_THAT(mistakes(springs, "{kind: parallel, kn: 1, tension: 0}"),
              ElementsAre(HasSubstr("contacts[0].bond.tension: \"0\" is out of range")));
  EXPECT_THAT(
      mistakes(springs, "{kind: contact, tensoin: 1}"),
      ElementsAre(HasSubstr("contacts[0].bond.tensoin: unknown key; did you mean \"tension\"? (a contact "
                            "bond takes tension, shear)")));
  EXPECT_THAT(mistakes(springs, "{kind: contact, radius: 1}"),
              ElementsAre(HasSubstr("contacts[0].bond.radius: unknown key")));
  EXPECT_THAT(mistakes(springs, "parallel"), ElementsAre(HasSubstr("contacts[0].bond")));
}

TEST(BondScene, AContactBondWantsTheLinearLawThatOpens) {
  EXPECT_THAT(
      mistakes("law: none", "{kind: contact}"),
      ElementsAre(HasSubstr("contacts[0].bond: a contact bond is one of the law linear, not of none; write "
                            "\"law: linear\", or \"kind: parallel\"")));
  EXPECT_THAT(
      mistakes("law: linear, kn: 1e5, tension: true", "{kind: contact}"),
      ElementsAre(HasSubstr("contacts[0].tension: springs with tension never open, so a contact bond means "
                            "nothing there; leave out one of the two")));
  EXPECT_THAT(mistakes("law: linear, kn: 1e5, kr: 1, rolling_friction: 0.1", "{kind: contact}"),
              ElementsAre(HasSubstr(
                  "contacts[0].bond: a contact bond carries no moment, so it knows no rolling "
                  "resistance; leave out `kr` and `rolling_friction`, or write \"kind: parallel\"")));
  EXPECT_THAT(mistakes("law: linear, kn: 1e5, restitution: 0.5", "{kind: contact}"), ElementsAre());
}

}  // namespace
}  // namespace eigengrain::io
