#pragma once

#include "eigengrain/model/bodies.hpp"

#include "section.hpp"

#include <string_view>

namespace eigengrain::io {

/// A key that names components of motion.
model::FixedComponents read_fixed(const Section& section, std::string_view key = "fix");
/// The key `damping` of balls and clumps; Bodies::scene_damping where they have none of their own.
double read_own_damping(const Section& section);

}  // namespace eigengrain::io
