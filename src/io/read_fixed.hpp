#pragma once

#include "eigengrain/model/bodies.hpp"

#include "section.hpp"

#include <string_view>

namespace eigengrain::io {

/// A key that names components of motion.
model::FixedComponents read_fixed(const Section& section, std::string_view key = "fix");

}  // namespace eigengrain::io
