#include "eigengrain/assembly/moving_walls.hpp"

#include "eigengrain/assembly/state.hpp"

#include <algorithm>

namespace eigengrain::assembly {

std::vector<model::WallPose> start_poses(std::span<const model::WallMotion> motions) {
  std::vector<model::WallPose> poses;
  for (const model::WallMotion& motion : motions) poses.push_back({.centre = motion.start});
  return poses;
}

WallStep::WallStep(const Model& model) {
  if (model.wall_motions.empty()) return;
  side.resize(model.walls.size());
  middle = model.walls;
}

void WallStep::move(State& state, double dt) {
  Model& model = state.model;
  double farthest = 0;
  for (std::size_t m = 0; m < model.wall_motions.size(); ++m) {
    const model::WallMotion& motion = model.wall_motions[m];
    model::WallPose& pose = model.wall_poses[m];
    const auto w = static_cast<std::size_t>(motion.wall);
    const model::WallVelocity velocity = motion.at(state.time + 0.5 * dt);
    side[w] = {dt * velocity.translation, dt * velocity.spin};
    model::carry(state.settings.walls[w], motion,
                 pose.moved(0.5 * side[w].translation, 0.5 * side[w].rotation), middle[w]);
    pose = pose.moved(side[w].translation, side[w].rotation);
    model::carry(state.settings.walls[w], motion, pose, model.walls[w]);
    farthest =
        std::max(farthest, side[w].translation.norm() + side[w].rotation.norm() * state.list.wall_lever[m]);
  }
  state.list.wall_way += farthest;
}

void place_walls(State& state) {
  Model& model = state.model;
  for (std::size_t m = 0; m < model.wall_motions.size(); ++m) {
    const auto w = static_cast<std::size_t>(model.wall_motions[m].wall);
    model::carry(state.settings.walls[w], model.wall_motions[m], model.wall_poses[m], model.walls[w]);
  }
}

}  // namespace eigengrain::assembly
