#pragma once

#include "eigengrain/base/vec.hpp"

#include <cstdint>
#include <vector>

namespace eigengrain::assembly {

/// A proof of the timestep, and how long it holds: until a body has moved from where it was by more than its
/// room, or the walls by more than theirs. Up to then no pair can touch that it did not count, whoever moves;
/// and the near list holds, too.
struct StepGuard {
  double dt = 0;               ///< proven, s
  std::vector<Vec3> position;  ///< [bodies] where they were, m
  std::vector<double> room;    ///< [bodies] m
  double wall_way = 0;         ///< NeighbourList::wall_way up to which it holds, m
  std::int64_t step = 0;       ///< when it was made
  // What the next proof begins with (cycle/tracked_step.hpp).
  std::vector<double> weight;  ///< [bodies] d
  double gain = 1;             ///< step over the block bound when last proven from scratch
  std::int64_t pause = 0;      ///< proofs until a larger step is tried
  std::int64_t last_pause = 0;
};

}  // namespace eigengrain::assembly
