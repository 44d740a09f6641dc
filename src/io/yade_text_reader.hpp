#pragma once

#include "eigengrain/io/packing_file.hpp"

#include "diagnostics.hpp"

#include <string>
#include <string_view>

namespace eigengrain::io {

/// Reads what YADE writes by export.text and export.textExt: formats x_y_z_r, x_y_z_r_matId, x_y_z_r_attrs
/// and id_x_y_z_r_matId. YADE writes six digits.
Packing parse_yade_text(std::string_view text, const std::string& name, Diagnostics& diagnostics);

}  // namespace eigengrain::io
