#include "packing_reader.hpp"

#include "quantity.hpp"
#include "text_file.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <utility>

namespace eigengrain::io {
namespace {

constexpr std::size_t columns = 4;
constexpr std::array<std::string_view, columns> column_names{"x", "y", "z", "r"};

constexpr bool is_blank(char c) {
  return c == ' ' || c == '\t' || c == '\r' || c == '\v' || c == '\f';
}

/// The next word of a line, which it is removed from; empty at the end.
std::string_view take_word(std::string_view& line) {
  std::size_t begin = 0;
  while (begin < line.size() && is_blank(line[begin])) ++begin;
  std::size_t end = begin;
  while (end < line.size() && !is_blank(line[end])) ++end;
  const std::string_view word = line.substr(begin, end - begin);
  line.remove_prefix(end);
  return word;
}

Parsed<double> read_column(std::string_view word) {
  constexpr std::string_view hint = "columns are plain numbers in m, separated by blanks";
  const auto [number, problem] = read_leading_number(word, hint);
  if (!number) return {.problem = problem};
  if (!number->rest.empty()) return {.problem = fmt::format("is not a number; {}", hint)};
  return {.value = number->value};
}

/// Reads the rows of one file.
class PackingParser {
 public:
  PackingParser(const std::string& name, Diagnostics& diagnostics) : name_(name), diagnostics_(diagnostics) {}

  void take_line(std::string_view line, std::int32_t number) {
    line = line.substr(0, line.find('#'));
    std::array<double, columns> values{};
    std::size_t count = 0;
    for (std::string_view word = take_word(line); !word.empty(); word = take_word(line), ++count) {
      if (count >= columns) continue;
      const auto [value, problem] = read_column(word);
      if (!value)
        return report(number, "number", fmt::format("{} = \"{}\" {}", column_names[count], word, problem));
      values[count] = *value;
    }
    if (count == 0) return;
    if (count != columns)
      return report(number, "columns", fmt::format("{} columns; four are wanted: x y z r, in m", count));
    if (values[3] <= 0)
      return report(number, "radius", fmt::format("radius {} m is not positive", values[3]));
    packing_.position.emplace_back(values[0], values[1], values[2]);
    packing_.radius.push_back(values[3]);
    packing_.line.push_back(number);
  }

  Packing result() { return std::move(packing_); }

 private:
  void report(std::int32_t line, std::string_view kind, std::string message) {
    diagnostics_.add({name_, line}, std::move(message), kind);
  }

  const std::string& name_;
  Diagnostics& diagnostics_;
  Packing packing_;
};

}  // namespace

Packing parse_packing(std::string_view text, const std::string& name, Diagnostics& diagnostics) {
  PackingParser parser(name, diagnostics);
  for (std::int64_t line = 1; !text.empty(); ++line) {
    const std::size_t end = std::min(text.find('\n'), text.size());
    parser.take_line(text.substr(0, end), static_cast<std::int32_t>(line));
    text.remove_prefix(std::min(end + 1, text.size()));
  }
  return parser.result();
}

Packing read_packing_file(const std::filesystem::path& file, const Place& asked_at,
                          Diagnostics& diagnostics) {
  const auto [text, problem] = read_text_file(file);
  if (!text) {
    diagnostics.add(asked_at, problem);
    return {};
  }
  const std::int64_t mistakes_before = diagnostics.count();
  Packing packing = parse_packing(*text, file.string(), diagnostics);
  if (packing.radius.empty() && diagnostics.count() == mistakes_before)
    diagnostics.add(asked_at, fmt::format("\"{}\" holds no balls; a line is x y z r, in m", file.string()));
  return packing;
}

Packing read_packing_file(const std::filesystem::path& file) {
  Diagnostics diagnostics;
  Packing packing = read_packing_file(file, Place{}, diagnostics);
  diagnostics.throw_if_any();
  return packing;
}

}  // namespace eigengrain::io
