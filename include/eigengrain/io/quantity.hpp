#pragma once

#include <optional>
#include <string>
#include <string_view>

namespace eigengrain::io {

/// A value in SI units, or what is wrong with its text and what to write instead.
struct QuantityResult {
  std::optional<double> value;
  std::string problem;  ///< empty where there is a value
};

/// Reads "5 mm", "48 GPa", "1e5": a finite number, alone (then in SI units) or with a unit of the dimension
/// of `wanted_unit` ("" for a pure number). Does not depend on the locale.
QuantityResult read_quantity(std::string_view text, std::string_view wanted_unit);

/// Reads "10000" or "1e4": a whole number. The problem is empty exactly where there is a value.
struct IntegerResult {
  std::optional<long long> value;
  std::string problem;
};
IntegerResult read_integer(std::string_view text);

}  // namespace eigengrain::io
