#pragma once

#include "eigengrain/generate/sizes.hpp"

#include "section.hpp"

#include <optional>

namespace eigengrain::io {

/// The radii of an entry of `balls`: its `radius`, or its `sizes`. Nothing, after a report, where neither can
/// be read.
std::optional<generate::SizeDistribution> read_sizes(const Section& entry);

}  // namespace eigengrain::io
