#pragma once

#include "eigengrain/assembly/model.hpp"

#include <cstdint>

/// Bonds of a model: made once from a scene, then carried along whatever the contact list knows.
namespace eigengrain::assembly {

/// An empty group for the bonds of a rule (`rule.bond` is there): of the first type of the bond table that
/// bears its kind and serves its parameters. Throws InputError where there is none, or where a contact bond
/// is asked of a law that has none.
contact::AnyGroup new_bond_group(const model::ContactRule& rule, std::int32_t index);

/// Whether any bond of the scene asks for the orientations of bodies.
bool needs_orientation(const model::Scene& scene);

/// Makes the bonds of a scene: between all balls, images included, whose rule has bonds and whose surfaces
/// are no more than its gap apart. The contacts of the model have been listed, and none is bonded.
void make_bonds(Model& model, const model::Scene& scene);

/// Adds the bonds of `before` that hold and have a group of their own, at whatever distance, to the contacts
/// of the model. Both are sorted.
void carry_bonds(const contact::Contacts& before, Model& model);

/// How many bonds hold, of all kinds.
std::int64_t count_bonds(const Model& model);

}  // namespace eigengrain::assembly
