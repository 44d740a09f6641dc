#include "state_changes.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <vector>

namespace eigengrain::io {
namespace {

bool same_place(const model::Plane& first, const model::Plane& second) {
  return first.point == second.point && first.normal == second.normal && first.centre == second.centre;
}

}  // namespace

std::optional<std::string> forbidden_change(const model::Scene& stored, const model::Scene& now) {
  if (now.materials.size() != stored.materials.size())
    return fmt::format(
        "materials: {} entries; the state has {}, and its balls name them by number; "
        "keep their number and their order",
        now.materials.size(), stored.materials.size());
  for (std::size_t k = 0; k < now.materials.size(); ++k)
    if (now.materials[k].density != stored.materials[k].density)
      return fmt::format(
          "materials[{}].density: {} kg/m3; the balls of a state have their masses from "
          "{} kg/m3 and keep them; leave it out, or start from the scene",
          k, now.materials[k].density, stored.materials[k].density);
  for (std::size_t r = 0; r < std::min(now.contacts.size(), stored.contacts.size()); ++r) {
    const auto kind = [&](const model::Scene& scene) {
      const auto& bond = scene.contacts[r].bond;
      return bond ? bond->kind : std::string("none");
    };
    if (kind(now) != kind(stored))
      return fmt::format(
          "contacts[{}].bond: {}; the bonds of a state are those it was started with ({}); "
          "keep the kind, or start from the scene",
          now.contacts[r].entry, kind(now), kind(stored));
  }
  if (now.walls.size() != stored.walls.size())
    return fmt::format(
        "walls: {} planes; the state has {}, and its contacts name them by number; keep "
        "their number and their order",
        now.walls.size(), stored.walls.size());
  const auto triangles = [](const model::Scene& scene) {
    std::vector<std::size_t> counts;
    for (const model::Surface& surface : scene.surfaces) counts.push_back(surface.triangles.size());
    return counts;
  };
  if (triangles(now) != triangles(stored))
    return "walls: other polygons or meshes than those of the state, whose contacts name their triangles by "
           "number; keep them";
  if (now.cell.periodic != stored.cell.periodic)
    return "periodic: other axes than those of the state, whose contacts reach through them";
  return std::nullopt;
}

bool surroundings_moved(const model::Scene& stored, const model::Scene& now) {
  return now.cell.origin != stored.cell.origin || now.cell.edges != stored.cell.edges ||
         !std::equal(now.walls.begin(), now.walls.end(), stored.walls.begin(), stored.walls.end(),
                     same_place) ||
         !std::equal(now.surfaces.begin(), now.surfaces.end(), stored.surfaces.begin(), stored.surfaces.end(),
                     [](const model::Surface& l, const model::Surface& r) {
                       return l.vertices == r.vertices && l.two_sided == r.two_sided && l.centre == r.centre;
                     });
}

bool pairs_may_be_new(const model::Scene& stored, const model::Scene& now) {
  const auto same_rule = [](const model::ContactRule& l, const model::ContactRule& r) {
    return l.first == r.first && l.second == r.second && l.law == r.law;
  };
  const auto same_material = [](const model::Plane& l, const model::Plane& r) {
    return l.material == r.material;
  };
  return !std::equal(now.contacts.begin(), now.contacts.end(), stored.contacts.begin(), stored.contacts.end(),
                     same_rule) ||
         !std::equal(now.walls.begin(), now.walls.end(), stored.walls.begin(), stored.walls.end(),
                     same_material) ||
         !std::equal(
             now.surfaces.begin(), now.surfaces.end(), stored.surfaces.begin(), stored.surfaces.end(),
             [](const model::Surface& l, const model::Surface& r) { return l.material == r.material; });
}

}  // namespace eigengrain::io
