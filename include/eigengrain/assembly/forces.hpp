#pragma once

#include "eigengrain/assembly/model.hpp"

#include <vector>

namespace eigengrain::assembly {

/// Displacement of every body since the committed state. Rotations may be empty: none.
struct Displacement {
  std::vector<Vec3> translation;  ///< [bodies] u, m
  std::vector<Vec3> rotation;     ///< [bodies] θ, rad; or empty
};

/// What the contacts exert on every body: force (N) and moment about its centre (N m).
struct BodyForces {
  std::vector<Vec3> force;
  std::vector<Vec3> moment;
};

/// Contact forces after a trial displacement. Nothing is stored in the contacts: the same call with the same
/// displacement gives the same forces. Summed on each body in the order of its contacts, so that the result
/// does not depend on the number of threads.
BodyForces contact_forces(const Model& model, const Displacement& displacement);

/// Contact forces of the model as it stands.
BodyForces contact_forces(const Model& model);

/// Elastic energy of all contacts after a trial displacement, J.
double elastic_energy(const Model& model, const Displacement& displacement);

}  // namespace eigengrain::assembly
