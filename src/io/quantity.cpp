#include "quantity.hpp"

#include "eigengrain/base/assert.hpp"

#include "units.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <limits>
#include <optional>
#include <string>
#include <system_error>

namespace eigengrain::io {
namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();
constexpr std::string_view out_of_reach = "is too large or too small for a number";

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

}  // namespace

Parsed<LeadingNumber> read_leading_number(std::string_view text, std::string_view hint) {
  if (text.size() > 1 && text[0] == '+' && text[1] != '-') text.remove_prefix(1);
  double value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error == std::errc::result_out_of_range) return {.problem = std::string(out_of_reach)};
  if (error != std::errc()) return {.problem = fmt::format("is not a number; {}", hint)};
  if (!std::isfinite(value)) return {.problem = "is not a finite number"};
  const auto length = static_cast<std::size_t>(end - text.data());
  return {.value = LeadingNumber{value, text.substr(0, length), text.substr(length)}};
}

Parsed<double> read_quantity(std::string_view untrimmed, std::string_view wanted_unit) {
  const Parsed<Unit> wanted = parse_unit(wanted_unit);
  EIGENGRAIN_ASSERT(wanted.value.has_value(), wanted_unit, wanted.problem);
  const std::string_view text = trimmed(untrimmed);
  const std::string hint = "write e.g. " + written(1, wanted_unit);
  if (text.empty()) return {.problem = "empty; " + hint};
  const auto [number, problem] = read_leading_number(text, hint);
  if (!number) return {.problem = fmt::format("\"{}\" {}", text, problem)};
  if (number->rest.starts_with(','))
    return {.problem =
                fmt::format("\"{}\" has a comma; write a decimal point and no thousands separator", text)};
  const std::string_view unit_text = trimmed(number->rest);
  if (unit_text.empty()) return {.value = number->value};

  const auto [unit, unit_problem] = parse_unit(unit_text);
  if (!unit) return {.problem = fmt::format("\"{}\": {}", text, unit_problem)};
  if (unit->dimension != wanted.value->dimension)
    return {.problem =
                fmt::format("\"{}\" is {}; {} is wanted, e.g. {}", text, dimension_name(unit->dimension),
                            dimension_name(wanted.value->dimension), written(number->value, wanted_unit))};
  const double value = shifted(number->digits, unit->decimal).value_or(infinity) * unit->factor;
  if (!std::isfinite(value)) return {.problem = fmt::format("\"{}\" {}", text, out_of_reach)};
  return {.value = value};
}

Parsed<std::int64_t> read_integer(std::string_view untrimmed) {
  const std::string_view text = trimmed(untrimmed);
  const std::optional<double> number = read_quantity(text, "").value;
  if (!number || std::trunc(*number) != *number)
    return {.problem = fmt::format("\"{}\" is not a whole number; write e.g. \"10000\"", text)};
  std::int64_t exact = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), exact);
  if (error == std::errc() && end == text.data() + text.size()) return {.value = exact};
  // Also 1e6, as far as a double holds every whole number.
  constexpr double largest = 9007199254740992.0;  // 2^53
  if (std::abs(*number) > largest)
    return {.problem = fmt::format("\"{}\" is too large for a whole number", text)};
  return {.value = static_cast<std::int64_t>(*number)};
}

}  // namespace eigengrain::io
