#pragma once

#include "ball_list.hpp"
#include "scene_draft.hpp"
#include "section.hpp"

namespace eigengrain::io {

/// Entries of `balls` that say how balls are made. Each adds them to the list, or reports why it cannot.
void read_lattice(const Section& section, const BallKind& kind, const SceneDraft& draft, BallList& balls);
/// Also notes in the scene what the packing is like.
void read_fill(const Section& section, const BallKind& kind, SceneDraft& draft, BallList& balls);

}  // namespace eigengrain::io
