#pragma once

#include "eigengrain/assembly/cell_motion.hpp"
#include "eigengrain/assembly/state.hpp"

#include "kick.hpp"

namespace eigengrain::cycle {

/// Kick of all clumps for a duration by the forces of their balls, and drift for dt (s): velocity and angular
/// momentum, then centre and orientation, then the places of the balls, whose velocity and spin become the
/// exact displacement and rotation of the step over dt. Forces are summed ball by ball, in the order of the
/// scene. Cell: assembly::CellAtRest or CellStep; Work: NoWork, or KickWork where there is a ledger, which
/// gets its part. Cost O(balls of clumps).
template <class Work, class Cell>
void move_clumps(assembly::State& state, double duration, double dt, const Cell& cell);

}  // namespace eigengrain::cycle
