#include "eigengrain/assembly/model.hpp"

#include "eigengrain/assembly/contact_list.hpp"
#include "eigengrain/assembly/surroundings.hpp"

namespace eigengrain::assembly {

Model build_model(const model::Scene& scene, double reach) {
  Model model;
  model.bodies = scene.bodies;
  set_surroundings(model, scene);
  model::sort_along_curve(model.bodies);
  list_contacts(model, scene, reach, NewContacts::formed);
  return model;
}

}  // namespace eigengrain::assembly
