#pragma once

#include "eigengrain/assembly/moving_walls.hpp"
#include "eigengrain/assembly/state.hpp"

#include <cstddef>

namespace eigengrain::assembly {

/// Moves the wall of a motion, and notes in the step how it moved and where it was in the middle.
///
/// motion  index into Model::wall_motions
/// moved   translation (m) of its centre, and rotation (rad) about it
void step_wall(State& state, std::size_t motion, const contact::SideMotion& moved, WallStep& step);

}  // namespace eigengrain::assembly
