#include "units.hpp"

#include "eigengrain/io/suggest.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cstdlib>
#include <numbers>
#include <optional>
#include <utility>
#include <vector>

namespace eigengrain::io {
namespace {

struct UnitRow {
  std::string_view symbol;
  Unit unit;
  std::string_view prefixes;  ///< letters of `prefix_table` that make sense in front of it
  std::string_view description;
};

constexpr std::array unit_table{
    UnitRow{"m", {{1, 0, 0}, 1, 0}, "numcdk", "metre"},
    UnitRow{"g", {{0, 1, 0}, 1, -3}, "numkM", "gram; the SI unit is the kg"},
    UnitRow{"t", {{0, 1, 0}, 1, 3}, "", "tonne, 1000 kg"},
    UnitRow{"s", {{0, 0, 1}, 1, 0}, "num", "second"},
    UnitRow{"min", {{0, 0, 1}, 60, 0}, "", "minute"},
    UnitRow{"h", {{0, 0, 1}, 3600, 0}, "", "hour"},
    UnitRow{"N", {{1, 1, -2}, 1, 0}, "numkMG", "newton"},
    UnitRow{"Pa", {{-1, 1, -2}, 1, 0}, "numkMG", "pascal"},
    UnitRow{"J", {{2, 1, -2}, 1, 0}, "numkMG", "joule"},
    UnitRow{"rad", {{0, 0, 0}, 1, 0}, "m", "radian, a pure number"},
    UnitRow{"deg", {{0, 0, 0}, std::numbers::pi / 180, 0}, "", "degree, π/180"},
};

constexpr std::array<std::pair<char, int>, 8> prefix_table{
    {{'n', -9}, {'u', -6}, {'m', -3}, {'c', -2}, {'d', -1}, {'k', 3}, {'M', 6}, {'G', 9}}};

constexpr std::array<std::pair<Dimension, std::string_view>, 14> named_dimensions{{
    {{0, 0, 0}, "a pure number"},
    {{1, 0, 0}, "a length"},
    {{2, 0, 0}, "an area"},
    {{3, 0, 0}, "a volume"},
    {{0, 1, 0}, "a mass"},
    {{0, 0, 1}, "a time"},
    {{1, 0, -1}, "a velocity"},
    {{0, 0, -1}, "a rate"},
    {{1, 0, -2}, "an acceleration"},
    {{-3, 1, 0}, "a density"},
    {{1, 1, -2}, "a force"},
    {{0, 1, -2}, "a stiffness"},
    {{-1, 1, -2}, "a pressure"},
    {{2, 1, -2}, "an energy or a moment"},
}};

/// The ways of writing the same thing that need more than ASCII, in ASCII.
std::string in_ascii(std::string_view text) {
  static constexpr std::array<std::pair<std::string_view, std::string_view>, 16> spellings{{
      {"µ", "u"},
      {"μ", "u"},
      {"·", "*"},
      {"⋅", "*"},
      {"⁻", "-"},
      {"⁰", "0"},
      {"¹", "1"},
      {"²", "2"},
      {"³", "3"},
      {"⁴", "4"},
      {"⁵", "5"},
      {"⁶", "6"},
      {"⁷", "7"},
      {"⁸", "8"},
      {"⁹", "9"},
      {"−", "-"},
  }};
  std::string result;
  while (!text.empty()) {
    std::string_view from = text.substr(0, 1);
    std::string_view to = from;
    for (const auto& [written, ascii] : spellings)
      if (text.starts_with(written)) from = written, to = ascii;
    result += to;
    text.remove_prefix(from.size());
  }
  return result;
}

std::vector<std::string> all_symbols() {
  std::vector<std::string> symbols;
  for (const UnitRow& row : unit_table) {
    symbols.emplace_back(row.symbol);
    for (const char prefix : row.prefixes) symbols.push_back(prefix + std::string(row.symbol));
  }
  return symbols;
}

/// The unit of a symbol, prefix included. Whole symbols first, so that "min" is no milli-inch.
std::optional<Unit> find_unit(std::string_view symbol) {
  for (const UnitRow& row : unit_table)
    if (row.symbol == symbol) return row.unit;
  for (const UnitRow& row : unit_table)
    for (const auto& [letter, decimal] : prefix_table)
      if (row.prefixes.find(letter) != std::string_view::npos && symbol == letter + std::string(row.symbol))
        return Unit{row.unit.dimension, row.unit.factor, row.unit.decimal + decimal};
  return std::nullopt;
}

bool is_digit(char c) {
  return c >= '0' && c <= '9';
}

/// Reads one unit text from left to right.
class UnitParser {
 public:
  explicit UnitParser(std::string_view text) : text_(in_ascii(text)), rest_(text_) {}

  Parsed<Unit> parse() {
    bool divided = false;
    for (bool first = true; problem_.empty(); first = false) {
      const bool spaced = skip_blanks();
      if (rest_.empty()) break;
      const char operation = take_operation(first, spaced);
      if (divided && operation == '*')
        fail(
            "it is unclear whether what follows '/' and one more factor is divided by; write powers, as in "
            "\"kg m-1 s-2\"");
      divided = divided || operation == '/';
      if (problem_.empty()) take_factor(operation == '/' ? -1 : 1);
    }
    if (!problem_.empty()) return {.problem = problem_};
    return {.value = unit_};
  }

 private:
  void fail(std::string problem) {
    if (problem_.empty()) problem_ = std::move(problem);
  }

  bool skip_blanks() {
    const std::size_t blanks = std::min(rest_.find_first_not_of(" \t"), rest_.size());
    rest_.remove_prefix(blanks);
    return blanks > 0;
  }

  /// '*' or '/'; a blank between two factors multiplies.
  char take_operation(bool first, bool spaced) {
    if (rest_[0] == '/' || (rest_[0] == '*' && !first)) {
      const char operation = rest_[0];
      rest_.remove_prefix(1);
      skip_blanks();
      if (rest_.empty()) fail("it ends with an operator");
      return operation;
    }
    if (!first && !spaced) fail(fmt::format("\"{}\" is not expected there", rest_));
    return '*';
  }

  void take_factor(int sign) {
    const std::size_t length = std::min(rest_.find_first_of("0123456789+-^*/ \t"), rest_.size());
    const std::string_view symbol = rest_.substr(0, length);
    rest_.remove_prefix(length);
    if (symbol.empty()) return take_one();
    const std::optional<Unit> unit = find_unit(symbol);
    if (!unit)
      return fail(fmt::format("\"{}\" is no unit known here{}", symbol, did_you_mean(symbol, all_symbols())));
    multiply(*unit, sign * take_power());
  }

  /// The 1 of "1/s".
  void take_one() {
    const bool one = rest_.starts_with('1') && (rest_.size() == 1 || !is_digit(rest_[1]));
    if (!one) return fail(fmt::format("\"{}\" is not a unit", rest_));
    rest_.remove_prefix(1);
  }

  /// One digit, perhaps behind '^' and a sign; 1 if there is none.
  int take_power() {
    std::size_t at = 0;
    if (at < rest_.size() && rest_[at] == '^') ++at;
    const bool negative = at < rest_.size() && rest_[at] == '-';
    if (at < rest_.size() && (rest_[at] == '-' || rest_[at] == '+')) ++at;
    const bool digit = at < rest_.size() && is_digit(rest_[at]);
    const bool more = digit && at + 1 < rest_.size() && is_digit(rest_[at + 1]);
    if (at == 0 && !digit) return 1;
    if (!digit || more) {
      fail(fmt::format("\"{}\" is no power; write one digit, as in \"m2\" or \"m^-3\"", rest_));
      return 1;
    }
    const int power = rest_[at] - '0';
    rest_.remove_prefix(at + 1);
    return negative ? -power : power;
  }

  void multiply(const Unit& by, int power) {
    unit_.dimension.length += power * by.dimension.length;
    unit_.dimension.mass += power * by.dimension.mass;
    unit_.dimension.time += power * by.dimension.time;
    unit_.decimal += power * by.decimal;
    for (int k = 0; k < std::abs(power); ++k)
      unit_.factor = power > 0 ? unit_.factor * by.factor : unit_.factor / by.factor;
  }

  std::string text_;
  std::string_view rest_;
  Unit unit_;
  std::string problem_;
};

std::string base_units(const Dimension& d) {
  std::string text;
  for (const auto& [symbol, power] :
       {std::pair("kg", d.mass), std::pair("m", d.length), std::pair("s", d.time)}) {
    if (power == 0) continue;
    if (!text.empty()) text += ' ';
    text += symbol;
    if (power != 1) text += std::to_string(power);
  }
  return text;
}

}  // namespace

std::string dimension_name(const Dimension& dimension) {
  for (const auto& [named, name] : named_dimensions)
    if (named == dimension) return std::string(name);
  return "a quantity in " + base_units(dimension);
}

Parsed<Unit> parse_unit(std::string_view text) {
  return UnitParser(text).parse();
}

std::string units_markdown() {
  std::string text = "| unit | | prefixes |\n| --- | --- | --- |\n";
  for (const UnitRow& row : unit_table) {
    std::string prefixes;
    for (const char letter : row.prefixes)
      prefixes += fmt::format("{}{}", prefixes.empty() ? "" : " ", letter);
    text += fmt::format("| {} | {} | {} |\n", row.symbol, row.description, prefixes);
  }
  return text;
}

}  // namespace eigengrain::io
