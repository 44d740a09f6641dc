#pragma once

#include <filesystem>
#include <span>
#include <string>

/// A seal is the last 20 bytes of a state file: "EGR-SEAL", the number of bytes before it, and the CRC-32 of
/// all bytes before the checksum itself (docs/state-file.md). HDF5 ignores what stands behind its own end.
/// It guards HDF5's own structures too, so that the library, which does not withstand all damage, only ever
/// reads a file that is whole.
namespace eigengrain::io {

enum class Seal { intact, broken, missing };

/// The seal for a file with these bytes.
std::string seal_of(std::span<const char> bytes);

/// Throws std::system_error if the file cannot be read.
Seal check_seal(const std::filesystem::path& file);

}  // namespace eigengrain::io
