#pragma once

#include "eigengrain/assembly/solid.hpp"
#include "eigengrain/contact/group.hpp"
#include "eigengrain/model/scene.hpp"
#include "eigengrain/search/facet_tree.hpp"

#include <span>
#include <vector>

namespace eigengrain::assembly {

/// A scene brought to life: bodies in storage order, and the contacts that act between them.
struct Model {
  model::Bodies bodies;             ///< along a space-filling curve; identity is the place in the scene
  std::vector<model::Plane> walls;  ///< where they are now
  std::vector<model::Surface>
      surfaces;          ///< walls of triangles, as they start, and then the skins of `solids`
  model::Facets facets;  ///< their triangles, as they start; those of skins as they are
  std::vector<contact::SurfacePlace> surface_places;  ///< [surfaces] where they are now
  std::vector<search::FacetTree> facet_trees;         ///< [surfaces]
  std::vector<model::WallMotion> wall_motions;        ///< of those that move
  std::vector<model::WallPose> wall_poses;            ///< [wall_motions] where these are now
  model::PeriodicCell cell;
  Vec3 gravity = Vec3::Zero();                   ///< m/s²
  double local_damping = 0;                      ///< α
  double lever_cut = contact::to_contact_point;  ///< of the overlap, from the levers of contacts
  contact::Contacts contacts;
  Solids solids;  ///< deformable bodies

  /// Walls of all kinds: planes, then surfaces.
  std::size_t wall_count() const { return walls.size() + surfaces.size(); }
  std::int32_t wall_material(std::int32_t wall) const {
    const auto w = static_cast<std::size_t>(wall);
    return w < walls.size() ? walls[w].material : surfaces[w - walls.size()].material;
  }

  /// The sides of contacts with the bodies where they are, or at trial positions [bodies].
  contact::Placement placement() const { return placement(bodies.position, bodies.orientation); }
  contact::Placement placement(std::span<const Vec3> position, std::span<const Quat> orientation) const {
    return {.position = position,
            .radius = bodies.radius,
            .walls = walls,
            .cell = cell,
            .mass = bodies.mass,
            .facets = &facets,
            .surfaces = surface_places,
            .lever_cut = lever_cut,
            .orientation = orientation};
  }
};

/// Sorts the bodies, finds the contacts at the scene's positions (see list_contacts) and puts them into
/// groups; where they touch, their states are those of contacts that have just formed. Throws InputError
/// where two centres coincide or no rule exists for a pair that touches.
///
/// reach  also pairs that are no more than this apart, m
Model build_model(const model::Scene& scene, double reach = 0.0);

}  // namespace eigengrain::assembly
