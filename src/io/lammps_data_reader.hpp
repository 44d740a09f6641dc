#pragma once

#include "eigengrain/io/packing_file.hpp"

#include "diagnostics.hpp"

#include <string>
#include <string_view>

namespace eigengrain::io {

/// Reads what LAMMPS writes by write_data with atom_style sphere, and what LIGGGHTS takes for granular: balls
/// in the order of their ids. Of velocities, image flags and the box nothing is taken, and lengths count as
/// m: units other than si and lj are a mistake where the file tells them.
Packing parse_lammps_data(std::string_view text, const std::string& name, Diagnostics& diagnostics);

}  // namespace eigengrain::io
