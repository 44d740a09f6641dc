#pragma once

#include "eigengrain/model/surface.hpp"

#include "diagnostics.hpp"

#include <filesystem>
#include <string>
#include <string_view>

namespace eigengrain::io {

/// Reads the triangles of an STL file (ASCII or binary) or an OBJ file, told apart by their ending; corners
/// with the same coordinates are one vertex. Lengths are multiplied by `unit` (m). Mistakes, also those of
/// the triangulation, are reported under the file's name; a file that is missing or holds nothing at
/// `asked_at`.
model::Surface read_mesh(const std::filesystem::path& file, double unit, bool two_sided,
                         const Place& asked_at, Diagnostics& diagnostics);

/// The same of a file's contents; `name` is for messages and its ending tells the format.
model::Surface parse_mesh(std::string_view contents, const std::string& name, double unit, bool two_sided,
                          const Place& asked_at, Diagnostics& diagnostics);

}  // namespace eigengrain::io
