#pragma once

#include "eigengrain/base/vec.hpp"

#include <array>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

/// Walls of triangles: meshes, and polygons as fans of triangles.
namespace eigengrain::model {

/// Indices of the three corners of a triangle, counter-clockwise seen from the side its normal points to.
using Triangle = std::array<std::int32_t, 3>;

/// A triangulated wall. Triangles that share corners are neighbours.
struct Surface {
  std::vector<Vec3> vertices;       ///< at the start, m
  std::vector<Triangle> triangles;  ///< indices into vertices
  bool two_sided = false;           ///< else only the side that the normals point to is active
  std::int32_t material = 0;
  std::string name;            ///< for messages
  Vec3 centre = Vec3::Zero();  ///< about which it turns, and moments on it are taken, at the start, m
};

/// What is wrong with a triangulation.
struct SurfaceProblem {
  enum class Kind {
    degenerate,   ///< triangle `first` has no area: a height below 1e-9 of its longest edge
    branching,    ///< an edge has more than the two triangles `first` and `second`
    inconsistent  ///< `first` and `second` share an edge and face opposite ways
  };
  Kind kind = Kind::degenerate;
  std::int32_t first = 0;
  std::int32_t second = 0;
  Vec3 place = Vec3::Zero();  ///< the middle of the triangle or edge, m
};

/// All problems of a surface, triangle after triangle; empty if there is none. Cost O(n log n).
std::vector<SurfaceProblem> problems_of(const Surface& surface);

/// Turns triangles around so that neighbours face the same way: the first triangle of each connected part
/// decides. False where a part has no two sides, as a Möbius strip.
bool orient(Surface& surface);

/// A triangle with all that a contact asks of it, at the start of the scene.
struct Facet {
  std::array<Vec3, 3> corner;
  Vec3 normal;                         ///< unit
  std::array<std::int32_t, 3> vertex;  ///< identities of the corners, over all surfaces
  std::array<Vec3, 3> edge_normal;     ///< of edge k, from corner k to the next: the sum of both normals
  std::int32_t surface = 0;
};

/// The triangles of all surfaces, surface after surface.
struct Facets {
  std::vector<Facet> facet;
  /// [vertices of all surfaces] normals of the triangles about a vertex, weighted by their angles there: with
  /// it, the sign of (x - P)·normal tells outside from inside where the vertex is nearest (Bærentzen and
  /// Aanæs, IEEE Trans. Vis. Comput. Graph. 11:243, 2005); edge_normal does the same for edges.
  std::vector<Vec3> vertex_normal;
  std::vector<std::uint8_t> two_sided;  ///< [surfaces]
  /// [vertices of all surfaces] rows of the bodies that are the vertices of deformable surfaces, else -1;
  /// empty where no surface is deformable. Facets of such surfaces are where they are now.
  std::vector<std::int32_t> body;

  bool empty() const { return facet.empty(); }
  std::int32_t size() const { return static_cast<std::int32_t>(facet.size()); }
  /// Whether a facet belongs to a deformable surface.
  bool deforms(std::int32_t f) const {
    return !body.empty() && body[static_cast<std::size_t>(facet[static_cast<std::size_t>(f)].vertex[0])] >= 0;
  }
};

/// Of surfaces without problems.
Facets facets_of(std::span<const Surface> surfaces);

/// [triangles of a surface] The triangle behind each edge, or -1 where there is none.
std::vector<std::array<std::int32_t, 3>> neighbours_of(const Surface& surface);

/// Puts corners [vertices of all surfaces] of a surface somewhere else, and makes all that follows from it.
///
/// facet, vertex  its first facet and first vertex in `facets`
/// place          [vertices of the surface] m
void place_facets(Facets& facets, std::int32_t facet, std::int32_t vertex,
                  std::span<const std::array<std::int32_t, 3>> neighbours, std::span<const Vec3> place);

}  // namespace eigengrain::model
