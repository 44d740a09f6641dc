#pragma once

#include "parsed.hpp"

#include <filesystem>
#include <string>
#include <string_view>

namespace eigengrain::io {

/// The whole file, or a problem that says which path was looked for and which file there has a similar name.
Parsed<std::string> read_text_file(const std::filesystem::path& file);

/// What to say of a file that is not there.
std::string missing_file(const std::filesystem::path& file);

/// Whether a file's name ends so; `ending` is in small letters, the name in any.
bool has_ending(std::string_view name, std::string_view ending);

}  // namespace eigengrain::io
