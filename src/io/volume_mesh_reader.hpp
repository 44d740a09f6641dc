#pragma once

#include "eigengrain/model/mesh.hpp"

#include "diagnostics.hpp"

#include <filesystem>
#include <string>
#include <string_view>

namespace eigengrain::io {

/// Reads the tetrahedra or bricks of a file of Gmsh (.msh, versions 2.2 and 4.1), of Abaqus or CalculiX
/// (.inp) or of VTK (.vtu), all as text, told apart by their ending; elements that are no volumes and nodes
/// that belong to none are left out. Lengths are multiplied by `unit` (m). Mistakes, also those of the mesh,
/// are reported under the file's name; a file that is missing or holds nothing at `asked_at`. A mesh with
/// mistakes is empty.
model::Mesh read_volume_mesh(const std::filesystem::path& file, double unit, const Place& asked_at,
                             Diagnostics& diagnostics);

/// The same of a file's contents; `name` is for messages and its ending tells the format.
model::Mesh parse_volume_mesh(std::string_view contents, const std::string& name, double unit,
                              const Place& asked_at, Diagnostics& diagnostics);

}  // namespace eigengrain::io
