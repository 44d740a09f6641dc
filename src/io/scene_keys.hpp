#pragma once

#include "eigengrain/io/schema.hpp"

#include <string>
#include <vector>

/// The table of keys (docs/scene-schema.md) by what they are about. The description says what the reader does
/// with the value.
namespace eigengrain::io {

inline constexpr Range positive_range{.low = 0, .low_allowed = false};

/// Gravity, materials and the laws between them, but the parameters of the laws and bonds.
std::vector<KeyDescription> contact_keys();

/// Balls, from files, one by one or made.
std::vector<KeyDescription> ball_keys();

/// Rigid bodies of several balls.
std::vector<KeyDescription> clump_keys();

/// Walls and the periodic cell.
std::vector<KeyDescription> wall_keys();

/// Bodies of finite elements.
std::vector<KeyDescription> deformable_keys();

/// How the scene moves, and for how long.
std::vector<KeyDescription> run_keys();

/// What is measured and written.
std::vector<KeyDescription> output_keys();

/// Groups of balls, and stages.
std::vector<KeyDescription> stage_keys();

/// The shapes of a region, in a section.
std::vector<KeyDescription> region_keys(const std::string& section, const std::string& box);

/// When a run ends, in a section; its numbers count since the start of `since`.
std::vector<KeyDescription> end_of_run_keys(const std::string& section, const std::string& since);

}  // namespace eigengrain::io
