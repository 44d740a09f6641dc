#pragma once

#include "eigengrain/assembly/model.hpp"
#include "eigengrain/model/surroundings.hpp"

#include <cstdint>
#include <span>
#include <vector>

namespace eigengrain::measures {

/// What measures ask of a contact.
struct ActingContact {
  static constexpr std::int32_t wall = -1;

  std::int32_t a = 0;  ///< row of the first body; of a clump its holder
  std::int32_t b = 0;  ///< row of the second one, or wall
  Vec3 branch;  ///< ℓ: from the centre of a (model::centre_of) to that of b's image; at a wall, to the
                ///< contact point, m
  Vec3 normal;  ///< n, from a to b
  std::int32_t ball_a = 0;   ///< row of the first ball itself
  std::int32_t ball_b = -1;  ///< row of the second one; the number of the wall, where it is one
  model::Image image{};      ///< of the second side
  double overlap = 0;        ///< U, m
  Vec3 point;                ///< where it is: x_C, m
  std::int32_t rule = 0;     ///< index into Scene::contacts
  Vec3 force;                ///< F, of a on b, N
  bool slides = false;
  bool carries_moments = false;  ///< a bond that holds all six components, alone
};

/// The contacts that act, in the order of the groups. Whether one slides is asked of its law: more relative
/// displacement in the direction of the shear force does not (by half) raise the force as k_s would. A bond
/// beside a contact that acts adds its force to it; one over a gap is a contact of its own, at the end.
std::vector<ActingContact> acting_contacts(const assembly::Model& model);

/// The least number of contacts that can hold a body: 2 where some contact has shear stiffness (Thornton,
/// Géotechnique 50:43, 2000); without, 4 in three dimensions, or 3 and the body's weight; where all bodies
/// keep to a plane, one less.
std::int32_t least_contacts(const assembly::Model& model);

/// [bodies] Whether a body is a rattler; the balls of a clump as their holder: it has less than `least`
/// contacts with walls and with bodies that are no rattlers themselves, a bond that carries moments counting
/// for all of them. What may not translate is held and no rattler. Cost O(bodies + contacts).
std::vector<bool> rattlers(const assembly::Model& model, std::span<const ActingContact> contacts,
                           std::int32_t least);

}  // namespace eigengrain::measures
