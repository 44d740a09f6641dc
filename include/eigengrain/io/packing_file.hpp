#pragma once

#include "eigengrain/base/vec.hpp"

#include <cstdint>
#include <filesystem>
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

}  // namespace eigengrain::io
