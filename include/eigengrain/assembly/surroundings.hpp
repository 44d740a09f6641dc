#pragma once

#include "eigengrain/assembly/model.hpp"
#include "eigengrain/base/error.hpp"
#include "eigengrain/contact/facet_choice.hpp"
#include "eigengrain/model/scene.hpp"

#include <cstdint>
#include <string>
#include <vector>

namespace eigengrain::assembly {

/// Walls, surfaces, cell, gravity and damping of a model as its scene has them at the start.
void set_surroundings(Model& model, const model::Scene& scene);

/// Names of all walls: planes, then surfaces.
std::vector<std::string> wall_names(const Model& model);

/// The number of the wall of a name. Throws InputError, beginning with `where`, if there is none.
std::int32_t find_wall(const Model& model, const std::string& name, const std::string& where);

/// Where the centres of all walls are, m.
std::vector<Vec3> wall_centres(const Model& model);

/// What to tell the user of a ball whose centre lies on a facet.
InputError centre_on_facet(const Model& model, const contact::CentreOnFacet& found);

}  // namespace eigengrain::assembly
