#pragma once

#include "eigengrain/assembly/state.hpp"

#include <filesystem>
#include <span>

namespace eigengrain::io {

/// Writes the state as an UnstructuredGrid of VTK (.vtu): one vertex cell a ball, in the order of identity.
/// The numbers stand as they are in memory behind the XML ("raw appended"). The memory that it takes beside
/// the state is that of the largest array and 12 bytes a ball. Of a periodic cell the field data have
/// origin and edges (the columns of the matrix, which VTK has row by row). With `stress` there is the mean
/// stress of each.
void write_frame(const std::filesystem::path& file, const assembly::State& state, bool stress);

/// The triangles of all surfaces where they are.
void write_surface_frame(const std::filesystem::path& file, const assembly::Model& model);

/// The elements of all deformable bodies where they are: of nodes displacement from the mesh without stress
/// (m), velocity and identity, of elements Cauchy's stress (Pa), von Mises' and the number of the body, from
/// 0.
void write_solid_frame(const std::filesystem::path& file, const assembly::State& state);

/// Bonds that broke: a point each, where its contact was.
void write_break_frame(const std::filesystem::path& file, std::span<const assembly::BondBreak> breaks);

}  // namespace eigengrain::io
