#include "eigengrain/model/mesh.hpp"

#include "eigengrain/base/assert.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <tuple>
#include <utility>

namespace eigengrain::model {
namespace {

constexpr double flattest = 1e-9;  // volume over the cube of the longest edge
constexpr std::int8_t none = -1;

/// A face by its corners, counter-clockwise seen from outside, and the middles of the edges behind each of
/// them. A triangle has no fourth corner.
struct LocalFace {
  std::array<std::int8_t, 4> corner;
  std::array<std::int8_t, 3> middle{none, none, none};

  std::size_t corners() const { return corner[3] == none ? 3 : 4; }
};

constexpr std::array<LocalFace, 4> faces_of_a_tetrahedron{{{{0, 2, 1, none}, {6, 5, 4}},
                                                           {{0, 1, 3, none}, {4, 8, 7}},
                                                           {{1, 2, 3, none}, {5, 9, 8}},
                                                           {{0, 3, 2, none}, {7, 9, 6}}}};
constexpr std::array<LocalFace, 6> faces_of_a_brick{
    {{{0, 3, 2, 1}}, {{4, 5, 6, 7}}, {{0, 1, 5, 4}}, {{1, 2, 6, 5}}, {{2, 3, 7, 6}}, {{3, 0, 4, 7}}}};

std::span<const LocalFace> faces_of(ElementKind kind) {
  if (kind == ElementKind::hex8) return faces_of_a_brick;
  return faces_of_a_tetrahedron;
}

std::int32_t node_at(std::span<const std::int32_t> element, std::int8_t local) {
  return element[static_cast<std::size_t>(local)];
}

/// A face of an element, by its corners in increasing order.
struct Face {
  std::array<std::int32_t, 4> corner{none, none, none, none};
  std::int32_t element = 0;
  std::int8_t side = 0;  ///< which of faces_of
  /// Counter-clockwise seen from outside of its element comes, next to the lowest corner, the lower of the
  /// two beside it. True of exactly one of two elements with the face between them.
  bool forward = true;
};

Face face_of(std::span<const std::int32_t> element, const LocalFace& local, std::int32_t index,
             std::size_t side) {
  Face face;
  face.element = index;
  face.side = static_cast<std::int8_t>(side);
  const std::size_t count = local.corners();
  std::size_t lowest = 0;
  for (std::size_t k = 0; k < count; ++k) {
    face.corner[k] = node_at(element, local.corner[k]);
    if (face.corner[k] < face.corner[lowest]) lowest = k;
  }
  face.forward = face.corner[(lowest + 1) % count] < face.corner[(lowest + count - 1) % count];
  std::sort(face.corner.begin(), face.corner.begin() + static_cast<std::ptrdiff_t>(count));
  return face;
}

/// The faces of all elements that `wanted` is true of, those with the same corners together, and there by
/// element.
template <class Wanted>
std::vector<Face> sorted_faces(const Mesh& mesh, const Wanted& wanted) {
  const std::span<const LocalFace> local = faces_of(mesh.kind);
  std::vector<Face> faces;
  faces.reserve(local.size() * static_cast<std::size_t>(mesh.element_count()));
  for (std::int32_t e = 0; e < mesh.element_count(); ++e) {
    if (!wanted(e)) continue;
    for (std::size_t side = 0; side < local.size(); ++side)
      faces.push_back(face_of(mesh.element(e), local[side], e, side));
  }
  std::sort(faces.begin(), faces.end(), [](const Face& l, const Face& r) {
    return std::tie(l.corner, l.element, l.side) < std::tie(r.corner, r.element, r.side);
  });
  return faces;
}

/// Calls visit(span) for the faces of each set of corners.
template <class Visit>
void for_each_face(std::span<const Face> faces, const Visit& visit) {
  for (std::size_t begin = 0; begin < faces.size();) {
    std::size_t end = begin + 1;
    while (end < faces.size() && faces[end].corner == faces[begin].corner) ++end;
    visit(faces.subspan(begin, end - begin));
    begin = end;
  }
}

/// ∂N/∂ξ of every node, at one point of an element.
using Gradients = std::vector<Vec3>;

/// Reference coordinates of a brick are -1 to 1.
constexpr std::array<std::array<double, 3>, 8> corners_of_a_brick{
    {{-1, -1, -1}, {1, -1, -1}, {1, 1, -1}, {-1, 1, -1}, {-1, -1, 1}, {1, -1, 1}, {1, 1, 1}, {-1, 1, 1}}};

/// N = Π (1 + s ξ) / 8 over the three axes, with s the coordinates of the node.
Gradients gradients_in_a_brick(const std::array<double, 3>& at) {
  Gradients gradients;
  for (const auto& s : corners_of_a_brick) {
    const double x = 1 + s[0] * at[0];
    const double y = 1 + s[1] * at[1];
    const double z = 1 + s[2] * at[2];
    gradients.emplace_back(s[0] * y * z / 8, x * s[1] * z / 8, x * y * s[2] / 8);
  }
  return gradients;
}

/// ∂L/∂ξ of the barycentric coordinates L = (1 - ξ - η - ζ, ξ, η, ζ) of a tetrahedron.
Gradients gradients_in_a_tetrahedron() {
  return {Vec3(-1, -1, -1), Vec3::UnitX(), Vec3::UnitY(), Vec3::UnitZ()};
}

/// N = L (2 L - 1) at corners, 4 L_i L_j in the middles of edges ij.
Gradients gradients_in_a_quadratic_tetrahedron(const std::array<double, 4>& l) {
  constexpr std::array<std::array<std::size_t, 2>, 6> edges{{{0, 1}, {1, 2}, {2, 0}, {0, 3}, {1, 3}, {2, 3}}};
  const Gradients corner = gradients_in_a_tetrahedron();
  Gradients gradients;
  for (std::size_t i = 0; i < 4; ++i) gradients.emplace_back((4 * l[i] - 1) * corner[i]);
  for (const auto& [i, j] : edges) gradients.emplace_back(4 * (l[i] * corner[j] + l[j] * corner[i]));
  return gradients;
}

/// Where elements of a kind are looked at.
std::vector<Gradients> gradients_of(ElementKind kind) {
  std::vector<Gradients> points;
  switch (kind) {
    case ElementKind::tet4:  // the same everywhere
      points.push_back(gradients_in_a_tetrahedron());
      break;
    case ElementKind::hex8:
      for (const auto& corner : corners_of_a_brick) points.push_back(gradients_in_a_brick(corner));
      points.push_back(gradients_in_a_brick({0, 0, 0}));
      break;
    case ElementKind::tet10:
      // The four points of the rule of second order.
      const double near = (5 + 3 * std::sqrt(5.0)) / 20;
      for (const auto& [one, others] : {std::pair(1.0, 0.0), std::pair(near, (1 - near) / 3)})
        for (std::size_t i = 0; i < 4; ++i) {
          std::array<double, 4> l{others, others, others, others};
          l[i] = one;
          points.push_back(gradients_in_a_quadratic_tetrahedron(l));
        }
      break;
  }
  return points;
}

double longest_edge(const Mesh& mesh, std::span<const std::int32_t> element) {
  double longest = 0;
  for (const LocalFace& face : faces_of(mesh.kind)) {
    const std::size_t count = face.corners();
    for (std::size_t k = 0; k < count; ++k) {
      const auto from = static_cast<std::size_t>(node_at(element, face.corner[k]));
      const auto to = static_cast<std::size_t>(node_at(element, face.corner[(k + 1) % count]));
      longest = std::max(longest, (mesh.nodes[to] - mesh.nodes[from]).squaredNorm());
    }
  }
  return std::sqrt(longest);
}

/// The middle of the corners, m.
Vec3 middle_of(const Mesh& mesh, std::span<const std::int32_t> element) {
  const std::size_t corners = mesh.kind == ElementKind::hex8 ? 8 : 4;
  Vec3 sum = Vec3::Zero();
  for (const std::int32_t node : element.first(corners)) sum += mesh.nodes[static_cast<std::size_t>(node)];
  return sum / static_cast<double>(corners);
}

bool names_a_node_twice(std::span<const std::int32_t> element) {
  for (std::size_t k = 1; k < element.size(); ++k)
    if (std::find(element.begin(), element.begin() + static_cast<std::ptrdiff_t>(k), element[k]) !=
        element.begin() + static_cast<std::ptrdiff_t>(k))
      return true;
  return false;
}

/// Collects what is wrong with a mesh, one sort of mistake after the other.
class MeshCheck {
 public:
  explicit MeshCheck(const Mesh& mesh)
      : mesh_(mesh), is_(static_cast<std::size_t>(mesh.element_count()), Is::sound) {}

  std::vector<MeshProblem> problems() {
    check_elements();
    check_faces();
    check_parts();
    check_nodes();
    const auto order = [](const MeshProblem& p) {
      return std::tuple(p.kind == Kind::unused, p.index, static_cast<int>(p.kind));
    };
    std::stable_sort(problems_.begin(), problems_.end(),
                     [&](const MeshProblem& l, const MeshProblem& r) { return order(l) < order(r); });
    // Several faces of one element may branch.
    problems_.erase(
        std::unique(problems_.begin(), problems_.end(),
                    [&](const MeshProblem& l, const MeshProblem& r) { return order(l) == order(r); }),
        problems_.end());
    return std::move(problems_);
  }

 private:
  using Kind = MeshProblem::Kind;
  enum class Is : std::uint8_t { sound, misshapen, repeated };

  Is& is(std::int32_t element) { return is_[static_cast<std::size_t>(element)]; }
  void add(Kind kind, std::int32_t element) {
    problems_.push_back({kind, element, middle_of(mesh_, mesh_.element(element))});
  }

  void check_elements() {
    const std::vector<Gradients> points = gradients_of(mesh_.kind);
    const double whole = mesh_.kind == ElementKind::hex8 ? 8 : 1.0 / 6;  // volume of the reference element
    for (std::int32_t e = 0; e < mesh_.element_count(); ++e) {
      const std::span<const std::int32_t> element = mesh_.element(e);
      if (names_a_node_twice(element)) {
        is(e) = Is::repeated;
        add(Kind::repeated, e);
        continue;
      }
      double least = std::numeric_limits<double>::infinity();
      double largest = 0;
      for (const Gradients& gradients : points) {
        Mat3 jacobian = Mat3::Zero();
        for (std::size_t k = 0; k < gradients.size(); ++k)
          jacobian.noalias() += mesh_.nodes[static_cast<std::size_t>(element[k])] * gradients[k].transpose();
        const double volume = whole * jacobian.determinant();
        least = std::min(least, volume);
        largest = std::max(largest, std::abs(volume));
      }
      const double longest = longest_edge(mesh_, element);
      const double rounding = flattest * longest * longest * longest;
      if (largest > rounding && least >= -rounding) continue;
      is(e) = Is::misshapen;
      add(largest > rounding ? Kind::inverted : Kind::degenerate, e);
    }
  }

  void check_faces() {
    const std::vector<Face> faces =
        sorted_faces(mesh_, [&](std::int32_t e) { return is(e) != Is::repeated; });
    for_each_face(faces, [&](std::span<const Face> same) {
      // What lies on which side of a misshapen element means nothing.
      const bool overlap = same.size() == 2 && same[0].forward == same[1].forward &&
                           is(same[0].element) == Is::sound && is(same[1].element) == Is::sound;
      if (same.size() > 2 || overlap) add(Kind::branching, same[0].element);
    });
  }

  void check_parts() {
    std::vector<std::int32_t> towards(mesh_.nodes.size());
    std::iota(towards.begin(), towards.end(), 0);
    const auto up = [&](std::int32_t node) -> std::int32_t& {
      return towards[static_cast<std::size_t>(node)];
    };
    const auto root = [&](std::int32_t node) {
      while (up(node) != node) {
        up(node) = up(up(node));  // so that ways stay short
        node = up(node);
      }
      return node;
    };
    for (std::int32_t e = 0; e < mesh_.element_count(); ++e)
      for (const std::int32_t node : mesh_.element(e)) {
        const std::int32_t one = root(mesh_.element(e)[0]);
        const std::int32_t two = root(node);
        up(std::max(one, two)) = std::min(one, two);
      }
    std::vector<std::uint8_t> met(mesh_.nodes.size(), 0);
    for (std::int32_t e = 0; e < mesh_.element_count(); ++e) {
      std::uint8_t& part = met[static_cast<std::size_t>(root(mesh_.element(e)[0]))];
      if (part == 0 && e > 0) add(Kind::parts, e);
      part = 1;
    }
  }

  void check_nodes() {
    std::vector<std::uint8_t> used(mesh_.nodes.size(), 0);
    for (const std::int32_t node : mesh_.elements) used[static_cast<std::size_t>(node)] = 1;
    for (std::size_t node = 0; node < used.size(); ++node)
      if (used[node] == 0)
        problems_.push_back({Kind::unused, static_cast<std::int32_t>(node), mesh_.nodes[node]});
  }

  const Mesh& mesh_;
  std::vector<Is> is_;  ///< [elements]
  std::vector<MeshProblem> problems_;
};

/// A place in the grid of nodes of a block.
using GridPlace = Eigen::Vector3i;

/// The nodes of a block, x fastest. Of tet10 there is one in the middle of every edge, and the edges of the
/// six tetrahedra of a brick have their middles at all places of the grid of half the bricks.
class Grid {
 public:
  Grid(const std::array<std::int32_t, 3>& cells, std::int32_t step)
      : last_(step * cells[0], step * cells[1], step * cells[2]) {
    EIGENGRAIN_ASSERT(last_.minCoeff() > 0, last_.transpose());
    EIGENGRAIN_ASSERT((last_.cast<double>().array() + 1).prod() < 2147483648.0, last_.transpose());
  }

  std::int32_t node(const GridPlace& at) const {
    return (at[2] * (last_[1] + 1) + at[1]) * (last_[0] + 1) + at[0];
  }
  std::vector<Vec3> nodes(const Vec3& corner, const Vec3& size) const {
    std::vector<Vec3> nodes;
    for (GridPlace at(0, 0, 0); at[2] <= last_[2]; ++at[2])
      for (at[1] = 0; at[1] <= last_[1]; ++at[1])
        for (at[0] = 0; at[0] <= last_[0]; ++at[0])
          nodes.emplace_back(corner.array() +
                             size.array() * (at.cast<double>().array() / last_.cast<double>().array()));
    return nodes;
  }

 private:
  GridPlace last_;
};

void add_brick(const GridPlace& cell, const Grid& grid, std::vector<std::int32_t>& elements) {
  constexpr std::array<std::array<int, 3>, 8> corners{
      {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}, {0, 0, 1}, {1, 0, 1}, {1, 1, 1}, {0, 1, 1}}};
  for (const auto& [x, y, z] : corners) elements.push_back(grid.node(cell + GridPlace(x, y, z)));
}

/// Each of the six goes from one end of the diagonal to the other along the three axes in an order of its
/// own.
void add_tetrahedra(const GridPlace& cell, const Grid& grid, bool quadratic,
                    std::vector<std::int32_t>& elements) {
  constexpr std::array<std::array<int, 3>, 6> orders{
      {{0, 1, 2}, {1, 2, 0}, {2, 0, 1}, {0, 2, 1}, {2, 1, 0}, {1, 0, 2}}};
  const int step = quadratic ? 2 : 1;
  // Neighbours are mirror images: where a brick starts at the one end of an axis, the next one starts at the
  // other.
  const GridPlace odd = cell.unaryExpr([](int k) { return k % 2; });
  const GridPlace start = step * (cell + odd);
  const GridPlace way = step * (GridPlace::Ones() - 2 * odd);
  const bool mirrored = odd.sum() % 2 == 1;
  for (std::size_t k = 0; k < orders.size(); ++k) {
    std::array<GridPlace, 4> corner{start, start, start, start};
    for (std::size_t c = 1; c < 4; ++c) {
      const int axis = orders[k][c - 1];
      corner[c] = corner[c - 1];
      corner[c][axis] += way[axis];
    }
    if (mirrored == (k < 3)) std::swap(corner[1], corner[2]);
    const auto add_middle = [&](std::size_t i, std::size_t j) {
      elements.push_back(grid.node((corner[i] + corner[j]) / 2));
    };
    for (const GridPlace& at : corner) elements.push_back(grid.node(at));
    if (!quadratic) continue;
    add_middle(0, 1);
    add_middle(1, 2);
    add_middle(2, 0);
    for (std::size_t i = 0; i < 3; ++i) add_middle(i, 3);
  }
}

/// The triangles of a face of `element`, over nodes of the mesh.
void add_triangles(std::span<const std::int32_t> element, const LocalFace& local,
                   std::vector<Triangle>& triangles) {
  std::array<std::int32_t, 4> c{none, none, none, none};
  for (std::size_t k = 0; k < local.corners(); ++k) c[k] = node_at(element, local.corner[k]);
  if (local.corners() == 4) {
    // The diagonal from the lowest node: so it does not depend on the order within the element.
    std::rotate(c.begin(), std::min_element(c.begin(), c.end()), c.end());
    triangles.push_back({c[0], c[1], c[2]});
    triangles.push_back({c[0], c[2], c[3]});
  } else if (element.size() == 4) {
    triangles.push_back({c[0], c[1], c[2]});
  } else {
    std::array<std::int32_t, 3> m{};
    for (std::size_t k = 0; k < 3; ++k) m[k] = node_at(element, local.middle[k]);
    for (std::size_t k = 0; k < 3; ++k) triangles.push_back({c[k], m[k], m[(k + 2) % 3]});
    triangles.push_back({m[0], m[1], m[2]});
  }
}

}  // namespace

std::vector<MeshProblem> problems_of(const Mesh& mesh) {
  return MeshCheck(mesh).problems();
}

Mesh box_mesh(const Vec3& corner, const Vec3& size, const std::array<std::int32_t, 3>& cells,
              ElementKind kind) {
  const bool quadratic = kind == ElementKind::tet10;
  const Grid grid(cells, quadratic ? 2 : 1);
  Mesh mesh{kind, grid.nodes(corner, size), {}, "box"};
  for (GridPlace cell(0, 0, 0); cell[2] < cells[2]; ++cell[2])
    for (cell[1] = 0; cell[1] < cells[1]; ++cell[1])
      for (cell[0] = 0; cell[0] < cells[0]; ++cell[0])
        if (kind == ElementKind::hex8)
          add_brick(cell, grid, mesh.elements);
        else
          add_tetrahedra(cell, grid, quadratic, mesh.elements);
  return mesh;
}

Surface skin_of(const Mesh& mesh, std::vector<std::int32_t>& nodes) {
  const std::vector<Face> faces = sorted_faces(mesh, [](std::int32_t) { return true; });
  std::vector<Face> outer;
  for_each_face(faces, [&](std::span<const Face> same) {
    if (same.size() == 1) outer.push_back(same[0]);
  });
  std::sort(outer.begin(), outer.end(), [](const Face& l, const Face& r) {
    return std::tie(l.element, l.side) < std::tie(r.element, r.side);
  });
  Surface skin;
  skin.name = mesh.name;
  for (const Face& face : outer)
    add_triangles(mesh.element(face.element), faces_of(mesh.kind)[static_cast<std::size_t>(face.side)],
                  skin.triangles);

  std::vector<std::int32_t> vertex(mesh.nodes.size(), none);
  for (const Triangle& triangle : skin.triangles)
    for (const std::int32_t node : triangle) vertex[static_cast<std::size_t>(node)] = 0;
  nodes.clear();
  for (std::size_t node = 0; node < vertex.size(); ++node) {
    if (vertex[node] == none) continue;
    vertex[node] = static_cast<std::int32_t>(nodes.size());
    nodes.push_back(static_cast<std::int32_t>(node));
    skin.vertices.push_back(mesh.nodes[node]);
  }
  for (Triangle& triangle : skin.triangles)
    for (std::int32_t& node : triangle) node = vertex[static_cast<std::size_t>(node)];
  return skin;
}

}  // namespace eigengrain::model
