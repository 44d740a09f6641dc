#pragma once

#include "eigengrain/contact/group.hpp"
#include "eigengrain/model/scene.hpp"

#include <span>
#include <vector>

namespace eigengrain::assembly {

/// A scene brought to life: bodies in storage order, and the contacts that act between them.
struct Model {
  model::Bodies bodies;  ///< along a space-filling curve; identity is the place in the scene
  std::vector<model::Plane> walls;
  model::PeriodicCell cell;
  Vec3 gravity = Vec3::Zero();  ///< m/s²
  double local_damping = 0;     ///< α
  contact::Contacts contacts;

  /// The sides of contacts with the bodies where they are, or at trial positions [bodies].
  contact::Placement placement() const { return placement(bodies.position, bodies.orientation); }
  contact::Placement placement(std::span<const Vec3> position, std::span<const Quat> orientation) const {
    return {position, bodies.radius, walls, cell, orientation};
  }
};

/// Sorts the bodies, finds the contacts at the scene's positions (see list_contacts) and puts them into
/// groups; where they touch, their states are those of contacts that have just formed. Throws InputError
/// where two centres coincide or no rule exists for a pair that touches.
///
/// reach  also pairs that are no more than this apart, m
Model build_model(const model::Scene& scene, double reach = 0.0);

}  // namespace eigengrain::assembly
