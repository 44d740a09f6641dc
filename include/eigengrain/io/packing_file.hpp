#pragma once

#include "eigengrain/base/vec.hpp"
#include "eigengrain/io/diagnostics.hpp"

#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

namespace eigengrain::io {

/// Balls of a packing file, one row a ball.
struct Packing {
  std::vector<Vec3> position;      ///< m
  std::vector<double> radius;      ///< m
  std::vector<std::int32_t> line;  ///< of the file, from 1
};

/// Reads the text of a packing file: `x y z r` a line, in m, separated by blanks; # starts a comment. Rows
/// with a mistake are reported under `name` and left out.
Packing parse_packing(std::string_view text, const std::string& name, Diagnostics& diagnostics);

/// Reads a packing file. `asked_at` is the place that names the file: a file that is missing or cannot be
/// read is that place's mistake.
Packing read_packing_file(const std::filesystem::path& file, const Place& asked_at, Diagnostics& diagnostics);

/// The whole file, or a problem that says which path was looked for and which file there has a similar name.
struct FileText {
  std::string text;
  std::string problem;  ///< empty: none
};
FileText read_text_file(const std::filesystem::path& file);

}  // namespace eigengrain::io
