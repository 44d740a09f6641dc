#pragma once

#include "eigengrain/io/packing_file.hpp"

#include "diagnostics.hpp"
#include "packing_format.hpp"

#include <filesystem>
#include <optional>
#include <string>
#include <string_view>

namespace eigengrain::io {

/// Reads the text of a packing file. Rows with a mistake are reported under `name` and left out.
Packing parse_packing(std::string_view text, const std::string& name, Diagnostics& diagnostics);

/// Reads a packing file, of the format given or of the one that its text looks like. `asked_at` is the place
/// that names the file: a file that is missing or cannot be read is that place's mistake.
Packing read_packing_file(const std::filesystem::path& file, const Place& asked_at, Diagnostics& diagnostics,
                          std::optional<PackingFormat> format = std::nullopt);

}  // namespace eigengrain::io
