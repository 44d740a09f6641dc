#include "eigengrain/io/quantity.hpp"

#include "eigengrain/base/assert.hpp"
#include "eigengrain/io/units.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstdint>
#include <limits>
#include <system_error>

namespace eigengrain::io {
namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();

std::string_view trimmed(std::string_view text) {
  constexpr std::string_view blanks = " \t\r\n";
  const std::size_t first = text.find_first_not_of(blanks);
  if (first == std::string_view::npos) return {};
  return text.substr(first, text.find_last_not_of(blanks) - first + 1);
}

/// "1e5 N/m" -> `"1e5 N/m"`, which says what to write for a number with the unit wanted.
std::string written(double number, std::string_view unit) {
  return unit.empty() ? fmt::format("\"{}\"", number) : fmt::format("\"{} {}\"", number, unit);
}

/// The number written as `digits`, times 10^decimal, rounded once: 9.3 mm is the very number 0.0093.
std::optional<double> shifted(std::string_view digits, int decimal) {
  const std::size_t mark = std::min(digits.find_first_of("eE"), digits.size());
  int exponent = 0;
  if (mark < digits.size()) {
    std::string_view power = digits.substr(mark + 1);
    if (power.starts_with('+')) power.remove_prefix(1);
    const auto parsed = std::from_chars(power.data(), power.data() + power.size(), exponent);
    if (parsed.ec != std::errc()) return std::nullopt;
  }
  const std::string text = fmt::format("{}e{}", digits.substr(0, mark), std::int64_t{exponent} + decimal);
  double value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  return error == std::errc() ? std::optional(value) : std::nullopt;
}

QuantityResult problem(std::string text) {
  return {std::nullopt, std::move(text)};
}

struct Number {
  double value = 0;
  std::string_view digits;  ///< its own text
  std::string_view rest;    ///< what stands behind it
  std::string problem;
};

Number leading_number(std::string_view text, std::string_view wanted_unit) {
  std::string_view digits = text;
  if (digits.size() > 1 && digits[0] == '+' && digits[1] != '-') digits.remove_prefix(1);
  Number number;
  const auto [end, error] = std::from_chars(digits.data(), digits.data() + digits.size(), number.value);
  const auto length = static_cast<std::size_t>(end - digits.data());
  number.digits = digits.substr(0, length);
  number.rest = digits.substr(length);
  if (error == std::errc::result_out_of_range)
    number.problem = fmt::format("\"{}\" is too large or too small for a number", text);
  else if (error != std::errc())
    number.problem = fmt::format("\"{}\" is not a number; write e.g. {}", text, written(1, wanted_unit));
  else if (!std::isfinite(number.value))
    number.problem = fmt::format("\"{}\" is not a finite number", text);
  else if (number.rest.starts_with(','))
    number.problem =
        fmt::format("\"{}\" has a comma; write a decimal point and no thousands separator", text);
  return number;
}

}  // namespace

QuantityResult read_quantity(std::string_view untrimmed, std::string_view wanted_unit) {
  const UnitResult wanted = parse_unit(wanted_unit);
  EIGENGRAIN_ASSERT(wanted.problem.empty(), wanted_unit, wanted.problem);
  const std::string_view text = trimmed(untrimmed);
  if (text.empty()) return problem(fmt::format("empty; write e.g. {}", written(1, wanted_unit)));
  const Number number = leading_number(text, wanted_unit);
  if (!number.problem.empty()) return problem(number.problem);
  const std::string_view unit_text = trimmed(number.rest);
  if (unit_text.empty()) return {number.value, {}};

  const UnitResult given = parse_unit(unit_text);
  if (!given.problem.empty()) return problem(fmt::format("\"{}\": {}", text, given.problem));
  if (!compatible(given.unit.dimension, wanted.unit.dimension))
    return problem(fmt::format("\"{}\" is {}; {} is wanted, e.g. {}", text,
                               dimension_name(given.unit.dimension), dimension_name(wanted.unit.dimension),
                               written(number.value, wanted_unit)));
  const double value = shifted(number.digits, given.unit.decimal).value_or(infinity) * given.unit.factor;
  if (!std::isfinite(value))
    return problem(fmt::format("\"{}\" is too large or too small for a number", text));
  return {value, {}};
}

IntegerResult read_integer(std::string_view untrimmed) {
  const std::string_view text = trimmed(untrimmed);
  const std::string wanted = fmt::format("\"{}\" is not a whole number; write e.g. \"10000\"", text);
  const QuantityResult number = read_quantity(text, "");
  if (!number.value) return {std::nullopt, wanted};
  std::int64_t exact = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), exact);
  if (error == std::errc() && end == text.data() + text.size()) return {exact, {}};
  // Also 1e6, as far as a double holds every whole number.
  constexpr double largest = 9007199254740992.0;  // 2^53
  if (std::trunc(*number.value) != *number.value) return {std::nullopt, wanted};
  if (std::abs(*number.value) > largest)
    return {std::nullopt, fmt::format("\"{}\" is too large for a whole number", text)};
  return {static_cast<std::int64_t>(*number.value), {}};
}

}  // namespace eigengrain::io
