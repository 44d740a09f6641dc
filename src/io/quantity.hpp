#pragma once

#include "parsed.hpp"

#include <cstdint>
#include <string_view>

namespace eigengrain::io {

/// The number that a text begins with.
struct LeadingNumber {
  double value = 0;         ///< finite
  std::string_view digits;  ///< its own text, without a leading '+'
  std::string_view rest;    ///< what stands behind it
};

/// Does not depend on the locale. The problem continues a sentence that begins with the text; `hint` says
/// what to write instead of what is not a number.
Parsed<LeadingNumber> read_leading_number(std::string_view text, std::string_view hint);

/// Reads "5 mm", "48 GPa", "1e5" into SI units: a finite number, alone or with a unit of the dimension of
/// `wanted_unit` ("" for a pure number).
Parsed<double> read_quantity(std::string_view text, std::string_view wanted_unit);

/// Reads "10000" or "1e4": a whole number.
Parsed<std::int64_t> read_integer(std::string_view text);

}  // namespace eigengrain::io
