#include "eigengrain/assembly/surroundings.hpp"

#include "eigengrain/assembly/moving_walls.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <span>

namespace eigengrain::assembly {

void set_surroundings(Model& model, const model::Scene& scene) {
  model.walls = scene.walls;
  model.surfaces = scene.surfaces;
  model.cell = scene.cell;
  model.gravity = scene.gravity;
  model.local_damping = scene.local_damping;
  model.lever_cut = scene.full_levers ? contact::to_surface : contact::to_contact_point;
  model.facets = model::facets_of(scene.surfaces);
  model.surface_places.clear();
  model.facet_trees.clear();
  std::size_t first = 0;
  for (const model::Surface& surface : scene.surfaces) {
    model.surface_places.push_back({.start = surface.centre, .pose = {.centre = surface.centre}});
    model.facet_trees.emplace_back(std::span(model.facets.facet).subspan(first, surface.triangles.size()),
                                   static_cast<std::int32_t>(first));
    first += surface.triangles.size();
  }
  model.wall_motions = scene.wall_motions;
  model.wall_poses = start_poses(scene.wall_motions);
  for (const model::WallMotion& motion : scene.wall_motions)
    if (const auto wall = static_cast<std::size_t>(motion.wall); wall >= model.walls.size())
      model.surface_places[wall - model.walls.size()].moved = true;
}

std::vector<std::string> wall_names(const Model& model) {
  std::vector<std::string> names;
  for (const model::Plane& wall : model.walls) names.push_back(wall.name);
  for (const model::Surface& surface : model.surfaces) names.push_back(surface.name);
  return names;
}

std::int32_t find_wall(const Model& model, const std::string& name, const std::string& where) {
  const std::vector<std::string> names = wall_names(model);
  const auto found = std::find(names.begin(), names.end(), name);
  if (found == names.end()) throw InputError(fmt::format("{}: there is no wall \"{}\"", where, name));
  return static_cast<std::int32_t>(found - names.begin());
}

std::vector<Vec3> wall_centres(const Model& model) {
  std::vector<Vec3> centres;
  for (const model::Plane& wall : model.walls) centres.push_back(wall.centre);
  for (const contact::SurfacePlace& place : model.surface_places) centres.push_back(place.pose.centre);
  return centres;
}

InputError centre_on_facet(const Model& model, const contact::CentreOnFacet& found) {
  const model::Facet& facet = model.facets.facet[static_cast<std::size_t>(found.facet)];
  const auto body = static_cast<std::size_t>(found.body);
  const Vec3& x = model.bodies.position[body];
  return InputError(fmt::format(
      "ball {}: its centre ({}, {}, {}) lies on {}, so their contact has no direction; move the ball to the "
      "side that it belongs to",
      model.bodies.identity[body], x[0], x[1], x[2],
      model.surfaces[static_cast<std::size_t>(facet.surface)].name));
}

}  // namespace eigengrain::assembly
