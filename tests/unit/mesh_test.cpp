// Blocks of elements, their skin, and what is wrong with meshes.
#include "eigengrain/model/mesh.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <numeric>
#include <set>
#include <utility>

namespace eigengrain::model {
namespace {

using testing::ElementsAre;
using testing::IsEmpty;
using Problem = MeshProblem::Kind;

constexpr std::array<ElementKind, 3> kinds{ElementKind::tet4, ElementKind::hex8, ElementKind::tet10};

const Vec3 corner(-0.3, 2, 5);
const Vec3 size(0.4, 0.7, 1.1);
constexpr std::array<std::int32_t, 3> cells{3, 2, 4};

Mesh block(ElementKind kind) {
  return box_mesh(corner, size, cells, kind);
}

const Vec3& at(const std::vector<Vec3>& points, std::int32_t index) {
  return points[static_cast<std::size_t>(index)];
}

/// Six times the volume of a tetrahedron.
double triple(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d) {
  return (b - a).cross(c - a).dot(d - a);
}

/// By the divergence theorem: V = Σ a·(b × c) / 6 over triangles that close a surface.
double volume_within(const Surface& surface) {
  const Vec3& origin = surface.vertices.at(0);
  double sum = 0;
  for (const auto& [a, b, c] : surface.triangles)
    sum += triple(origin, at(surface.vertices, a), at(surface.vertices, b), at(surface.vertices, c));
  return sum / 6;
}

/// The elements or nodes that have a problem of this kind.
std::vector<std::int32_t> told(const Mesh& mesh, Problem kind) {
  std::vector<std::int32_t> indices;
  for (const MeshProblem& problem : problems_of(mesh))
    if (problem.kind == kind) indices.push_back(problem.index);
  return indices;
}

TEST(BoxMesh, HasNoProblems) {
  for (const ElementKind kind : kinds) {
    EXPECT_THAT(problems_of(block(kind)), IsEmpty()) << name_of(kind);
    EXPECT_THAT(problems_of(box_mesh(corner, size, {1, 1, 1}, kind)), IsEmpty()) << name_of(kind);
  }
}

TEST(BoxMesh, HasTheNodesOfItsGrid) {
  const auto count = [](ElementKind kind) {
    return std::pair(block(kind).element_count(), block(kind).node_count());
  };
  EXPECT_EQ(count(ElementKind::hex8), std::pair(24, 4 * 3 * 5));
  EXPECT_EQ(count(ElementKind::tet4), std::pair(6 * 24, 4 * 3 * 5));
  EXPECT_EQ(count(ElementKind::tet10), std::pair(6 * 24, 7 * 5 * 9));
  for (const ElementKind kind : kinds) {
    const Mesh mesh = block(kind);
    EXPECT_EQ(mesh.nodes.front(), corner);
    EXPECT_EQ(mesh.nodes.back(), corner + size);  // exactly, so that blocks fit side by side
  }
}

TEST(BoxMesh, TetrahedraAreOfOneVolumeAndOrientation) {
  for (const ElementKind kind : {ElementKind::tet4, ElementKind::tet10}) {
    const Mesh mesh = block(kind);
    for (std::int32_t e = 0; e < mesh.element_count(); ++e) {
      const auto nodes = mesh.element(e);
      const auto x = [&](std::size_t k) { return at(mesh.nodes, nodes[k]); };
      // 24 bricks of six. Coordinates up to 6 have errors of 1e-15, and edges are 0.1 and more.
      EXPECT_NEAR(triple(x(0), x(1), x(2), x(3)) * 24 / size.prod(), 1, 1e-12);
    }
  }
}

TEST(BoxMesh, NodesOnEdgesAreInTheirMiddles) {
  constexpr std::array<std::array<std::size_t, 2>, 6> edges{{{0, 1}, {1, 2}, {2, 0}, {0, 3}, {1, 3}, {2, 3}}};
  const Mesh mesh = block(ElementKind::tet10);
  for (std::int32_t e = 0; e < mesh.element_count(); ++e)
    for (std::size_t k = 0; k < edges.size(); ++k) {
      const auto x = [&](std::size_t local) { return at(mesh.nodes, mesh.element(e)[local]); };
      EXPECT_LT((x(4 + k) - (x(edges[k][0]) + x(edges[k][1])) / 2).norm(),
                1e-14);  // rounding of numbers up to 6
    }
}

/// How many elements have each face, told by its corners.
std::map<std::set<std::int32_t>, int> face_counts(const Mesh& mesh) {
  const std::vector<std::vector<std::size_t>> faces =
      mesh.kind == ElementKind::hex8
          ? std::vector<std::vector<std::size_t>>{{0, 1, 2, 3}, {4, 5, 6, 7}, {0, 1, 4, 5},
                                                  {1, 2, 5, 6}, {2, 3, 6, 7}, {3, 0, 7, 4}}
          : std::vector<std::vector<std::size_t>>{{0, 1, 2}, {0, 1, 3}, {1, 2, 3}, {2, 0, 3}};
  std::map<std::set<std::int32_t>, int> counts;
  for (std::int32_t e = 0; e < mesh.element_count(); ++e)
    for (const auto& face : faces) {
      std::set<std::int32_t> nodes;
      for (const std::size_t k : face) nodes.insert(mesh.element(e)[k]);
      ++counts[nodes];
    }
  return counts;
}

// Counted: faces fit where each has two elements, but for as many as the sides of the block have.
TEST(BoxMesh, FacesFit) {
  const int sides = 2 * (3 * 2 + 2 * 4 + 4 * 3);  // faces of bricks
  for (const ElementKind kind : kinds) {
    const Mesh mesh = block(kind);
    int outer = 0;
    for (const auto& [nodes, count] : face_counts(mesh)) {
      EXPECT_LE(count, 2);
      if (count != 1) continue;
      ++outer;
      bool on_a_side = false;
      for (int axis = 0; axis < 3; ++axis)
        for (const double side : {corner[axis], corner[axis] + size[axis]})
          on_a_side = on_a_side || std::all_of(nodes.begin(), nodes.end(), [&](std::int32_t node) {
                        return std::abs(at(mesh.nodes, node)[axis] - side) < 1e-14;
                      });
      EXPECT_TRUE(on_a_side);
    }
    EXPECT_EQ(outer, kind == ElementKind::hex8 ? sides : 2 * sides) << name_of(kind);
  }
}

TEST(Skin, IsClosedAndHasTheVolumeOfTheBlock) {
  for (const ElementKind kind : kinds) {
    SCOPED_TRACE(name_of(kind));
    const Mesh mesh = block(kind);
    std::vector<std::int32_t> nodes;
    const Surface skin = skin_of(mesh, nodes);
    EXPECT_THAT(problems_of(skin), IsEmpty());
    std::map<std::pair<std::int32_t, std::int32_t>, int> edges;
    for (const Triangle& t : skin.triangles)
      for (std::size_t k = 0; k < 3; ++k) ++edges[{t[k], t[(k + 1) % 3]}];
    for (const auto& [edge, count] : edges) {
      EXPECT_EQ(count, 1);
      EXPECT_EQ(edges.count({edge.second, edge.first}), 1U);
    }
    EXPECT_NEAR(volume_within(skin) / size.prod(), 1, 1e-13);  // a sum of some hundred terms
    // Two triangles a brick, or for tet10 eight.
    EXPECT_EQ(skin.triangles.size(), kind == ElementKind::tet10 ? 8U * 52 : 2U * 52);
  }
}

TEST(Skin, FacesOutward) {
  for (const ElementKind kind : kinds) {
    std::vector<std::int32_t> nodes;
    const Surface skin = skin_of(block(kind), nodes);
    for (const auto& [a, b, c] : skin.triangles) {
      const Vec3& x = at(skin.vertices, a);
      const Vec3 normal = (at(skin.vertices, b) - x).cross(at(skin.vertices, c) - x).normalized();
      // Of a block the normal is an axis, and the middle lies behind every side by half an edge.
      const Vec3 outward = x - (corner + size / 2);
      EXPECT_NEAR(normal.cwiseAbs().maxCoeff(), 1, 1e-12);
      EXPECT_NEAR(normal.dot(outward), normal.cwiseAbs().dot(size) / 2, 1e-12);
    }
  }
}

TEST(Skin, HasTheNodesThatAreOnIt) {
  for (const ElementKind kind : kinds) {
    const Mesh mesh = block(kind);
    std::vector<std::int32_t> nodes;
    const Surface skin = skin_of(mesh, nodes);
    EXPECT_TRUE(std::is_sorted(nodes.begin(), nodes.end()));
    ASSERT_EQ(nodes.size(), skin.vertices.size());
    std::vector<std::int32_t> expected;
    for (std::int32_t node = 0; node < mesh.node_count(); ++node) {
      const Vec3 inwards = (at(mesh.nodes, node) - corner).cwiseMin(corner + size - at(mesh.nodes, node));
      if (inwards.minCoeff() < 1e-14) expected.push_back(node);
    }
    EXPECT_EQ(nodes, expected) << name_of(kind);
    for (std::size_t k = 0; k < nodes.size(); ++k) EXPECT_EQ(skin.vertices[k], at(mesh.nodes, nodes[k]));
  }
}

// Triangles over the six nodes: with one of them pulled out of its plane, the volume grows by the pyramids
// below it.
TEST(Skin, OfQuadraticTetrahedraFollowsTheirMiddles) {
  Mesh mesh;
  mesh.kind = ElementKind::tet10;
  mesh.nodes = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
  for (const auto& [i, j] :
       {std::pair(0, 1), std::pair(1, 2), std::pair(2, 0), std::pair(0, 3), std::pair(1, 3), std::pair(2, 3)})
    mesh.nodes.emplace_back((at(mesh.nodes, i) + at(mesh.nodes, j)) / 2);
  mesh.elements.resize(10);
  std::iota(mesh.elements.begin(), mesh.elements.end(), 0);
  std::vector<std::int32_t> nodes;
  EXPECT_NEAR(volume_within(skin_of(mesh, nodes)), 1.0 / 6, 1e-16);
  EXPECT_EQ(nodes, mesh.elements);
  mesh.nodes[4].z() -= 0.1;  // the middle of the edge along x
  // Below the plane z = 0: a pyramid over the three of its triangles that have this node, 3/4 · 1/2 in all,
  // of the height 0.1; the plane y = 0 changes within itself.
  EXPECT_NEAR(volume_within(skin_of(mesh, nodes)), 1.0 / 6 + 0.1 * 0.375 / 3, 1e-16);
  EXPECT_THAT(problems_of(mesh), IsEmpty());
}

TEST(MeshProblems, Inverted) {
  for (const ElementKind kind : kinds) {
    Mesh mesh = block(kind);
    const auto n = static_cast<std::size_t>(nodes_of(kind));
    std::swap(mesh.elements[5 * n], mesh.elements[5 * n + 1]);
    EXPECT_THAT(told(mesh, Problem::inverted), ElementsAre(5)) << name_of(kind);
    EXPECT_EQ(problems_of(mesh).size(), 1U) << name_of(kind);
  }
}

TEST(MeshProblems, InvertedAtOnePointOnly) {
  // A brick with a corner pushed to within the tetrahedron of its three neighbours and the origin: its volume
  // is positive.
  Mesh brick = box_mesh(Vec3::Zero(), Vec3::Ones(), {1, 1, 1}, ElementKind::hex8);
  brick.nodes[7] = {0.6, 0.6, 0.6};
  EXPECT_THAT(told(brick, Problem::inverted), ElementsAre(0));
  brick.nodes[7] = {0.7, 0.7, 0.7};  // beyond 2/3, the plane through its neighbours
  EXPECT_THAT(problems_of(brick), IsEmpty());
  // A quadratic edge whose node is past a quarter of it runs back on itself at its end: dx/dξ = 4 m - 1
  // there.
  Mesh quadratic = box_mesh(Vec3::Zero(), Vec3::Ones(), {1, 1, 1}, ElementKind::tet10);
  const auto element = quadratic.element(0);
  const auto move = [&](double part) {
    quadratic.nodes[static_cast<std::size_t>(element[4])] =
        (1 - part) * at(quadratic.nodes, element[0]) + part * at(quadratic.nodes, element[1]);
    return told(quadratic, Problem::inverted);
  };
  EXPECT_THAT(move(0.26), IsEmpty());
  EXPECT_THAT(move(0.24), testing::Contains(0));
  EXPECT_THAT(move(0.74), IsEmpty());
  EXPECT_THAT(move(0.76), testing::Contains(0));
}

TEST(MeshProblems, Degenerate) {
  for (const ElementKind kind : kinds) {
    Mesh mesh = box_mesh(corner, size, {1, 1, 1}, kind);
    for (Vec3& x : mesh.nodes) x.z() = corner.z();
    std::vector<std::int32_t> all(static_cast<std::size_t>(mesh.element_count()));
    std::iota(all.begin(), all.end(), 0);
    EXPECT_EQ(told(mesh, Problem::degenerate), all) << name_of(kind);
    EXPECT_EQ(problems_of(mesh).size(), all.size()) << name_of(kind);
    // Not too flat: the smallest are tetrahedra of 1e-7/6 m³, 6e-9 of the cube of the diagonal of their face.
    mesh = box_mesh(Vec3::Zero(), {1, 1, 1e-7}, {1, 1, 1}, kind);
    EXPECT_THAT(problems_of(mesh), IsEmpty());
    mesh.nodes[0].x() = std::nan("");
    EXPECT_THAT(told(mesh, Problem::degenerate), testing::Contains(0)) << name_of(kind);
  }
}

TEST(MeshProblems, Repeated) {
  for (const ElementKind kind : kinds) {
    Mesh mesh = block(kind);
    const auto n = static_cast<std::size_t>(nodes_of(kind));
    mesh.elements[7 * n + n - 1] = mesh.elements[7 * n + 1];
    EXPECT_THAT(told(mesh, Problem::repeated), ElementsAre(7)) << name_of(kind);
    for (const MeshProblem& problem : problems_of(mesh))
      if (problem.index == 7) {
        EXPECT_EQ(problem.kind, Problem::repeated) << name_of(kind);
      }
  }
}

TEST(MeshProblems, Unused) {
  for (const ElementKind kind : kinds) {
    Mesh mesh = block(kind);
    const std::int32_t count = mesh.node_count();
    mesh.nodes.emplace_back(1, 2, 3);
    mesh.nodes.emplace_back(4, 5, 6);
    EXPECT_THAT(told(mesh, Problem::unused), ElementsAre(count, count + 1));
    EXPECT_EQ(problems_of(mesh).at(1).place, Vec3(4, 5, 6));
    EXPECT_EQ(problems_of(mesh).size(), 2U);
  }
}

TEST(MeshProblems, Branching) {
  // Three tetrahedra about one triangle.
  Mesh mesh;
  mesh.nodes = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {0, 0, -1}, {0, 0, 2}};
  mesh.elements = {0, 1, 2, 3, 1, 0, 2, 4, 0, 1, 2, 5};
  ASSERT_EQ(problems_of(mesh).size(), 1U);
  EXPECT_EQ(problems_of(mesh)[0].kind, Problem::branching);
  EXPECT_EQ(problems_of(mesh)[0].index, 0);
  EXPECT_LT((problems_of(mesh)[0].place - Vec3(0.25, 0.25, 0.25)).norm(), 1e-16);
  // Two on the same side of it.
  mesh.elements = {1, 0, 2, 4, 1, 0, 2, 4};
  EXPECT_THAT(told(mesh, Problem::branching), ElementsAre(0));
  mesh.elements = {0, 1, 2, 3, 0, 1, 2, 5};
  EXPECT_THAT(told(mesh, Problem::branching), ElementsAre(0));
  // An element that is there twice, of each kind.
  for (const ElementKind kind : kinds) {
    Mesh twice = block(kind);
    const auto last = twice.element(twice.element_count() - 1);
    const std::vector<std::int32_t> copy(last.begin(), last.end());
    twice.elements.insert(twice.elements.end(), copy.begin(), copy.end());
    EXPECT_THAT(told(twice, Problem::branching), testing::Contains(twice.element_count() - 2))
        << name_of(kind);
  }
}

TEST(MeshProblems, Parts) {
  for (const ElementKind kind : kinds) {
    Mesh mesh = block(kind);
    const std::int32_t first = mesh.element_count();
    for (const double x : {10.0, 20.0}) {
      const Mesh other = box_mesh({x, 0, 0}, size, {2, 1, 1}, kind);
      for (const std::int32_t node : other.elements) mesh.elements.push_back(node + mesh.node_count());
      mesh.nodes.insert(mesh.nodes.end(), other.nodes.begin(), other.nodes.end());
    }
    const std::int32_t each = (mesh.element_count() - first) / 2;
    EXPECT_THAT(told(mesh, Problem::parts), ElementsAre(first, first + each)) << name_of(kind);
    EXPECT_EQ(problems_of(mesh).size(), 2U);
  }
}

TEST(MeshProblems, StandInTheOrderOfElementsThenNodes) {
  Mesh mesh = block(ElementKind::tet4);
  mesh.nodes.emplace_back(9, 9, 9);
  std::swap(mesh.elements[4 * 8], mesh.elements[4 * 8 + 1]);
  mesh.elements[4 * 3 + 1] = mesh.elements[4 * 3];
  std::vector<std::pair<Problem, std::int32_t>> found;
  for (const MeshProblem& problem : problems_of(mesh)) found.emplace_back(problem.kind, problem.index);
  EXPECT_THAT(found, ElementsAre(std::pair(Problem::repeated, 3), std::pair(Problem::inverted, 8),
                                 std::pair(Problem::unused, 60)));
}

}  // namespace
}  // namespace eigengrain::model
