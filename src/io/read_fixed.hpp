#pragma once

#include "eigengrain/model/bodies.hpp"

#include "section.hpp"

namespace eigengrain::io {

/// The key `fix` of balls and clumps.
model::FixedComponents read_fixed(const Section& section);
/// The key `damping` of balls and clumps; Bodies::scene_damping where they have none of their own.
double read_own_damping(const Section& section);

}  // namespace eigengrain::io
