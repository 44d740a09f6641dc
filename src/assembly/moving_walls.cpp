#include "eigengrain/assembly/moving_walls.hpp"

#include "eigengrain/assembly/servo.hpp"
#include "eigengrain/assembly/state.hpp"
#include "eigengrain/assembly/step_wall.hpp"

#include <algorithm>

namespace eigengrain::assembly {

std::vector<model::WallPose> start_poses(std::span<const model::WallMotion> motions) {
  std::vector<model::WallPose> poses;
  for (const model::WallMotion& motion : motions) poses.push_back({.centre = motion.start});
  return poses;
}

WallStep::WallStep(const Model& model) {
  if (model.wall_motions.empty()) return;
  side.resize(model.wall_count());
  middle = model.walls;
  middle_surfaces = model.surface_places;
}

namespace {

/// Puts the wall of a motion where the pose says, among the given planes and surfaces.
void carry(const State& state, const model::WallMotion& motion, const model::WallPose& pose,
           std::vector<model::Plane>& planes, std::vector<contact::SurfacePlace>& surfaces) {
  const auto w = static_cast<std::size_t>(motion.wall);
  if (w < planes.size()) {
    model::carry(state.settings.walls[w], motion, pose, planes[w]);
  } else {
    surfaces[w - planes.size()].pose = pose;
    surfaces[w - planes.size()].moved = true;
  }
}

}  // namespace

void step_wall(State& state, std::size_t motion, const contact::SideMotion& moved, WallStep& step) {
  const model::WallMotion& of_wall = state.model.wall_motions[motion];
  model::WallPose& pose = state.model.wall_poses[motion];
  carry(state, of_wall, pose.moved(0.5 * moved.translation, 0.5 * moved.rotation), step.middle,
        step.middle_surfaces);
  pose = pose.moved(moved.translation, moved.rotation);
  carry(state, of_wall, pose, state.model.walls, state.model.surface_places);
  step.side[static_cast<std::size_t>(of_wall.wall)] = moved;
}

void WallStep::move(State& state, double dt) {
  Model& model = state.model;
  const std::vector<double> speeds = servo_speeds(model, dt);
  double farthest = 0;
  for (std::size_t m = 0; m < model.wall_motions.size(); ++m) {
    const model::WallMotion& motion = model.wall_motions[m];
    model::WallVelocity velocity = motion.at(state.time + 0.5 * dt);
    if (motion.servo) velocity.translation += speeds[m] * motion.servo->direction;
    const contact::SideMotion moved{dt * velocity.translation, dt * velocity.spin};
    step_wall(state, m, moved, *this);
    farthest =
        std::max(farthest, moved.translation.norm() + moved.rotation.norm() * state.list.wall_lever[m]);
  }
  state.list.wall_way += farthest;
}

void place_walls(State& state) {
  Model& model = state.model;
  for (std::size_t m = 0; m < model.wall_motions.size(); ++m)
    carry(state, model.wall_motions[m], model.wall_poses[m], model.walls, model.surface_places);
}

}  // namespace eigengrain::assembly
