#include "eigengrain/contact/law_table.hpp"
#include "eigengrain/io/schema.hpp"

#include "io/units.hpp"
#include "unit/io_support.hpp"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <sstream>

namespace eigengrain::io {
namespace {

TEST(Schema, DocumentationIsWhatTheTableSays) {
  std::ifstream file(EIGENGRAIN_EXAMPLES "/../docs/scene-schema.md");
  std::ostringstream text;
  text << file.rdbuf();
  EXPECT_EQ(text.str(), schema_markdown()) << "to write it anew: eigengrain schema > docs/scene-schema.md";
}

TEST(Schema, UnitsCanBeRead) {
  for (const KeyDescription& key : scene_schema())
    EXPECT_EQ(parse_unit(key.unit).problem, "") << key.path << ": " << key.unit;
}

TEST(Schema, EveryKeyStandsOnceAndInASectionOfItsOwn) {
  for (const KeyDescription& key : scene_schema()) {
    int same = 0;
    bool parent = key.section().empty();
    for (const KeyDescription& other : scene_schema()) {
      same += other.path == key.path && other.law == key.law;
      parent = parent || other.path == key.section() || other.path + "[]" == key.section();
    }
    EXPECT_EQ(same, 1) << key.path;
    EXPECT_TRUE(parent) << key.path;
    EXPECT_FALSE(key.example.empty()) << key.path;
    EXPECT_FALSE(key.description.empty()) << key.path;
  }
}

constexpr std::string_view one_tetrahedron =
    "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$Nodes\n4\n1 0 0 0\n2 1 0 0\n3 0 1 0\n4 0 0 1\n$EndNodes\n"
    "$Elements\n1\n1 4 2 0 1 1 2 3 4\n$EndElements\n";

/// Scenes that between them have a place for every key.
std::vector<std::string> scenes_with_room() {
  const std::string materials = "materials: [{name: grain, density: 2500}]\n";
  const std::string ball = "balls: [{position: [0.1, 0.1, 0.1], radius: 5 mm, material: grain}]\n";
  const std::string growing =
      "balls: [{position: [0.1, 0.1, 0.1], radius: 5 mm, material: grain, growth: {factor: 2, over: 1}}]\n";
  const std::string scaled = "mass_scaling: {dt: 1}\n";
  const std::string file = "balls: [{file: packing.txt, material: grain}]\n";
  const std::string lattice =
      "balls: [{lattice: fcc, radius: 5 mm, box: {min: [0, 0, 0], max: [0.1, 0.1, 0.1]}, material: grain}]\n";
  const auto fill = [](const std::string& how) {
    return "balls: [{fill: " + how + ", box: {min: [0, 0, 0], max: [0.1, 0.1, 0.1]}, material: grain}]\n";
  };
  const std::string loose = fill("random, fraction: 0.1, radius: 5 mm");
  const std::string dense = fill("dense, mean_overlap: 1e-3, radius: 15 mm");
  const auto sizes = [&](const std::string& how) {
    return fill("random, fraction: 0.1, sizes: {distribution: " + how + "}");
  };
  const std::string uniform = sizes("uniform, min: 4 mm, max: 6 mm");
  const std::string normal = sizes("normal, mean: 5 mm, deviation: 0.5 mm");
  const std::string power = sizes("power, exponent: 2, min: 4 mm, max: 6 mm");
  const std::string shares = sizes("table, radii: [4 mm, 6 mm], shares: [1, 1]");
  const std::string passing = sizes("table, radii: [4 mm, 6 mm], passing: [0, 1]");
  const std::string plane = "walls: [{plane: {point: [0, 0, 0], normal: [0, 0, 1]}, material: grain}]\n";
  const std::string box = "walls: [{box: {min: [0, 0, 0], max: [1, 1, 1]}, material: grain}]\n";
  const std::string carried =
      "walls: [{plane: {point: [0, 0, 0], normal: [0, 0, 1]}, material: grain, motion: [{time: 0}], "
      "servo: {stress: 1 kPa, area: 1 m2, max_speed: 1}}]\n";
  const std::string driven =
      "walls: [{plane: {point: [0, 0, 0], normal: [0, 0, 1]}, material: grain, servo: {force: 1 N, "
      "max_speed: 1}}]\n";
  const std::string polygon =
      "walls: [{polygon: {corners: [[0, 0, 0], [1, 0, 0], [0, 1, 0]]}, material: grain}]\n";
  const std::string mesh = "walls: [{mesh: {file: drum.stl, unit: mm}, material: grain}]\n";
  const std::string clump =
      "clumps: [{balls: [{at: [0, 0, 0], radius: 5 mm}], material: grain, instances: [{position: [0.2, 0.2, "
      "0.2]}]}]\n";
  const std::string clump_as_given =
      "clumps: [{balls: [{at: [0, 0, 0], radius: 5 mm}], material: grain, mass: 1 g, centre: [0, 0, 0], "
      "inertia: [1e-8, 1e-8, 1e-8], instances: [{position: [0.2, 0.2, 0.2]}]}]\n";
  const std::string periodic = "periodic: {box: [1, 1, 1]}\n";
  const std::string fixed = "timestep: {policy: fixed, dt: 1e-5}\n";
  const std::string table = "histories: [{file: table.csv, of: unbalanced, balls: 0}]\n";
  const std::string region = "measures: [{name: middle}]\noutputs: {series: 1000}\n";
  const std::string sphere = "measures: [{sphere: {centre: [0, 0, 0], radius: 1}}]\n";
  const std::string region_box = "measures: [{box: {min: [-1, -1, -1], max: [0.5, 0.5, 0.5]}}]\n";
  const std::string no_law = "contacts: [{between: [grain, grain], law: none}]\n";
  std::vector<std::string> scenes{materials + no_law + ball,
                                  materials + no_law + file + fixed,
                                  materials + no_law + lattice,
                                  materials + no_law + loose,
                                  materials + no_law + dense,
                                  materials + no_law + uniform,
                                  materials + no_law + normal,
                                  materials + no_law + power,
                                  materials + no_law + shares,
                                  materials + no_law + passing,
                                  materials + no_law + ball + plane,
                                  materials + no_law + ball + box,
                                  materials + no_law + growing,
                                  materials + no_law + ball + scaled,
                                  materials + no_law + ball + clump,
                                  materials + no_law + ball + clump_as_given,
                                  materials + no_law + ball + carried,
                                  materials + no_law + ball + polygon,
                                  materials + no_law + ball + driven,
                                  materials + no_law + ball + mesh,
                                  materials + no_law + ball + periodic,
                                  materials + no_law + ball + table + region,
                                  materials + no_law + ball + sphere,
                                  materials + no_law + ball + region_box};
  const auto block = [](const std::string& edge, const std::string& more) {
    return "deformables: [{block: {min: [0, 0, 0], max: [" + edge + ", " + edge + ", " + edge +
           "], cells: [4, 4, 4]}, material: grain, young: 1 MPa, poisson: 0.4" + more + "}]\n";
  };
  const auto parts = [](const std::string& shape) {
    return ", fix: [{" + shape + "axes: [x]}], loads: [{" + shape + "force: [0, 0, 1]}]";
  };
  for (const std::string& deformable : {std::string("deformables: [{mesh: {file: block.msh, unit: mm}, "
                                                    "material: grain, young: 1 MPa, poisson: 0.4}]\n"),
                                        block("0.1", ""), block("1", ""), block("0.1", parts("")),
                                        block("0.1", parts("box: {min: [-1, -1, -1], max: [2, 2, 2]}, ")),
                                        block("0.1", parts("sphere: {centre: [0, 0, 0], radius: 1}, "))})
    scenes.push_back(materials + no_law + ball + deformable);
  const std::string rest = materials + no_law + ball;
  const auto in_stage = [](std::string keys) {
    return "stages: [{" + keys.substr(0, keys.size() - 1) + "}]\n";
  };
  for (const std::string& balls :
       {ball, file, lattice, loose, uniform, normal, power, shares, passing, growing})
    scenes.push_back(rest + in_stage(balls));
  for (const std::string shape :
       {"", ", sphere: {centre: [0, 0, 0], radius: 1}", ", box: {min: [-1, -1, -1], max: [0.5, 0.5, 0.5]}"}) {
    const std::string lid = "[{name: lid" + shape + "}]";
    scenes.push_back(rest + "groups: " + lid + "\n");
    scenes.push_back(rest + "stages: [{groups: " + lid + "}]\n");
    scenes.push_back(rest + "groups: [{name: lid}]\nstages: [{bodies: [{growth: {factor: 1}" + shape +
                     "}]}]\n");
    scenes.push_back(
        materials + ball + plane +
        "contacts: [{name: soft, between: [any, any], law: linear, kn: 1}, {between: [any, any], law: "
        "none}]\ngroups: [{name: lid}]\nstages: [{contacts: [{take: soft" +
        shape + "}]}]\n");
  }
  scenes.push_back(materials + ball +
                   "contacts: [{between: [any, any], law: linear, kn: 1}]\nstages: [{run: {steps: 1}}]\n");
  scenes.push_back(rest + "stages: [{relax: {tolerance: 1e-9}}]\n");
  for (const std::string until : {"run: {until: {wall_force: {wall: wall 1 (plane), at_least: 1 N}}}"})
    for (const std::string& text : {until + "\n", "stages: [{" + until + "}]\n"})
      scenes.push_back(rest + plane + text);
  scenes.push_back(
      materials + ball +
      "contacts: [{between: [any, any], law: linear, kn: 1}, {between: [any, any], law: none}]\n");
  for (const contact::LawDescription& law : contact::law_descriptions()) {
    std::string needed;
    for (const KeyDescription* key : section_keys("contacts[]", law.name))
      if (key->required && !key->law.empty()) needed += fmt::format(", {}: {}", key->name(), key->example);
    scenes.push_back(materials + ball +
                     fmt::format("contacts: [{{between: [any, any], law: {}{}}}]\n", law.name, needed));
  }
  for (const contact::LawDescription& bond : contact::bond_descriptions()) {
    std::string needed;
    for (const KeyDescription* key : section_keys("contacts[].bond", bond.name))
      if (key->required && !key->law.empty()) needed += fmt::format(", {}: {}", key->name(), key->example);
    scenes.push_back(
        materials + ball +
        fmt::format("contacts: [{{between: [any, any], law: linear, kn: 1, bond: {{kind: {}{}}}}}]\n",
                    bond.name, needed));
  }
  return scenes;
}

/// "balls[].radius" -> "balls.0.radius"
std::string first_entry(std::string path) {
  for (std::size_t at = path.find("[]"); at != std::string::npos; at = path.find("[]"))
    path.replace(at, 2, ".0");
  return path;
}

TEST(Schema, EveryKeyIsAcceptedWithItsExampleAndItsDefault) {
  const TemporaryFolder folder;
  folder.write("packing.txt", "0.1 0.1 0.1 0.005\n");
  folder.write("motion.csv", "0 0 0 0\n");
  folder.write("block.msh", one_tetrahedron);
  folder.write("drum.stl", "solid a\nfacet\nvertex 0 0 0\nvertex 1 0 0\nvertex 0 1 0\nendfacet\nendsolid\n");
  const auto accepted = [&](const std::string& assignment, std::string& reasons) {
    for (const std::string& scene : scenes_with_room()) {
      const std::vector<Mistake> mistakes = mistakes_in(scene, {assignment}, folder.path());
      if (mistakes.empty()) return true;
      reasons += mistakes.front().text() + "\n";
    }
    return false;
  };
  for (const KeyDescription& key : scene_schema()) {
    std::string reasons;
    EXPECT_TRUE(accepted(first_entry(key.path) + "=" + key.example, reasons)) << reasons;
    if (!key.fallback.empty()) {
      EXPECT_TRUE(accepted(first_entry(key.path) + "=" + key.fallback, reasons)) << reasons;
    }
  }
}

TEST(Schema, EverySectionRejectsUnknownKeys) {
  const TemporaryFolder folder;
  folder.write("packing.txt", "0.1 0.1 0.1 0.005\n");
  folder.write("motion.csv", "0 0 0 0\n");
  folder.write("block.msh", one_tetrahedron);
  folder.write("drum.stl", "solid a\nfacet\nvertex 0 0 0\nvertex 1 0 0\nvertex 0 1 0\nendfacet\nendsolid\n");
  for (const KeyDescription& key : scene_schema()) {
    std::string path = first_entry(key.path);
    if (key.kind == KeyKind::section_list)
      path += ".0";
    else if (key.kind != KeyKind::section)
      continue;
    std::string all;
    for (const std::string& scene : scenes_with_room())
      for (const std::string& text : texts_of(mistakes_in(scene, {path + ".zzz=1"}, folder.path())))
        all += text + "\n";
    EXPECT_THAT(all, testing::HasSubstr("zzz: unknown key")) << path;
  }
}

}  // namespace
}  // namespace eigengrain::io
