#include "read_surfaces.hpp"

#include "mesh_reader.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <string>
#include <vector>

namespace eigengrain::io {
namespace {

/// Of a polygon's size: how far a corner may lie out of its plane, or must stick out of the line of its
/// neighbours.
constexpr double flatness = 1e-9;

Vec3 mean(const std::vector<Vec3>& points) {
  Vec3 sum = Vec3::Zero();
  for (const Vec3& x : points) sum += x;
  return sum / static_cast<double>(points.size());
}

/// The sum of the cross products of all corners with the next (Newell): normal to the plane that fits them.
Vec3 newell_normal(const std::vector<Vec3>& corners, const Vec3& middle) {
  Vec3 sum = Vec3::Zero();
  for (std::size_t k = 0; k < corners.size(); ++k)
    sum += (corners[k] - middle).cross(corners[(k + 1) % corners.size()] - middle);
  return sum;
}

/// What is wrong with the corners; empty if they make a convex polygon.
std::string problem_of(const std::vector<Vec3>& corners) {
  if (corners.size() < 3)
    return fmt::format("{} corners; a polygon has three at least, e.g. [[0, 0, 0], [1, 0, 0], [0, 1, 0]]",
                       corners.size());
  const Vec3 middle = mean(corners);
  double size = 0;
  for (const Vec3& x : corners) size = std::max(size, (x - middle).norm());
  const Vec3 sum = newell_normal(corners, middle);
  if (!(sum.norm() > flatness * size * size)) return "the corners lie on a line, or at one point";
  const Vec3 normal = sum.normalized();
  for (std::size_t k = 0; k < corners.size(); ++k) {
    const double height = normal.dot(corners[k] - middle);
    if (std::abs(height) > flatness * size)
      return fmt::format("corner {} lies {:.3g} m out of the plane of the others; move it, or give a mesh", k,
                         std::abs(height));
  }
  double turned = 0;
  for (std::size_t k = 0; k < corners.size(); ++k) {
    const Vec3& x = corners[(k + 1) % corners.size()];
    const Vec3 in = x - corners[k];
    const Vec3 out = corners[(k + 2) % corners.size()] - x;
    const double sine = normal.dot(in.cross(out));
    if (!(sine > flatness * in.norm() * out.norm()))
      return fmt::format("not convex at corner {}; leave out corners on a line, or split the polygon",
                         (k + 1) % corners.size());
    turned += std::atan2(sine, in.dot(out));
  }
  constexpr double once_and_a_half = 9.42;
  if (turned > once_and_a_half) return "its edges cross; give the corners in their order around it";
  return {};
}

}  // namespace

std::optional<model::Surface> read_polygon(const Section& polygon) {
  polygon.check_keys();
  const auto corners = polygon.vectors("corners");
  const auto two_sided = polygon.flag("two_sided");
  if (!corners || !two_sided) return std::nullopt;
  if (const std::string problem = problem_of(*corners); !problem.empty()) {
    polygon.report("corners", problem);
    return std::nullopt;
  }
  model::Surface surface;
  surface.vertices = *corners;
  surface.two_sided = *two_sided;
  for (std::size_t k = 2; k < corners->size(); ++k)
    surface.triangles.push_back({0, static_cast<std::int32_t>(k) - 1, static_cast<std::int32_t>(k)});
  return surface;
}

std::optional<model::Surface> read_mesh_section(const Section& mesh, const std::filesystem::path& folder) {
  static const std::map<std::string, double> units{{"m", 1}, {"cm", 1e-2}, {"mm", 1e-3}, {"um", 1e-6}};
  mesh.check_keys();
  const auto name = mesh.text("file");
  const auto unit = mesh.text("unit");
  const auto two_sided = mesh.flag("two_sided");
  if (!name || !unit || !two_sided) return std::nullopt;
  const std::filesystem::path file = (folder / *name).lexically_normal();
  model::Surface surface =
      read_mesh(file, units.at(*unit), *two_sided, mesh.place("file"), mesh.diagnostics());
  if (surface.triangles.empty()) return std::nullopt;
  return surface;
}

Vec3 area_vector(const model::Surface& surface) {
  Vec3 sum = Vec3::Zero();
  for (const auto& [a, b, c] : surface.triangles) {
    const Vec3& first = surface.vertices[static_cast<std::size_t>(a)];
    sum += 0.5 * (surface.vertices[static_cast<std::size_t>(b)] - first)
                     .cross(surface.vertices[static_cast<std::size_t>(c)] - first);
  }
  return sum;
}

Vec3 middle_of(const model::Surface& surface) {
  return mean(surface.vertices);
}

}  // namespace eigengrain::io
