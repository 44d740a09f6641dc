#pragma once

#include "eigengrain/io/packing_file.hpp"

#include "diagnostics.hpp"

#include <optional>
#include <string>
#include <string_view>
#include <vector>

/// What a file of balls may look like: the one table of formats.
namespace eigengrain::io {

enum class PackingFormat { packing, lammps_data, lammps_dump, yade_text };

/// Reads the text of a file; rows with a mistake are reported under the name and left out.
using PackingParser = Packing (*)(std::string_view text, const std::string& name, Diagnostics& diagnostics);

/// As scene files name them, in the order of the enumeration.
std::vector<std::string> packing_format_names();
std::optional<PackingFormat> find_packing_format(std::string_view name);

/// What the text looks like; `packing` where it looks like nothing else.
PackingFormat recognised_format(std::string_view text);

PackingParser parser_of(PackingFormat format);
/// "a line is x y z r, in m"
std::string_view layout_of(PackingFormat format);

}  // namespace eigengrain::io
