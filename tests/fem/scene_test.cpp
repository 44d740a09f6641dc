// Deformable bodies in scene files: what is read, what is wrong, and states that continue.
#include "eigengrain/io/scene_reader.hpp"

#include "support/restart.hpp"
#include "unit/io_support.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <numeric>
#include <string>

namespace eigengrain::io {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

std::string scene_with(const std::string& body) {
  return "materials: [{name: grain, density: 2500}, {name: rubber, density: 1000, young: 1 MPa, poisson: "
         "0.4}]\n"
         "contacts: [{between: [any, any], law: linear, kn: 1e4, ks: 8e3, friction: 0.3}]\n"
         "gravity: [0, 0, -9.81]\n"
         "balls: [{position: [0.05, 0.04, 14.9 mm], radius: 5 mm, material: grain}]\n"
         "walls: [{plane: {point: [0, 0, 0], normal: [0, 0, 1]}, material: grain}]\n"
         "deformables: [{material: rubber, " +
         body + "}]\n";
}
std::string block(const std::string& more = "") {
  return "block: {min: [0, 0, 0], max: [0.1, 0.1, 0.01], cells: [4, 4, 1]}" + more;
}
std::vector<std::string> reported(const std::string& body) {
  return texts_of(mistakes_in(scene_with(body)));
}

TEST(ReadDeformables, ABlockIsNodesBehindTheBallsAndAMesh) {
  const model::Scene scene = read_scene_text(
      scene_with(block(
          ", fix: [{box: {min: [-1, -1, -1], max: [1 mm, 1, 1]}, axes: [x, z]}], "
          "loads: [{box: {min: [-1, -1, 9 mm], max: [1, 1, 1]}, force: [0, 0, -3]}], velocity: [1, 0, 0]")),
      ".", "scene.yaml");
  ASSERT_EQ(scene.deformables.size(), 1U);
  const model::Deformable& body = scene.deformables[0];
  EXPECT_EQ(body.first_node, 1);
  EXPECT_EQ(body.mesh.kind, model::ElementKind::hex8);
  EXPECT_EQ(body.mesh.element_count(), 16);
  ASSERT_EQ(scene.bodies.size(), 1 + 50);
  EXPECT_NEAR(std::accumulate(scene.bodies.mass.begin() + 1, scene.bodies.mass.end(), 0.0), 1000 * 1e-4,
              1e-15);
  Vec3 load = Vec3::Zero();
  int held = 0;
  for (std::size_t i = 1; i < 51; ++i) {
    EXPECT_EQ(scene.bodies.radius[i], 0);
    EXPECT_EQ(scene.bodies.fixed[i].rotation(), 7);
    EXPECT_EQ(scene.bodies.velocity[i], Vec3(1, 0, 0));
    load += scene.bodies.applied_force[i];
    held += scene.bodies.fixed[i].translation() == 5 ? 1 : 0;
  }
  EXPECT_EQ(held, 10);
  EXPECT_NEAR(load.z(), -3, 1e-14);
  EXPECT_EQ(scene.bodies.applied_force[0], Vec3(0, 0, 0));
}

TEST(ReadDeformables, SayWhatIsWrong) {
  EXPECT_THAT(reported("young: 1 MPa"), testing::Contains(HasSubstr("either a mesh or a block is wanted")));
  EXPECT_THAT(reported("block: {min: [0, 0, 0], max: [0.1, 0, 0.01], cells: [4, 4, 1]}"),
              ElementsAre(HasSubstr("y = 0 m is not above the y = 0 m of min")));
  EXPECT_THAT(reported("block: {min: [0, 0, 0], max: [0.1, 0.1, 0.01], cells: [4, 4]}"),
              ElementsAre(HasSubstr("2 numbers; one for each of x, y and z is wanted")));
  EXPECT_THAT(reported(block(", poisson: 0.5")), ElementsAre(HasSubstr("poisson")));
  EXPECT_THAT(reported(block(", fix: [{box: {min: [1, 1, 1], max: [2, 2, 2]}}]")),
              ElementsAre(HasSubstr(
                  "no node lies in this region; the body reaches from (0, 0, 0) to (0.1, 0.1, 0.01) m")));
  EXPECT_THAT(reported("mesh: {file: missing.msh, unit: mm}"), ElementsAre(HasSubstr("missing.msh")));
  const std::string periodic = scene_with(block()) + "periodic: {box: [1, 1, 1], axes: [x, y]}\n";
  EXPECT_THAT(texts_of(mistakes_in(periodic)),
              testing::Contains(HasSubstr("in a cell that repeats, deformable bodies")));
}

TEST(ReadDeformables, MaterialsOrEntriesHaveModuli) {
  std::string scene = scene_with(block());
  scene.replace(scene.find(", young: 1 MPa"), 14, "");
  EXPECT_THAT(texts_of(mistakes_in(scene)),
              ElementsAre(HasSubstr("young is missing, and the material \"rubber\" has none")));
}

TEST(ReadDeformables, StatesContinueToTheBit) {
  for (const char* element : {"tet4", "hex8"}) {
    std::string body = block(", fix: [{box: {min: [-1, -1, -1], max: [1 mm, 1, 1]}}]");
    body.insert(body.find('}'), std::string(", element: ") + element);
    const model::Scene scene = read_scene_text(scene_with(body), ".", "scene.yaml");
    test::expect_to_continue(scene, 600, {1, 150, 599});
  }
}

}  // namespace
}  // namespace eigengrain::io
