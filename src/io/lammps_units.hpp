#pragma once

#include "text_columns.hpp"

#include <fmt/format.h>

#include <cstdint>
#include <string_view>

namespace eigengrain::io {

/// Reports units in which a length is no metre. `lj` are numbers without a unit, which a scene may take as
/// metres.
inline void check_lammps_units(std::string_view units, std::int32_t line, PackingRows& rows) {
  if (units == "si" || units == "lj") return;
  rows.report(
      line, "units",
      fmt::format("the file is in units {}, and lengths are read in m; write it with units si", units));
}

}  // namespace eigengrain::io
