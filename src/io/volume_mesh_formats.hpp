#pragma once

#include "volume_mesh_rows.hpp"

#include <string_view>

/// The formats of volume meshes: each reader hands the rows of a file on as they stand there.
namespace eigengrain::io {

/// Gmsh's own, versions 2.2 and 4.1, as text.
void read_gmsh(std::string_view text, VolumeMeshRows& rows);
/// Input of Abaqus and CalculiX: what *NODE and *ELEMENT say.
void read_abaqus_input(std::string_view text, VolumeMeshRows& rows);
/// An UnstructuredGrid of VTK in XML, as text.
void read_vtu(std::string_view text, VolumeMeshRows& rows);

}  // namespace eigengrain::io
