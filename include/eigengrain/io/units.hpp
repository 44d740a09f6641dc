#pragma once

#include <string>
#include <string_view>

namespace eigengrain::io {

/// Exponents of the base units. The angle counts as a dimension, so that "10 deg" is no pure number and
/// a frequency no angular velocity.
struct Dimension {
  int length = 0;  ///< m
  int mass = 0;    ///< kg
  int time = 0;    ///< s
  int angle = 0;   ///< rad

  friend constexpr bool operator==(const Dimension&, const Dimension&) = default;
};

/// Whether a quantity of one dimension may stand for one of the other. Where mass is involved the angle does
/// not count: a rotational stiffness is written both as N m/rad and as N m.
bool compatible(const Dimension& a, const Dimension& b);

/// "a density", "an acceleration"; "a quantity in kg m-1 s-1" for what has no name.
std::string dimension_name(const Dimension& dimension);

/// A unit: value in SI = value * factor * 10^decimal. The power of ten is kept apart because it can be
/// applied exactly.
struct Unit {
  Dimension dimension;
  double factor = 1;
  int decimal = 0;
};

/// A unit, or what is wrong with its text.
struct UnitResult {
  Unit unit;
  std::string problem;  ///< empty: none
};

/// Reads "N/m", "kg*m^-3", "m s-2", "g/cm3", "µm". Factors are separated by spaces, '*' or '·'; '/' divides
/// by the one factor behind it. Empty text is a pure number.
UnitResult parse_unit(std::string_view text);

/// The units and the prefixes that each takes, as a Markdown table.
std::string units_markdown();

}  // namespace eigengrain::io
