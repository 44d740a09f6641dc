#pragma once

#include "eigengrain/assembly/state.hpp"

#include <filesystem>
#include <span>
#include <string>

/// State files: all of a state, to the bit, in HDF5 (docs/state-file.md). HDF5 is not safe for threads: one
/// call at a time.
namespace eigengrain::io {

/// Writes the state. The file appears whole or not at all: until then, and on any failure, what was there
/// before stays. Takes as much memory as the file gets bytes. Throws InputError where the file cannot be made
/// or kept, and SolverError with HDF5's own description where it fails.
void write_state(const assembly::State& state, const std::filesystem::path& file);

/// Reads a state. `overrides` act on its settings as they do on a scene (scene_reader.hpp); laws take their
/// parameters from there. They may not name balls, nor change what the stored numbers rest upon: the
/// materials' number and densities, the laws of stored contacts, the number of walls, the periodic axes.
/// With walls or a cell that they moved, contacts are listed anew.
///
/// Throws InputError for anything but an undamaged state file of this schema, and for mistakes in overrides.
assembly::State read_state(const std::filesystem::path& file, std::span<const std::string> overrides = {});

/// Whether the file begins with the signature of HDF5, as states do and scenes do not; false if it cannot be
/// read.
bool is_state_file(const std::filesystem::path& file);

}  // namespace eigengrain::io
