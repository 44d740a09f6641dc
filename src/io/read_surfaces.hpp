#pragma once

#include "eigengrain/model/surface.hpp"

#include "section.hpp"

#include <filesystem>
#include <optional>

namespace eigengrain::io {

/// Reads the section `polygon` of a wall; nothing after a report. Name, material and centre are left open.
std::optional<model::Surface> read_polygon(const Section& polygon);

/// Reads the section `mesh` of a wall and the file that it names, relative to `folder`.
std::optional<model::Surface> read_mesh_section(const Section& mesh, const std::filesystem::path& folder);

/// Sum of the areas of the triangles along their normals, m².
Vec3 area_vector(const model::Surface& surface);

/// The mean of the vertices, m.
Vec3 middle_of(const model::Surface& surface);

}  // namespace eigengrain::io
