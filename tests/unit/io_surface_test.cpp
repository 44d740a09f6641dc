// Polygons and meshes in scenes, and what is wrong with them.
#include "support/surfaces.hpp"
#include "unit/io_support.hpp"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstring>
#include <string>

namespace eigengrain::io {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

std::string scene_with(const std::string& wall) {
  return "materials: [{name: grain, density: 2500}]\n"
         "contacts: [{between: [any, any], law: linear, kn: 1e5}]\n"
         "balls: [{position: [0.1, 0.1, 0.1], radius: 5 mm, material: grain}]\n"
         "walls: [{material: grain, " +
         wall + "}]\n";
}

std::vector<std::string> reported(const std::string& wall, const std::filesystem::path& folder = ".") {
  return texts_of(mistakes_in(scene_with(wall), {}, folder));
}

std::string polygon(const std::string& corners) {
  return "polygon: {corners: " + corners + "}";
}

/// One triangle, in text.
std::string facet(const std::string& a, const std::string& b, const std::string& c) {
  return "facet normal 0 0 1\n outer loop\n  vertex " + a + "\n  vertex " + b + "\n  vertex " + c +
         "\n endloop\nendfacet\n";
}

std::string binary_stl(const model::Surface& surface) {
  std::string bytes = "solid, though it is binary";
  bytes.resize(80, ' ');
  const auto count = static_cast<std::uint32_t>(surface.triangles.size());
  bytes.append(reinterpret_cast<const char*>(&count), 4);
  for (const model::Triangle& t : surface.triangles) {
    std::array<float, 12> numbers{};
    for (std::size_t k = 0; k < 3; ++k)
      for (int axis = 0; axis < 3; ++axis)
        numbers.at(3 + 3 * k + static_cast<std::size_t>(axis)) =
            static_cast<float>(surface.vertices[static_cast<std::size_t>(t[k])][axis]);
    bytes.append(reinterpret_cast<const char*>(numbers.data()), sizeof(numbers));
    bytes.append(2, '\0');
  }
  return bytes;
}

TEST(ReadSurface, APolygonIsAFan) {
  const model::Scene scene = read_scene_text(
      scene_with("polygon: {corners: [[0, 0, 0], [100 mm, 0, 0], [0.1, 0.2, 0], [0, 0.2, 0]], two_sided: "
                 "true}, velocity: [0, 0, 1]"),
      ".");
  ASSERT_EQ(scene.surfaces.size(), 1U);
  const model::Surface& surface = scene.surfaces[0];
  EXPECT_THAT(surface.triangles, ElementsAre(model::Triangle{0, 1, 2}, model::Triangle{0, 2, 3}));
  EXPECT_EQ(surface.vertices[1], Vec3(0.1, 0, 0));
  EXPECT_TRUE(surface.two_sided);
  EXPECT_EQ(surface.name, "wall 1 (polygon)");
  EXPECT_LT((surface.centre - Vec3(0.05, 0.1, 0)).norm(), 1e-16);
  ASSERT_EQ(scene.wall_motions.size(), 1U);
  EXPECT_EQ(scene.wall_motions[0].wall, 0);
}

TEST(ReadSurface, SurfacesAreNumberedBehindPlanes) {
  const std::string corners = "[[0, 0, 0], [1, 0, 0], [0, 1, 0]]";
  const model::Scene scene = read_scene_text(
      scene_with(polygon(corners) + ", spin: [0, 0, 1]}, {material: grain, " + polygon(corners) +
                 "}, {material: grain, box: {min: [0, 0, 0], max: [1, 1, 1]}}, {material: grain, " +
                 polygon(corners) + ", velocity: [0, 0, 1]"),
      ".");
  ASSERT_EQ(scene.wall_motions.size(), 2U);
  EXPECT_EQ(scene.wall_motions[0].wall, 6);
  EXPECT_EQ(scene.wall_motions[1].wall, 8);
}

TEST(ReadSurface, MeshesOfAllFormatsAreTheSame) {
  const TemporaryFolder folder;
  const model::Surface box = test::cuboid({10, 20, 30});
  std::string obj = "# a box\no box\n";
  std::string stl = "solid box\n";
  const auto text = [](const Vec3& x) { return fmt::format("{} {} {}", x[0], x[1], x[2]); };
  for (const Vec3& x : box.vertices) obj += "v " + text(x) + "\n";
  for (std::size_t k = 0; k < box.triangles.size(); ++k) {
    const auto& [a, b, c] = box.triangles[k];
    // All three ways to name a vertex; the last counts from the end.
    obj += k % 2 == 0 ? fmt::format("f {}//1 {}/2/3 {}\n", a + 1, b + 1, c + 1)
                      : fmt::format("f {} {} {}\n", a - 8, b - 8, c - 8);
    const auto at = [&](int v) { return text(box.vertices[static_cast<std::size_t>(v)]); };
    stl += facet(at(a), at(b), at(c));
  }
  folder.write("box.obj", obj);
  folder.write("text.stl", stl + "endsolid box\n");
  folder.write("binary.STL", binary_stl(box));
  for (const std::string name : {"box.obj", "text.stl", "binary.STL"}) {
    const model::Scene scene =
        read_scene_text(scene_with("mesh: {file: " + name + ", unit: mm}"), folder.path());
    ASSERT_EQ(scene.surfaces.size(), 1U);
    const model::Surface& surface = scene.surfaces[0];
    EXPECT_EQ(surface.name, "wall 1 (mesh " + name + ")");
    EXPECT_EQ(surface.vertices.size(), 8U);
    ASSERT_EQ(surface.triangles.size(), 12U);
    for (std::size_t k = 0; k < 12; ++k)
      for (std::size_t c = 0; c < 3; ++c) {
        const Vec3& found = surface.vertices[static_cast<std::size_t>(surface.triangles[k][c])];
        EXPECT_EQ(found, 1e-3 * box.vertices[static_cast<std::size_t>(box.triangles[k][c])]);
      }
  }
}

TEST(SurfaceMistakes, Polygons) {
  EXPECT_THAT(
      reported(polygon("[[0, 0, 0], [1, 0, 0]]")),
      ElementsAre(HasSubstr("scene.yaml:4: walls[0].polygon.corners: 2 corners; a polygon has three")));
  EXPECT_THAT(reported(polygon("[[0, 0, 0], [1, 0, 0], [2, 0, 0]]")),
              ElementsAre(HasSubstr("lie on a line")));
  EXPECT_THAT(reported(polygon("[[0, 0, 0], [1, 0, 0], [1, 1, 0.1], [0, 1, 0]]")),
              ElementsAre(HasSubstr("out of the plane of the others")));
  EXPECT_THAT(reported(polygon("[[0, 0, 0], [1, 0, 0], [0.2, 0.2, 0], [0, 1, 0]]")),
              ElementsAre(HasSubstr("walls[0].polygon.corners: not convex at corner 2")));
  EXPECT_THAT(reported(polygon("[[0, 0, 0], [1, 0, 0], [2, 0, 0], [0, 1, 0]]")),
              ElementsAre(HasSubstr("not convex at corner 1")));
  // A star of five has convex corners.
  EXPECT_THAT(reported(polygon("[[0, 1, 0], [-0.588, -0.809, 0], [0.951, 0.309, 0], [-0.951, 0.309, 0], "
                               "[0.588, -0.809, 0]]")),
              ElementsAre(HasSubstr("its edges cross")));
  EXPECT_THAT(reported(polygon("[[0, 0, 0], [1, 0], [0, 1, 0]]")),
              ElementsAre(HasSubstr("walls[0].polygon.corners[1]: 2 values; three are wanted")));
  EXPECT_THAT(
      reported(polygon("[[0, 0, 0], 7, [0, 1, 0]]")),
      ElementsAre(HasSubstr("walls[0].polygon.corners[1]: a single value stands where a list of three")));
  EXPECT_THAT(
      reported(polygon("[[0, 0, 0], [1, 0, 0], [0, 1, 0]]") + ", box: {min: [0, 0, 0], max: [1, 1, 1]}"),
      ElementsAre(HasSubstr("walls[0]: either a plane or a box is wanted")));
}

/// What a scene with this mesh says.
std::vector<std::string> mesh_says(const std::string& contents, const std::string& name = "mesh.stl",
                                   const std::string& more = "") {
  const TemporaryFolder folder;
  folder.write(name, contents);
  std::vector<std::string> all = reported("mesh: {file: " + name + ", unit: m" + more + "}", folder.path());
  for (std::string& text : all)
    if (const auto at = text.find(folder.path().string()); at != std::string::npos)
      text.erase(at, folder.path().string().size() + 1);
  return all;
}

TEST(SurfaceMistakes, FilesThatAreNoMeshes) {
  EXPECT_THAT(reported("mesh: {file: nowhere.stl, unit: mm}"),
              ElementsAre(HasSubstr("scene.yaml:4: there is no file \"nowhere.stl\"")));
  EXPECT_THAT(reported("mesh: {file: nowhere.stl}"),
              testing::Contains(HasSubstr("walls[0].mesh: unit is missing; add e.g. \"unit: mm\"")));
  EXPECT_THAT(mesh_says("solid nothing\nendsolid\n"), ElementsAre(HasSubstr("holds no triangles")));
  EXPECT_THAT(mesh_says("", "mesh.obj"), ElementsAre(HasSubstr("holds no triangles")));
  EXPECT_THAT(mesh_says("ply\n", "mesh.ply"), ElementsAre(HasSubstr("ends in neither .stl nor .obj")));
  EXPECT_THAT(mesh_says("hello"), ElementsAre(HasSubstr("mesh.stl: no STL file: neither text")));
  std::string cut = binary_stl(test::cuboid({1, 1, 1}));
  cut[0] = 'x';
  cut.resize(cut.size() - 7);
  EXPECT_THAT(mesh_says(cut),
              ElementsAre("mesh.stl: cut short or no STL file: 677 bytes, and a binary one of "
                          "12 triangles has 684"));
}

TEST(SurfaceMistakes, LinesOfMeshes) {
  EXPECT_THAT(mesh_says("solid a\n" + facet("0 0 0", "1 0", "0 1 0")),
              ElementsAre("mesh.stl:5: 2 coordinates; three are wanted"));
  EXPECT_THAT(mesh_says("solid a\n" + facet("0 0 0", "1 0 x", "0 1 0")),
              ElementsAre("mesh.stl:5: \"x\" is not a number; a coordinate is a plain number"));
  EXPECT_THAT(mesh_says("solid a\n" + facet("0 0 0", "1 0 nan", "0 1 0")),
              ElementsAre("mesh.stl:5: \"nan\" is not a finite number"));
  EXPECT_THAT(mesh_says("solid a\nvertex 0 0 0\nvertex 1 0 0\nendfacet\n"),
              ElementsAre("mesh.stl:4: a facet with 2 corners; three are wanted"));
  EXPECT_THAT(mesh_says("v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 4\n", "mesh.obj"),
              ElementsAre("mesh.obj:4: \"4\" names none of the 3 vertices so far"));
  EXPECT_THAT(mesh_says("v 0 0 0\nv 1 0 0\nf 1 2\n", "mesh.obj"),
              ElementsAre("mesh.obj:3: a face with 2 corners; three are wanted"));
  EXPECT_THAT(mesh_says("v 0 0 0\nv 1 0 0\nf 1 2 zero\n", "mesh.obj"),
              ElementsAre("mesh.obj:3: \"zero\" names none of the 2 vertices so far"));
}

TEST(SurfaceMistakes, Triangulations) {
  const std::string points = "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 -1 0\nv 0 0 1\nv 2 0 0\n";
  EXPECT_THAT(mesh_says(points + "f 1 2 6\n", "mesh.obj"),
              ElementsAre(HasSubstr("mesh.obj: triangle 1 at (1, 0, 0) m has no area; remove it")));
  EXPECT_THAT(
      mesh_says(points + "f 1 2 3\nf 2 1 4\nf 1 2 5\n", "mesh.obj"),
      ElementsAre("mesh.obj: more than two triangles (the first are 1 and 2) share the edge at (0.5, 0, "
                  "0) m; give every edge one or two"));
  EXPECT_THAT(
      mesh_says(points + "f 1 2 3\nf 1 2 4\n", "mesh.obj"),
      ElementsAre("mesh.obj: triangles 1 and 2 share the edge at (0.5, 0, 0) m and face opposite ways, "
                  "so the active side is not clear; turn one around, or write \"two_sided: true\""));
  EXPECT_THAT(mesh_says(points + "f 1 2 3\nf 1 2 4\n", "mesh.obj", ", two_sided: true"), IsEmpty());
}

TEST(SurfaceNotes, AUnitThatIsOffByAThousand) {
  const TemporaryFolder folder;
  folder.write("box.stl", binary_stl(test::cuboid({50, 50, 50})));  // mm, about balls of 5 mm
  const auto notes = [&](const std::string& unit) {
    return read_scene_text(scene_with("mesh: {file: box.stl, unit: " + unit + "}"), folder.path()).notes;
  };
  EXPECT_THAT(notes("mm"), IsEmpty());
  EXPECT_THAT(notes("m"),
              ElementsAre("wall 1 (mesh box.stl) is 100 m in size, and the balls, of radius 0.005 "
                          "to 0.005 m, take 0.01 m; is its unit right?"));
  EXPECT_THAT(notes("um"), ElementsAre(HasSubstr("is 0.0001 m in size")));
}

}  // namespace
}  // namespace eigengrain::io
