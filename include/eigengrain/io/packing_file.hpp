#pragma once

#include "eigengrain/base/vec.hpp"

#include <cstdint>
#include <filesystem>
#include <span>
#include <string_view>
#include <vector>

namespace eigengrain::io {

/// Balls of a packing file, one row a ball.
struct Packing {
  std::vector<Vec3> position;      ///< m
  std::vector<double> radius;      ///< m
  std::vector<std::int32_t> line;  ///< of the file, from 1
};

/// Reads a packing file: `x y z r` a line, in m, separated by blanks; # starts a comment. Throws InputError
/// with every mistake found.
Packing read_packing_file(const std::filesystem::path& file);

/// Writes a packing file that read_packing_file takes back to the bit, behind lines of comment. The file
/// appears whole or not at all. Throws InputError where it cannot be written.
///
/// centres  [n] m; radii [n] m
void write_packing_file(std::span<const Vec3> centres, std::span<const double> radii,
                        std::string_view comment, const std::filesystem::path& file);

}  // namespace eigengrain::io
