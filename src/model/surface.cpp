#include "eigengrain/model/surface.hpp"

#include <algorithm>
#include <cmath>
#include <tuple>
#include <utility>

namespace eigengrain::model {
namespace {

constexpr double flattest = 1e-9;  // height over longest edge

/// An edge of a triangle, with its ends in increasing order.
struct Edge {
  std::int32_t low = 0;
  std::int32_t high = 0;
  std::int32_t triangle = 0;
  std::int32_t side = 0;  ///< from corner `side` to the next
  bool forward = true;    ///< runs from low to high

  bool same_ends(const Edge& other) const { return low == other.low && high == other.high; }
};

/// All edges, those with the same ends together, and there by triangle.
std::vector<Edge> sorted_edges(std::span<const Triangle> triangles) {
  std::vector<Edge> edges;
  edges.reserve(3 * triangles.size());
  for (std::size_t t = 0; t < triangles.size(); ++t)
    for (std::size_t k = 0; k < 3; ++k) {
      const std::int32_t from = triangles[t][k];
      const std::int32_t to = triangles[t][(k + 1) % 3];
      edges.push_back({std::min(from, to), std::max(from, to), static_cast<std::int32_t>(t),
                       static_cast<std::int32_t>(k), from < to});
    }
  std::sort(edges.begin(), edges.end(), [](const Edge& l, const Edge& r) {
    return std::tie(l.low, l.high, l.triangle, l.side) < std::tie(r.low, r.high, r.triangle, r.side);
  });
  return edges;
}

/// Calls visit(span) for the edges of each pair of ends.
template <class Visit>
void for_each_edge(const std::vector<Edge>& edges, const Visit& visit) {
  for (std::size_t begin = 0; begin < edges.size();) {
    std::size_t end = begin + 1;
    while (end < edges.size() && edges[end].same_ends(edges[begin])) ++end;
    visit(std::span(edges).subspan(begin, end - begin));
    begin = end;
  }
}

bool is_degenerate(const Vec3& a, const Vec3& b, const Vec3& c) {
  const double longest =
      std::sqrt(std::max({(b - a).squaredNorm(), (c - b).squaredNorm(), (a - c).squaredNorm()}));
  return !((b - a).cross(c - a).norm() > flattest * longest * longest);
}

/// The angle at a between b and c.
double angle_at(const Vec3& a, const Vec3& b, const Vec3& c) {
  return std::atan2((b - a).cross(c - a).norm(), (b - a).dot(c - a));
}

}  // namespace

std::vector<SurfaceProblem> problems_of(const Surface& surface) {
  using Kind = SurfaceProblem::Kind;
  const auto at = [&](std::int32_t vertex) -> const Vec3& {
    return surface.vertices[static_cast<std::size_t>(vertex)];
  };
  std::vector<SurfaceProblem> problems;
  for (std::size_t t = 0; t < surface.triangles.size(); ++t) {
    const auto& [a, b, c] = surface.triangles[t];
    const auto index = static_cast<std::int32_t>(t);
    if (is_degenerate(at(a), at(b), at(c)))
      problems.push_back({Kind::degenerate, index, index, (at(a) + at(b) + at(c)) / 3});
  }
  for_each_edge(sorted_edges(surface.triangles), [&](std::span<const Edge> same) {
    if (same.size() < 2) return;
    const Vec3 middle = 0.5 * (at(same[0].low) + at(same[0].high));
    if (same.size() > 2)
      problems.push_back({Kind::branching, same[0].triangle, same[1].triangle, middle});
    else if (same[0].forward == same[1].forward && same[0].triangle != same[1].triangle)
      problems.push_back({Kind::inconsistent, same[0].triangle, same[1].triangle, middle});
  });
  std::stable_sort(problems.begin(), problems.end(),
                   [](const auto& l, const auto& r) { return l.first < r.first; });
  return problems;
}

bool orient(Surface& surface) {
  const std::size_t count = surface.triangles.size();
  struct Link {
    std::int32_t to;
    bool opposite;
  };
  std::vector<std::vector<Link>> links(count);
  for_each_edge(sorted_edges(surface.triangles), [&](std::span<const Edge> same) {
    if (same.size() != 2) return;
    const bool opposite = same[0].forward == same[1].forward;
    links[static_cast<std::size_t>(same[0].triangle)].push_back({same[1].triangle, opposite});
    links[static_cast<std::size_t>(same[1].triangle)].push_back({same[0].triangle, opposite});
  });
  enum class Way : std::uint8_t { open, kept, turned };
  std::vector<Way> way(count, Way::open);
  std::vector<std::int32_t> waiting;
  for (std::size_t start = 0; start < count; ++start) {
    if (way[start] != Way::open) continue;
    way[start] = Way::kept;
    waiting.push_back(static_cast<std::int32_t>(start));
    while (!waiting.empty()) {
      const auto t = static_cast<std::size_t>(waiting.back());
      waiting.pop_back();
      for (const Link& link : links[t]) {
        const Way wanted = (way[t] == Way::turned) != link.opposite ? Way::turned : Way::kept;
        Way& found = way[static_cast<std::size_t>(link.to)];
        if (found == Way::open) {
          found = wanted;
          waiting.push_back(link.to);
        } else if (found != wanted) {
          return false;
        }
      }
    }
  }
  for (std::size_t t = 0; t < count; ++t)
    if (way[t] == Way::turned) std::swap(surface.triangles[t][1], surface.triangles[t][2]);
  return true;
}

Facets facets_of(std::span<const Surface> surfaces) {
  Facets result;
  for (std::size_t s = 0; s < surfaces.size(); ++s) {
    const Surface& surface = surfaces[s];
    const auto first_facet = result.facet.size();
    const auto first_vertex = static_cast<std::int32_t>(result.vertex_normal.size());
    result.two_sided.push_back(surface.two_sided ? 1 : 0);
    result.vertex_normal.resize(result.vertex_normal.size() + surface.vertices.size(), Vec3::Zero());
    for (const Triangle& triangle : surface.triangles) {
      Facet facet;
      for (std::size_t k = 0; k < 3; ++k) {
        facet.corner[k] = surface.vertices[static_cast<std::size_t>(triangle[k])];
        facet.vertex[k] = first_vertex + triangle[k];
      }
      const auto& [a, b, c] = facet.corner;
      facet.normal = (b - a).cross(c - a).normalized();
      facet.edge_normal.fill(facet.normal);
      facet.surface = static_cast<std::int32_t>(s);
      for (std::size_t k = 0; k < 3; ++k)
        result.vertex_normal[static_cast<std::size_t>(facet.vertex[k])] +=
            angle_at(facet.corner[k], facet.corner[(k + 1) % 3], facet.corner[(k + 2) % 3]) * facet.normal;
      result.facet.push_back(facet);
    }
    for_each_edge(sorted_edges(surface.triangles), [&](std::span<const Edge> same) {
      if (same.size() != 2) return;
      Facet& one = result.facet[first_facet + static_cast<std::size_t>(same[0].triangle)];
      Facet& two = result.facet[first_facet + static_cast<std::size_t>(same[1].triangle)];
      const Vec3 sum = one.normal + two.normal;
      one.edge_normal[static_cast<std::size_t>(same[0].side)] = sum;
      two.edge_normal[static_cast<std::size_t>(same[1].side)] = sum;
    });
  }
  return result;
}

std::vector<std::array<std::int32_t, 3>> neighbours_of(const Surface& surface) {
  std::vector<std::array<std::int32_t, 3>> result(surface.triangles.size(), {-1, -1, -1});
  for_each_edge(sorted_edges(surface.triangles), [&](std::span<const Edge> same) {
    if (same.size() != 2) return;
    for (std::size_t k = 0; k < 2; ++k)
      result[static_cast<std::size_t>(same[k].triangle)][static_cast<std::size_t>(same[k].side)] =
          same[1 - k].triangle;
  });
  return result;
}

void place_facets(Facets& facets, std::int32_t facet, std::int32_t vertex,
                  std::span<const std::array<std::int32_t, 3>> neighbours, std::span<const Vec3> place) {
  const auto of_surface = std::span(facets.facet).subspan(static_cast<std::size_t>(facet), neighbours.size());
  const auto vertex_normal =
      std::span(facets.vertex_normal).subspan(static_cast<std::size_t>(vertex), place.size());
  std::fill(vertex_normal.begin(), vertex_normal.end(), Vec3::Zero());
  for (Facet& f : of_surface) {
    for (std::size_t k = 0; k < 3; ++k) f.corner[k] = place[static_cast<std::size_t>(f.vertex[k] - vertex)];
    const auto& [a, b, c] = f.corner;
    f.normal = (b - a).cross(c - a).normalized();
    for (std::size_t k = 0; k < 3; ++k)
      vertex_normal[static_cast<std::size_t>(f.vertex[k] - vertex)] +=
          angle_at(f.corner[k], f.corner[(k + 1) % 3], f.corner[(k + 2) % 3]) * f.normal;
  }
  for (std::size_t t = 0; t < neighbours.size(); ++t)
    for (std::size_t k = 0; k < 3; ++k) {
      Facet& f = of_surface[t];
      const std::int32_t other = neighbours[t][k];
      // In the order of the triangles, so that both see the same sum to the bit.
      f.edge_normal[k] = other < 0 ? f.normal
                         : other < static_cast<std::int32_t>(t)
                             ? Vec3(of_surface[static_cast<std::size_t>(other)].normal + f.normal)
                             : Vec3(f.normal + of_surface[static_cast<std::size_t>(other)].normal);
    }
}

}  // namespace eigengrain::model
