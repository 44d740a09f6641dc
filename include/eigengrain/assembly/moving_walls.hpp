#pragma once

#include "eigengrain/assembly/model.hpp"

#include <span>
#include <vector>

namespace eigengrain::assembly {

struct State;

/// Where the walls that move are at the start of a scene [motions].
std::vector<model::WallPose> start_poses(std::span<const model::WallMotion> motions);

/// How the walls of a model moved in a step: what contacts with them need beside where they are now. Empty
/// where no wall moves.
struct WallStep {
  explicit WallStep(const Model& model);

  bool any() const { return !side.empty(); }

  /// Moves the walls of the state by a step from its time on, with the velocity given for the middle of the
  /// step, and notes their way in its near list. Cost O(moving walls).
  void move(State& state, double dt);

  std::vector<contact::SideMotion> side;  ///< [walls] translation of the centre and rotation in the step
  std::vector<model::Plane> middle;       ///< [planes] as they were in the middle of it
  std::vector<contact::SurfacePlace> middle_surfaces;  ///< [surfaces]
};

/// Puts the walls of a state where their poses say; planes from their start in `settings.walls`.
void place_walls(State& state);

}  // namespace eigengrain::assembly
