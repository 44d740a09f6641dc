#pragma once

#include "eigengrain/base/vec.hpp"
#include "eigengrain/model/surface.hpp"

#include <array>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

/// Volume meshes: what a deformable body is made of.
namespace eigengrain::model {

/// Finite elements that exist. Nodes in the order of Gmsh, VTK and Abaqus, which agree for these three but
/// for the last two edge nodes of `tet10` in Gmsh's files; here it is the order of VTK and Abaqus:
///   tet4   the first three nodes counter-clockwise seen from the fourth
///   hex8   the bottom face counter-clockwise seen from above, then the top face
///   tet10  tet4, then the middles of edges 01, 12, 20, 03, 13, 23
enum class ElementKind : std::uint8_t { tet4, hex8, tet10 };

constexpr int nodes_of(ElementKind kind) {
  switch (kind) {
    case ElementKind::hex8:
      return 8;
    case ElementKind::tet10:
      return 10;
    case ElementKind::tet4:
      break;
  }
  return 4;
}
constexpr std::string_view name_of(ElementKind kind) {
  switch (kind) {
    case ElementKind::hex8:
      return "hex8";
    case ElementKind::tet10:
      return "tet10";
    case ElementKind::tet4:
      break;
  }
  return "tet4";
}

/// The elements of one body, all of one kind.
struct Mesh {
  ElementKind kind = ElementKind::tet4;
  std::vector<Vec3> nodes;             ///< m
  std::vector<std::int32_t> elements;  ///< [element_count × nodes_of(kind)] indices into nodes
  std::string name{};                  ///< for messages

  std::int32_t node_count() const { return static_cast<std::int32_t>(nodes.size()); }
  std::int32_t element_count() const {
    return static_cast<std::int32_t>(std::ssize(elements)) / nodes_of(kind);
  }
  std::span<const std::int32_t> element(std::int32_t e) const {
    const auto n = static_cast<std::size_t>(nodes_of(kind));
    return std::span(elements).subspan(static_cast<std::size_t>(e) * n, n);
  }
};

/// What is wrong with a mesh.
struct MeshProblem {
  enum class Kind {
    /// Element `index` has its nodes in an order that gives a negative volume at some point: at a corner, in
    /// the centre of a hex8 or at an integration point of a tet10.
    inverted,
    degenerate,  ///< element `index` has (nearly) no volume: below 1e-9 of the cube of its longest edge
    repeated,    ///< element `index` names a node twice; nothing else is said of it
    unused,      ///< node `index` belongs to no element
    /// More than two elements share a face of element `index`, the first of them, or two lie on the same side
    /// of it, as they do where an element is there twice.
    branching,
    /// Element `index` has no node in common with the first one, neither directly nor through others. Told of
    /// the first element of each such part.
    parts
  };
  Kind kind = Kind::degenerate;
  std::int32_t index = 0;
  Vec3 place = Vec3::Zero();  ///< the middle of the element, or the node, m
};

/// All problems of a mesh, in the order of its elements, then nodes; empty if there is none. Cost O(n log n).
std::vector<MeshProblem> problems_of(const Mesh& mesh);

/// A rectangular block: `cells` equal bricks along x, y, z. As tet4 or tet10 each brick is six tetrahedra
/// about one diagonal, and the mirror image of its neighbours, so that faces fit and no direction of
/// diagonals is preferred.
///
/// corner  least coordinates, m
/// size    edges, positive, m
/// cells   at least one each, and fewer than 2^31 nodes in all
Mesh box_mesh(const Vec3& corner, const Vec3& size, const std::array<std::int32_t, 3>& cells,
              ElementKind kind);

/// The boundary of a mesh without problems: triangles whose normals point outward, over all nodes that are on
/// it (a quadrangle is two triangles, a face of a tet10 four over its six nodes), element after element.
/// vertices are those nodes in increasing order; `nodes` [vertices] receives which node of the mesh each is.
/// Cost O(n log n).
Surface skin_of(const Mesh& mesh, std::vector<std::int32_t>& nodes);

}  // namespace eigengrain::model
