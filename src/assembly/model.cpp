#include "eigengrain/assembly/model.hpp"

#include "eigengrain/assembly/bonds.hpp"
#include "eigengrain/assembly/contact_list.hpp"
#include "eigengrain/assembly/surroundings.hpp"

namespace eigengrain::assembly {

Model build_model(const model::Scene& scene, double reach) {
  Model model;
  model.bodies = scene.bodies;
  set_surroundings(model, scene);
  if (needs_orientation(scene))
    model.bodies.orientation.assign(model.bodies.position.size(), Quat::Identity());
  model::sort_along_curve(model.bodies);
  set_solids(model, scene.deformables);
  list_contacts(model, scene, reach, NewContacts::formed);
  make_bonds(model, scene);
  return model;
}

}  // namespace eigengrain::assembly
