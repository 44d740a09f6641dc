#include "eigengrain/assembly/model.hpp"

#include "eigengrain/assembly/contact_list.hpp"
#include "eigengrain/assembly/moving_walls.hpp"

namespace eigengrain::assembly {

Model build_model(const model::Scene& scene, double reach) {
  Model model{.bodies = scene.bodies,
              .walls = scene.walls,
              .wall_motions = scene.wall_motions,
              .wall_poses = start_poses(scene.wall_motions),
              .cell = scene.cell,
              .gravity = scene.gravity,
              .local_damping = scene.local_damping,
              .contacts = {}};
  model::sort_along_curve(model.bodies);
  list_contacts(model, scene, reach, NewContacts::formed);
  return model;
}

}  // namespace eigengrain::assembly
