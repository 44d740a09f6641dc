// Volume meshes in the formats of Gmsh, Abaqus and VTK, and what is wrong with them.
#include "io/volume_mesh_reader.hpp"
#include "unit/io_support.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <numeric>
#include <random>
#include <string>
#include <utility>

namespace eigengrain::io {
namespace {

using model::ElementKind;
using model::Mesh;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

constexpr std::array<ElementKind, 3> kinds{ElementKind::tet4, ElementKind::hex8, ElementKind::tet10};

Mesh parsed(const std::string& text, const std::string& name, Diagnostics& diagnostics, double unit = 1) {
  return parse_volume_mesh(text, name, unit, {"scene.yaml", 7}, diagnostics);
}

/// What is said of a text.
std::vector<std::string> said(const std::string& text, const std::string& name) {
  Diagnostics diagnostics;
  const Mesh mesh = parsed(text, name, diagnostics);
  EXPECT_EQ(mesh.nodes.empty(), diagnostics.any());
  return texts_of(diagnostics.mistakes());
}

double volume_of(const Mesh& mesh) {
  std::vector<std::int32_t> nodes;
  const model::Surface skin = model::skin_of(mesh, nodes);
  double sum = 0;
  for (const auto& [a, b, c] : skin.triangles) {
    const auto x = [&](std::int32_t vertex) { return skin.vertices[static_cast<std::size_t>(vertex)]; };
    sum += x(a).dot(x(b).cross(x(c))) / 6;
  }
  return sum;
}

// Files as they came from the programs themselves (tests/data/meshes/README.md).
TEST(VolumeMesh, SamplesAreTheSameBlock) {
  struct Sample {
    const char* name;
    ElementKind kind;
    std::int32_t nodes;
    std::int32_t elements;
  };
  for (const Sample& sample :
       {Sample{"bricks_22.msh", ElementKind::hex8, 12, 2}, Sample{"bricks_41.msh", ElementKind::hex8, 12, 2},
        Sample{"bricks.inp", ElementKind::hex8, 12, 2}, Sample{"bricks.vtu", ElementKind::hex8, 12, 2},
        Sample{"tetrahedra_22.msh", ElementKind::tet10, 51, 18},
        Sample{"tetrahedra_41.msh", ElementKind::tet10, 51, 18},
        Sample{"tetrahedra.inp", ElementKind::tet10, 51, 18},
        Sample{"tetrahedra.vtu", ElementKind::tet10, 51, 18}}) {
    SCOPED_TRACE(sample.name);
    Diagnostics diagnostics;
    const Mesh mesh = read_volume_mesh(std::filesystem::path(EIGENGRAIN_TEST_DATA) / "meshes" / sample.name,
                                       1e-3, {"scene.yaml", 7}, diagnostics);
    EXPECT_THAT(texts_of(diagnostics.mistakes()), IsEmpty());
    EXPECT_EQ(mesh.kind, sample.kind);
    EXPECT_EQ(mesh.node_count(), sample.nodes);
    EXPECT_EQ(mesh.element_count(), sample.elements);
    EXPECT_NEAR(volume_of(mesh), 1e-6, 1e-18);  // all coordinates have few digits
    if (sample.kind != ElementKind::tet10) continue;
    constexpr std::array<std::array<std::size_t, 2>, 6> edges{
        {{0, 1}, {1, 2}, {2, 0}, {0, 3}, {1, 3}, {2, 3}}};
    for (std::int32_t e = 0; e < mesh.element_count(); ++e)
      for (std::size_t k = 0; k < edges.size(); ++k) {
        const auto x = [&](std::size_t local) {
          return mesh.nodes[static_cast<std::size_t>(mesh.element(e)[local])];
        };
        EXPECT_LT((x(4 + k) - (x(edges[k][0]) + x(edges[k][1])) / 2).norm(), 1e-17);
      }
  }
}

/// Writes a mesh as the format has it, with numbers that have gaps, nodes of no element and elements that are
/// no volumes.
class Writer {
 public:
  explicit Writer(const Mesh& mesh) : mesh_(mesh) {}

  std::string gmsh_22() const {
    std::string text = fmt::format(
        "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$PhysicalNames\n1\n3 1 \"body\"\n"
        "$EndPhysicalNames\n$Nodes\n{}\n7 9 9 9\n",
        mesh_.node_count() + 1);
    for (std::int32_t i = 0; i < mesh_.node_count(); ++i)
      text += fmt::format("{} {}\n", node(i), fmt::join(place(i), " "));
    text += fmt::format("$EndNodes\n$Elements\n{}\n1 15 2 0 1 7\n2 2 2 1 6 10 13 16\n",
                        mesh_.element_count() + 2);
    for (std::int32_t e = 0; e < mesh_.element_count(); ++e)
      text += fmt::format("{} {} 2 1 1 {}\n", element(e), gmsh_type(), fmt::join(nodes_of_gmsh(e), " "));
    return text + "$EndElements\n";
  }
  std::string gmsh_41() const {
    std::string text = fmt::format(
        "$MeshFormat\n4.1 0 8\n$EndMeshFormat\n$Entities\n0 0 0 1\n1 0 0 0 1 1 1 0 0\n"
        "$EndEntities\n$Nodes\n3 {} 7 1000000\n2 1 1 1\n7\n9 9 9 0.5 0.5\n1 5 0 0\n3 1 0 "
        "{}\n",
        mesh_.node_count() + 1, mesh_.node_count());
    for (std::int32_t i = 0; i < mesh_.node_count(); ++i) text += fmt::format("{}\n", node(i));
    for (std::int32_t i = 0; i < mesh_.node_count(); ++i)
      text += fmt::format("{}\n", fmt::join(place(i), " "));
    text +=
        fmt::format("$EndNodes\n$Elements\n2 {0} 1 1000000\n2 1 2 2\n1 7 10 13\n2 10 13 16\n3 1 {1} {2}\n",
                    mesh_.element_count() + 2, gmsh_type(), mesh_.element_count());
    for (std::int32_t e = 0; e < mesh_.element_count(); ++e)
      text += fmt::format("{} {} \n", element(e), fmt::join(nodes_of_gmsh(e), " "));
    return text + "$EndElements\n";
  }
  std::string abaqus() const {
    std::string text =
        "*Heading\n a mesh\n** a comment, 5, 6\n*Part, name=body\n*node, nset=all\r\n7, 9., 9., 9.\n";
    for (std::int32_t i = 0; i < mesh_.node_count(); ++i)
      text += fmt::format("  {} , {},\n", node(i), fmt::join(place(i), ", "));
    text +=
        "*Nset, nset=some\n7, 10\n*Element, type=CPS3, elset=faces\n1, 7, 10, 13\n*ELEMENT, ELSET=body,\n";
    text += mesh_.kind == ElementKind::hex8   ? " Type=c3d8\n"
            : mesh_.kind == ElementKind::tet4 ? " TYPE=C3D4\n"
                                              : " TYPE = C3D10\n";
    for (std::int32_t e = 0; e < mesh_.element_count(); ++e) {
      text += fmt::format("{}", element(e));
      const auto nodes = numbers(e);
      // Some elements in one line, some in three.
      for (std::size_t k = 0; k < nodes.size(); ++k)
        text += fmt::format("{}{}", e % 2 == 1 && k % 4 == 3 ? ",\n** in between\n  " : ", ", nodes[k]);
      text += "\n";
    }
    return text +
           "*End Part\n*Assembly, name=all\n*Node\n10, 1., 1., 1.\n*Instance, name=one, part=body\n0., 0., "
           "5.\n"
           "*End Instance\n*End Assembly\n*Step\n*Static\n1., 1.\n*End Step\n";
  }
  std::string vtu() const {
    std::string points = " 9 9 9\n";  // of no cell
    for (std::int32_t i = 0; i < mesh_.node_count(); ++i)
      points += fmt::format(" {}\n", fmt::join(place(i), "\n"));
    std::string connectivity = "1 2\n3 ";
    std::string offsets = "3";
    std::string types = "5";
    std::size_t end = 3;
    for (std::int32_t e = 0; e < mesh_.element_count(); ++e) {
      for (const std::int32_t i : mesh_.element(e)) connectivity += fmt::format("{} ", i + 1);
      end += mesh_.element(e).size();
      offsets += fmt::format(" {}", end);
      types += mesh_.kind == ElementKind::hex8 ? " 12" : mesh_.kind == ElementKind::tet4 ? " 10" : "\n24";
    }
    return fmt::format(R"(<?xml version="1.0"?>
<!-- <DataArray Name="types" format="binary"> -->
<VTKFile type="UnstructuredGrid" version="0.1"><UnstructuredGrid>
<Piece NumberOfPoints='{}' NumberOfCells = "{}">
<CellData><DataArray type="Float64" Name="types" format="appended" offset="0"/></CellData>
<Cells>
<DataArray type="Int64" Name="types" format="ascii">{}</DataArray>
<DataArray type="Int64" Name="connectivity" format="ascii">
{}</DataArray>
<DataArray type="Int64" Name="offsets" format="ascii" RangeMin=">">{}</DataArray>
</Cells>
<Points><DataArray type="Float64" NumberOfComponents="3" format="ascii">{}<InformationKey name="L2">
<Value index="0">5</Value></InformationKey></DataArray></Points>
</Piece></UnstructuredGrid><AppendedData encoding="raw">_<Piece></AppendedData></VTKFile>
)",
                       mesh_.node_count() + 1, mesh_.element_count() + 1, types, connectivity, offsets,
                       points);
  }

 private:
  static std::int32_t node(std::int32_t i) { return 10 + 3 * i + (i > 5 ? 1000 : 0); }
  static std::int32_t element(std::int32_t e) { return 100 + 2 * e; }
  std::array<double, 3> place(std::int32_t i) const {
    const Vec3& x = mesh_.nodes[static_cast<std::size_t>(i)];
    return {x[0], x[1], x[2]};
  }
  std::vector<std::int32_t> numbers(std::int32_t e) const {
    std::vector<std::int32_t> nodes;
    for (const std::int32_t i : mesh_.element(e)) nodes.push_back(node(i));
    return nodes;
  }
  std::vector<std::int32_t> nodes_of_gmsh(std::int32_t e) const {
    auto nodes = numbers(e);
    if (mesh_.kind == ElementKind::tet10) std::swap(nodes[8], nodes[9]);
    return nodes;
  }
  int gmsh_type() const {
    return mesh_.kind == ElementKind::hex8 ? 5 : mesh_.kind == ElementKind::tet4 ? 4 : 11;
  }

  const Mesh& mesh_;
};

std::vector<std::pair<std::string, std::string>> files_of(const Mesh& mesh) {
  const Writer writer(mesh);
  return {{"22.msh", writer.gmsh_22()},
          {"41.MSH", writer.gmsh_41()},
          {"mesh.inp", writer.abaqus()},
          {"mesh.vtu", writer.vtu()}};
}

TEST(VolumeMesh, EveryFormatGivesTheMeshBack) {
  for (const ElementKind kind : kinds) {
    const Mesh mesh = model::box_mesh({0.1, 0.2, 0.3}, {1, 2, 3}, {2, 2, 1}, kind);
    for (const auto& [name, text] : files_of(mesh)) {
      SCOPED_TRACE(fmt::format("{} {}", name_of(kind), name));
      Diagnostics diagnostics;
      const Mesh read = parsed(text, name, diagnostics, 0.5);
      EXPECT_THAT(texts_of(diagnostics.mistakes()), IsEmpty());
      EXPECT_EQ(read.kind, kind);
      EXPECT_EQ(read.elements, mesh.elements);
      EXPECT_EQ(read.name, name);
      ASSERT_EQ(read.nodes.size(), mesh.nodes.size());
      // Texts are the shortest that give the same number, and halves are exact.
      for (std::size_t i = 0; i < mesh.nodes.size(); ++i) EXPECT_EQ(read.nodes[i], 0.5 * mesh.nodes[i]);
    }
  }
}

TEST(VolumeMesh, NodesMayStandInAnyOrder) {
  Diagnostics diagnostics;
  const Mesh mesh = parsed(
      "*ELEMENT, TYPE=C3D4\n1, 40, 10, 30, 20\n*NODE\n20, 0, 0, 1\n40, 0, 0, 0\n10, 1, 0, 0\n"
      "30, 0, 1, 0\n",
      "mesh.inp", diagnostics);
  EXPECT_FALSE(diagnostics.any());
  EXPECT_THAT(mesh.elements, ElementsAre(1, 2, 3, 0));
  EXPECT_EQ(mesh.nodes.at(0), Vec3(0, 0, 1));
}

TEST(VolumeMeshMistakes, Files) {
  Diagnostics missing;
  read_volume_mesh("nowhere.msh", 1, {"scene.yaml", 7}, missing);
  EXPECT_THAT(texts_of(missing.mistakes()),
              ElementsAre(HasSubstr("scene.yaml:7: there is no file \"nowhere.msh\"")));
  EXPECT_THAT(said("", "mesh.stl"),
              ElementsAre("scene.yaml:7: \"mesh.stl\" ends in none of .msh (Gmsh), .inp (Abaqus, "
                          "CalculiX) and .vtu (VTK), the volume meshes that can be read"));
  EXPECT_THAT(said("", "mesh.msh"),
              ElementsAre("mesh.msh: no section $MeshFormat, with which a mesh of Gmsh begins"));
  EXPECT_THAT(said("", "mesh.vtu"), ElementsAre("mesh.vtu: no VTKFile in XML, of type UnstructuredGrid"));
  EXPECT_THAT(said("", "mesh.inp"), ElementsAre("scene.yaml:7: \"mesh.inp\" holds no elements"));
  EXPECT_THAT(
      said("*NODE\n1, 0, 0, 0\n2, 1, 0, 0\n*ELEMENT, TYPE=T3D2\n1, 1, 2\n", "mesh.inp"),
      ElementsAre(
          "scene.yaml:7: \"mesh.inp\" holds no volumes, only 1 points, lines or faces; mesh its volume "
          "(Gmsh: -3), and where there are physical groups, put the volume into one, as Gmsh writes "
          "nothing else"));
}

/// A file of one tetrahedron.
std::string gmsh_22(const std::string& nodes, const std::string& elements) {
  return "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$Nodes\n" + nodes + "$EndNodes\n$Elements\n" + elements +
         "$EndElements\n";
}
const std::string four_nodes =
    "4\n1 0 0 0\n2 1 0 0\n3 0 1 0\n4 0 0 1\n";  // lines 5 to 9, and elements begin on 12

std::vector<std::string> said_of_elements(const std::string& elements) {
  return said(gmsh_22(four_nodes, elements), "mesh.msh");
}
std::vector<std::string> said_of_nodes(const std::string& nodes) {
  return said(gmsh_22(nodes, "1\n1 4 0 1 2 3 4\n"), "mesh.msh");
}

TEST(VolumeMeshMistakes, FormatsOfGmsh) {
  EXPECT_THAT(
      said("$MeshFormat\n4.1 1 8\n\x01", "mesh.msh"),
      ElementsAre("mesh.msh:2: binary numbers, which are not read; save the mesh as text: \"gmsh FILE -save "
                  "-setnumber Mesh.Binary 0 -o TEXT.msh\", or \"Mesh.Binary = 0;\" in the .geo file"));
  EXPECT_THAT(
      said("$MeshFormat\n4 0 8\n", "mesh.msh"),
      ElementsAre("mesh.msh:2: version 4 of Gmsh's format; save it anew as 4.1 or 2.2 (Mesh.MshFileVersion = "
                  "4.1)"));
  EXPECT_THAT(said("$NOD\n4\n", "mesh.msh"),
              ElementsAre(HasSubstr("mesh.msh:1: version 1 of Gmsh's format")));
  EXPECT_THAT(
      said("$MeshFormat\n4.1\n", "mesh.msh"),
      ElementsAre("mesh.msh:2: $MeshFormat is followed by neither version nor type, such as \"4.1 0 8\""));
  EXPECT_THAT(said("$MeshFormat\n4.1 0 8\n$EndMeshFormat\n", "mesh.msh"),
              ElementsAre("mesh.msh:3: the file ends without a section $Nodes",
                          "mesh.msh:3: the file ends without a section $Elements"));
}

TEST(VolumeMeshMistakes, NodesOfGmsh22) {
  EXPECT_THAT(said_of_nodes(four_nodes), IsEmpty());
  EXPECT_THAT(said_of_nodes("4\n1 0 0 0\n2 1 0\n3 0 1 0\n4 0 0 1\n"),
              ElementsAre("mesh.msh:7: 3 columns; 4 or more are wanted"));
  EXPECT_THAT(said_of_nodes("4\n1 0 0 0\n2 1 0 x\n3 0 1 nan\n4 0 0 1e999\n"),
              ElementsAre("mesh.msh:7: \"x\" is not a number; a coordinate is a plain number",
                          "mesh.msh:8: \"nan\" is not a finite number",
                          "mesh.msh:9: \"1e999\" is too large or too small for a number"));
  EXPECT_THAT(said_of_nodes("4\n1 0 0 0\n2 1 0 0.5m\n3 0 1 0\n4 0 0 1\n"),
              ElementsAre("mesh.msh:7: \"0.5m\" is not a number; a coordinate is a plain number"));
  EXPECT_THAT(said_of_nodes("4\n1 0 0 0\n2.5 1 0 0\n3 0 1 0\n4 0 0 1\n"),
              ElementsAre("mesh.msh:7: number of a node: \"2.5\" is not a whole number"));
  EXPECT_THAT(said_of_nodes("4\n1 0 0 0\n2 1 0 0\n3 0 1 0\n"),
              ElementsAre("mesh.msh:9: the section $Nodes ends after 3 of the 4 nodes that it counts"));
  EXPECT_THAT(said_of_nodes("3\n1 0 0 0\n2 1 0 0\n3 0 1 0\n4 0 0 1\n"),
              ElementsAre("mesh.msh:9: $EndNodes is wanted behind the 3 nodes that the section counts"));
  EXPECT_THAT(said_of_nodes("five\n"), ElementsAre("mesh.msh:5: $Nodes: \"five\" is not a whole number"));
  EXPECT_THAT(said_of_nodes(""),
              ElementsAre("mesh.msh:5: the section $Nodes does not say how many nodes it has"));
  EXPECT_THAT(said_of_nodes("5\n1 0 0 0\n2 1 0 0\n3 0 1 0\n4 0 0 1\n2 5 5 5\n"),
              ElementsAre("mesh.msh:10: node 2 stands twice, first on line 7; write one mesh to a file"));
}

TEST(VolumeMeshMistakes, ElementsOfGmsh22) {
  EXPECT_THAT(said_of_elements("1\n1 4 0 1 2 3 5\n"),
              ElementsAre("mesh.msh:13: element 1 names node 5, which does not exist (they are 1 to 4)"));
  EXPECT_THAT(said_of_elements("1\n1 4 0 1 2 3 -9223372036854775808\n"),
              ElementsAre(HasSubstr("does not exist")));
  EXPECT_THAT(said_of_elements("1\n1 4 0 1 2 3\n"),
              ElementsAre("mesh.msh:13: element 1 has 3 nodes; a tet4 has 4"));
  EXPECT_THAT(said_of_elements("1\n1 4 9 1 2 3 4\n"),
              ElementsAre("mesh.msh:13: element 1 has 9 tags, but only 7 columns"));
  EXPECT_THAT(said_of_elements("1\n1 four 0 1 2 3 4\n"),
              ElementsAre("mesh.msh:13: type of an element: \"four\" is not a whole number"));
  EXPECT_THAT(said_of_elements("1\n1 4 0 1 2 3 4.0\n"),
              ElementsAre("mesh.msh:13: node of an element: \"4.0\" is not a whole number"));
  EXPECT_THAT(
      said_of_elements("3\n1 4 0 1 2 3 4\n2 6 0 1 2 3 1 2 3\n3 6 0 1 2 3 1 2 3\n"),
      ElementsAre("mesh.msh:14: element 2 is of type 6, a prism of 6 nodes; read are tetrahedra of 4 nodes "
                  "(type 4) or 10 (11) and bricks of 8 (5)"));
  EXPECT_THAT(said_of_elements("1\n2 99 0 1 2 3 1 2 3\n"),
              ElementsAre(HasSubstr("mesh.msh:13: element 2 is of type 99; read are")));
  EXPECT_THAT(
      said_of_elements("3\n1 4 0 1 2 3 4\n2 5 0 1 2 3 4 1 2 3 4\n3 5 0 1 2 3 4 1 2 3 4\n"),
      ElementsAre("mesh.msh:14: element 2 is a hex8, and element 1 on line 13 a tet4; write elements of one "
                  "kind, and of each kind a file of its own"));
}

TEST(VolumeMeshMistakes, BlocksOfGmsh41) {
  const auto says = [](const std::string& nodes, const std::string& elements) {
    return said("$MeshFormat\n4.1 0 8\n$EndMeshFormat\n$Nodes\n" + nodes + "$EndNodes\n$Elements\n" +
                    elements + "$EndElements\n",
                "mesh.msh");
  };
  const std::string nodes = "1 4 1 4\n3 1 0 4\n1\n2\n3\n4\n0 0 0\n1 0 0\n0 1 0\n0 0 1\n";  // lines 5 to 14
  EXPECT_THAT(says(nodes, "1 1 1 1\n3 1 4 1\n1 1 2 3 4\n"), IsEmpty());
  EXPECT_THAT(
      says("1 4 1 4\n3 1 0 4\n1\nb\n3\n4\n0 0 0\n1 0 0\n0 1\n0 0 1\n", "1 1 1 1\n3 1 4 1\n1 1 2 3 4\n"),
      ElementsAre("mesh.msh:8: number of a node: \"b\" is not a whole number",
                  "mesh.msh:13: 2 coordinates; three are wanted"));
  EXPECT_THAT(says("1 4 1 4\n3 1 0 4\n1\n2\n3\n4\n0 0 0\n1 0 0\n", "1 1 1 1\n3 1 4 1\n1 1 2 3 4\n"),
              ElementsAre("mesh.msh:13: the section $Nodes ends after 2 of the 4 nodes that it counts"));
  EXPECT_THAT(says("1 4\n3 1 0 4\n", "1 1 1 1\n3 1 4 1\n1 1 2 3 4\n"),
              ElementsAre("mesh.msh:5: 2 columns; 4 or more are wanted"));
  EXPECT_THAT(says(nodes, "1 1 1 1\n3 1 17 1\n1 1 2 3 4\n"),
              ElementsAre(HasSubstr("mesh.msh:18: elements of type 17, a brick of 20 nodes; read are")));
  EXPECT_THAT(
      says(nodes, "1 1 1 1\n3 1 4 2\n1 1 2 3 4\n"),
      ElementsAre(
          "mesh.msh:18: a block of 2 elements; the section $Elements counts 1 in all, and 0 stood before"));
  EXPECT_THAT(
      says(nodes, "1 2 1 2\n3 1 4 2\n1 1 2 3 4\n"),
      ElementsAre("mesh.msh:20: the section $Elements ends after 1 of the 2 elements that it counts"));
  EXPECT_THAT(
      says(nodes, "1 1 1 1\n3 1 4 1\n1 1 2 3 4\n2 1 2 3 4\n"),
      ElementsAre("mesh.msh:20: $EndElements is wanted behind the 1 elements that the section counts"));
}

TEST(VolumeMeshMistakes, Abaqus) {
  const std::string nodes = "*NODE\n1, 0, 0, 0\n2, 1, 0, 0\n3, 0, 1, 0\n4, 0, 0, 1\n";  // lines 1 to 5
  const auto says = [&](const std::string& rest) { return said(nodes + rest, "mesh.inp"); };
  EXPECT_THAT(says("*ELEMENT, TYPE=C3D4\n1, 1, 2, 3, 4\n"), IsEmpty());
  for (const std::string type : {"C3D8R", "C3D8I", "C3D10M", "C3D20", "C3D6", "SC8R", "C3D44"})
    EXPECT_THAT(
        says("*ELEMENT, TYPE=" + type + "\n1, 1, 2, 3, 4\n"),
        ElementsAre(
            "mesh.inp:6: elements of TYPE=" + type +
            "; read are C3D4 and C3D10 (tetrahedra) and C3D8 (bricks): write one of these, or leave out "
            "elements that are no volumes"));
  for (const std::string type : {"MASS", "T3D2", "B31", "S4R", "CPS6", "STRI65", "SFM3D4", "R3D4", "SPRINGA"})
    EXPECT_THAT(says("*ELEMENT, TYPE=C3D4\n1, 1, 2, 3, 4\n*ELEMENT, TYPE=" + type + "\n2, 1\n"), IsEmpty());
  EXPECT_THAT(says("*ELEMENT, ELSET=body\n1, 1, 2, 3, 4\n"),
              ElementsAre("mesh.inp:6: *ELEMENT without a TYPE; write e.g. \"*ELEMENT, TYPE=C3D4\""));
  EXPECT_THAT(says("*Include, input=more.inp\n"),
              ElementsAre("mesh.inp:6: *INCLUDE is not followed; put the text of that file into this one"));
  EXPECT_THAT(says("*NODE, INPUT=more.inp\n"),
              ElementsAre("mesh.inp:6: *NODE, INPUT is not followed; put the text of that file here"));
  EXPECT_THAT(says("*Ngen\n1, 4, 1\n"),
              ElementsAre("mesh.inp:6: *NGEN is not followed; write all nodes and elements "
                          "themselves, under *NODE and *ELEMENT"));
  EXPECT_THAT(says("*NODE, SYSTEM=C\n5, 0, 0, 0\n"),
              ElementsAre("mesh.inp:6: coordinates of SYSTEM=C; write rectangular ones"));
  EXPECT_THAT(says("5, 0, 0\n6, 0, , 0\n7\nx, 0, 0, 0\n"),
              ElementsAre("mesh.inp:6: 2 coordinates; three are wanted",
                          "mesh.inp:7: \"\" is not a number; a coordinate is a plain number",
                          "mesh.inp:8: 0 coordinates; three are wanted",
                          "mesh.inp:9: number of a node: \"x\" is not a whole number"));
  EXPECT_THAT(
      says(
          "*ELEMENT, TYPE=C3D4\n1, 1, 2, 3\n2, 1, 2,\n3, 4, 1\n3, 1,\n\n** not yet\n*ELSET\n4, 1, 2, 3, 4\n"),
      ElementsAre("mesh.inp:7: element 1 has 3 nodes; a C3D4 has 4 (a line that goes on in the next one ends "
                  "with a comma)",
                  HasSubstr("mesh.inp:8: element 2 has 5 nodes; a C3D4 has 4"),
                  HasSubstr("mesh.inp:10: element 3 has 1 nodes; a C3D4 has 4")));
  EXPECT_THAT(says("*ELEMENT, TYPE=C3D4\n1, 1, 2, 3, four\ntwo, 1, 2, 3, 4\n"),
              ElementsAre("mesh.inp:7: node of an element: \"four\" is not a whole number",
                          "mesh.inp:8: number of an element: \"two\" is not a whole number"));
  EXPECT_THAT(says("*ELEMENT, TYPE=C3D4\n1, 1, 2, 3, 9\n"),
              ElementsAre("mesh.inp:7: element 1 names node 9, which does not exist (they are 1 to 4)"));
  EXPECT_THAT(said("*ELEMENT, TYPE=C3D4\n1, 1, 2, 3, 9\n", "mesh.inp"),
              testing::Contains("mesh.inp:2: element 1 names node 9, which does not exist (there are none)"));
  EXPECT_THAT(says("*ELEMENT, TYPE=C3D4\n1, 1, 2, 3, 4\n*ELEMENT, TYPE=C3D8\n2, 1, 2, 3, 4, 1, 2, 3, 4\n"),
              ElementsAre(HasSubstr("mesh.inp:9: element 2 is a hex8, and element 1 on line 7 a tet4")));
  EXPECT_THAT(says("*NODE\n1, 0, 0, 5\n*ELEMENT, TYPE=C3D4\n1, 1, 2, 3, 4\n"),
              ElementsAre("mesh.inp:7: node 1 stands twice, first on line 2; write one mesh to a file"));
}

/// One tetrahedron as VTK has it, with other arrays in places of the right ones.
struct Vtu {
  std::string type = "UnstructuredGrid";
  std::string counts = "NumberOfPoints=\"4\" NumberOfCells=\"1\"";
  std::string points =
      "<DataArray NumberOfComponents=\"3\" format=\"ascii\">\n0 0 0 1 0 0\n0 1 0 0 0 1</DataArray>";
  std::string connectivity = "0 1 2 3";
  std::string offsets = "4";
  std::string types = "10";
  std::string format = "ascii";

  std::vector<std::string> said() const {
    return io::said("<VTKFile type=\"" + type + "\">\n<UnstructuredGrid>\n<Piece " + counts + ">\n<Points>" +
                        points + "</Points>\n<Cells>\n<DataArray Name=\"connectivity\" format=\"ascii\">" +
                        connectivity + "</DataArray>\n<DataArray Name=\"offsets\" format=\"ascii\">" +
                        offsets + "</DataArray>\n<DataArray Name=\"types\" format=\"" + format + "\">" +
                        types + "</DataArray>\n</Cells>\n</Piece>\n</UnstructuredGrid>\n</VTKFile>\n",
                    "mesh.vtu");
  }
};

TEST(VolumeMeshMistakes, Vtu) {
  EXPECT_THAT(Vtu{}.said(), IsEmpty());
  EXPECT_THAT(Vtu{.type = "PolyData"}.said(),
              ElementsAre("mesh.vtu:1: a VTKFile of type \"PolyData\"; save an UnstructuredGrid"));
  for (const std::string format : {"binary", "appended"})
    EXPECT_THAT(
        Vtu{.format = format}.said(),
        ElementsAre("mesh.vtu:10: a DataArray with format=\"" + format +
                    "\", which is not read; save the mesh as text (ParaView: Data Mode Ascii; vtkXMLWriter: "
                    "SetDataModeToAscii; meshio convert --ascii)"));
  EXPECT_THAT(Vtu{.points = ""}.said(), ElementsAre("mesh.vtu:3: there is no DataArray in Points"));
  EXPECT_THAT(Vtu{.counts = "NumberOfPoints=\"5\" NumberOfCells=\"2\""}.said(),
              ElementsAre("mesh.vtu:4: 4 here, and NumberOfPoints=\"5\"",
                          "mesh.vtu:10: 1 here, and NumberOfCells=\"2\""));
  EXPECT_THAT(Vtu{.points = "<DataArray NumberOfComponents='2'>\n0 0 0 1</DataArray>"}.said(),
              ElementsAre("mesh.vtu:4: points of 2 coordinates; three are wanted"));
  EXPECT_THAT(Vtu{.points = "<DataArray>\n0 0 0 1</DataArray>"}.said(),
              ElementsAre("mesh.vtu:4: 4 numbers, which are not three for each point"));
  EXPECT_THAT(Vtu{.points = "<DataArray>0 0 0\n1 0 0 0 1 0 0 y 1</DataArray>"}.said(),
              ElementsAre("mesh.vtu:5: \"y\" is not a number; a coordinate is a plain number"));
  EXPECT_THAT(Vtu{.connectivity = "0 1\n2 4"}.said(),
              ElementsAre("mesh.vtu:8: cell 0 names point 4, which does not exist (they are 0 to 3)"));
  EXPECT_THAT(Vtu{.connectivity = "0 1\n2 x"}.said(),
              ElementsAre("mesh.vtu:9: connectivity: \"x\" is not a whole number"));
  EXPECT_THAT(Vtu{.offsets = "3"}.said(), ElementsAre("mesh.vtu:8: cell 0 has 3 points; a tet4 has 4"));
  for (const std::string offset : {"5", "-1"})
    EXPECT_THAT(Vtu{.offsets = offset}.said(),
                ElementsAre("mesh.vtu:9: offset " + offset +
                            " of cell 0 is not between 0, where the cell before ends, "
                            "and 4, where the connectivity ends"));
  EXPECT_THAT(Vtu{.offsets = "4 4"}.said(),
              ElementsAre("mesh.vtu:9: 2 offsets and 1 types; each cell has one of both"));
  EXPECT_THAT(Vtu{.types = "13"}.said(),
              ElementsAre("mesh.vtu:8: cell 0 is of type 13, a wedge; read are tetrahedra of "
                          "4 points (type 10) or 10 (24) and bricks of 8 (12)"));
  EXPECT_THAT(Vtu{.types = "9"}.said(),
              ElementsAre(HasSubstr("scene.yaml:7: \"mesh.vtu\" holds no volumes, only 1 ")));
  EXPECT_THAT(said("<VTKFile type=\"UnstructuredGrid\"><Piece></Piece>\n<Piece>", "mesh.vtu"),
              ElementsAre("mesh.vtu:2: a second Piece; save the mesh as one"));
}

TEST(VolumeMeshMistakes, Meshes) {
  EXPECT_THAT(
      said_of_elements("1\n5 4 0 2 1 3 4\n"),
      ElementsAre(
          "mesh.msh:13: element 5 at (0.25, 0.25, 0.25) m is turned inside out: its volume is "
          "negative, or is at some point of it; put its nodes in the order of the format, or mesh that "
          "place anew"));
  EXPECT_THAT(
      said_of_nodes("4\n1 0 0 0\n2 1 0 0\n3 0 1 0\n4 1 1 0\n"),
      ElementsAre("mesh.msh:13: element 1 at (0.5, 0.5, 0) m has no volume; remove it, or mesh that place "
                  "anew"));
  EXPECT_THAT(
      said_of_elements("1\n5 4 0 1 2 3 3\n"),
      ElementsAre("mesh.msh:13: element 5 at (0.25, 0.5, 0) m names a node twice; remove it, or mesh that "
                  "place anew"));
  EXPECT_THAT(
      said_of_elements("2\n5 4 0 1 2 3 4\n6 4 0 1 2 3 4\n"),
      ElementsAre("mesh.msh:13: element 5 at (0.25, 0.25, 0.25) m shares a face with two others, or with one "
                  "that lies on the same side of it, as where it stands twice; write every element once "
                  "(Gmsh's version 2.2 repeats those in several physical groups, 4.1 does not)"));
  EXPECT_THAT(
      said("*NODE\n1, 0, 0, 0\n2, 1, 0, 0\n3, 0, 1, 0\n4, 0, 0, 1\n11, 5, 0, 0\n12, 6, 0, 0\n13, 5, 1, "
           "0\n14, 5, "
           "0, 1\n*ELEMENT, TYPE=C3D4\n1, 1, 2, 3, 4\n2, 11, 12, 13, 14\n",
           "mesh.inp"),
      ElementsAre("mesh.inp:12: element 2 at (5.25, 0.25, 0.25) m has no node in common with element 1, "
                  "neither directly nor through others; write each body to a file of its own, or merge the "
                  "nodes that lie at one place"));
}

TEST(VolumeMeshMistakes, AreListedTenTimesOfAKind) {
  Mesh mesh = model::box_mesh(Vec3::Zero(), Vec3::Ones(), {3, 1, 1}, ElementKind::tet4);
  for (std::size_t k = 0; k < mesh.elements.size(); k += 4) std::swap(mesh.elements[k], mesh.elements[k + 1]);
  const std::vector<std::string> all = said(Writer(mesh).gmsh_22(), "mesh.msh");
  ASSERT_EQ(all.size(), 11U);
  for (std::size_t k = 0; k < 10; ++k) EXPECT_THAT(all[k], HasSubstr("turned inside out"));
  EXPECT_EQ(all[10], "mesh.msh: and 8 more like it");
}

// Whatever becomes of a text, it is a mesh without problems or there is a mistake; said() checks that.
TEST(VolumeMeshMistakes, ChangedTextsAreReadOrRefused) {
  std::mt19937_64 random(20240401);
  const auto below = [&](std::size_t n) {
    return std::uniform_int_distribution<std::size_t>(0, n - 1)(random);
  };
  constexpr std::string_view letters = "0123456789-+.,eE*$<>\"'= \n#\tx\xff";
  for (const ElementKind kind : kinds) {
    const Mesh mesh = model::box_mesh(Vec3::Zero(), Vec3::Ones(), {1, 1, 1}, kind);
    for (const auto& [name, whole] : files_of(mesh)) {
      int refused = 0;
      for (int round = 0; round < 400; ++round) {
        std::string text = whole;
        const std::size_t at = below(text.size());
        const char letter = letters[below(letters.size())];
        switch (round % 4) {
          case 0:
            text.resize(at);
            break;
          case 1:
            text[at] = letter;
            break;
          case 2:
            text.insert(at, 1 + below(20), letter);
            break;
          default:
            text.erase(at, 1 + below(60));
        }
        SCOPED_TRACE(text);
        refused += said(text, name).empty() ? 0 : 1;
      }
      EXPECT_GT(refused, 150) << name;  // all that are cut off, and more
    }
  }
}

}  // namespace
}  // namespace eigengrain::io
