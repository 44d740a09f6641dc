#pragma once

#include "parsed.hpp"

#include <string>
#include <string_view>

namespace eigengrain::io {

/// Exponents of the base units.
struct Dimension {
  int length = 0;  ///< m
  int mass = 0;    ///< kg
  int time = 0;    ///< s

  friend constexpr bool operator==(const Dimension&, const Dimension&) = default;
};

/// "a density", "an acceleration"; "a quantity in kg m-1 s-1" for what has no name.
std::string dimension_name(const Dimension& dimension);

/// A unit: value in SI = value * factor * 10^decimal. The power of ten is kept apart because it can be
/// applied exactly.
struct Unit {
  Dimension dimension;
  double factor = 1;
  int decimal = 0;
};

/// Reads "N/m", "kg*m^-3", "m s-2", "g/cm3", "µm". Factors are separated by spaces, '*' or '·'; '/' divides
/// by the one factor behind it. Empty text is a pure number.
Parsed<Unit> parse_unit(std::string_view text);

/// The units and the prefixes that each takes, as a Markdown table.
std::string units_markdown();

}  // namespace eigengrain::io
