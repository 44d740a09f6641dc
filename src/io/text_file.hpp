#pragma once

#include "parsed.hpp"

#include <filesystem>
#include <string>

namespace eigengrain::io {

/// The whole file, or a problem that says which path was looked for and which file there has a similar name.
Parsed<std::string> read_text_file(const std::filesystem::path& file);

/// What to say of a file that is not there.
std::string missing_file(const std::filesystem::path& file);

}  // namespace eigengrain::io
