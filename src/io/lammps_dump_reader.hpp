#pragma once

#include "eigengrain/io/packing_file.hpp"

#include "diagnostics.hpp"

#include <string>
#include <string_view>

namespace eigengrain::io {

/// Reads the last frame of what LAMMPS writes by dump custom (or atom, with radii added): columns x, xu, xs
/// or xsu of each axis, and radius or diameter; balls in the order of their ids where there are any. Lengths
/// count as m: units other than si and lj are a mistake where the file tells them.
Packing parse_lammps_dump(std::string_view text, const std::string& name, Diagnostics& diagnostics);

}  // namespace eigengrain::io
