#pragma once

#include "eigengrain/model/bodies.hpp"

#include "section.hpp"

namespace eigengrain::io {

/// The key `fix` of balls and clumps.
model::FixedComponents read_fixed(const Section& section);

}  // namespace eigengrain::io
