#include "packing_reader.hpp"

#include "text_columns.hpp"
#include "text_file.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>

namespace eigengrain::io {
namespace {

constexpr std::size_t columns = 4;
constexpr std::array<std::string_view, columns> column_names{"x", "y", "z", "r"};

void take_row(const std::vector<std::string_view>& words, std::int32_t line, PackingRows& rows) {
  std::array<double, columns> values{};
  for (std::size_t k = 0; k < std::min(words.size(), columns); ++k) {
    const auto value = rows.number(words[k], column_names[k], line);
    if (!value) return;
    values[k] = *value;
  }
  if (words.size() != columns)
    return rows.report(line, "columns",
                       fmt::format("{} columns; four are wanted: x y z r, in m", words.size()));
  rows.add({values[0], values[1], values[2]}, values[3], line);
}

}  // namespace

Packing parse_packing(std::string_view text, const std::string& name, Diagnostics& diagnostics) {
  PackingRows rows(name, diagnostics);
  Lines lines(text);
  while (const auto line = lines.next()) {
    const std::vector<std::string_view> words = words_of(*line);
    if (!words.empty()) take_row(words, lines.number(), rows);
  }
  return rows.result();
}

Packing read_packing_file(const std::filesystem::path& file, const Place& asked_at, Diagnostics& diagnostics,
                          std::optional<PackingFormat> format) {
  const auto [text, problem] = read_text_file(file);
  if (!text) {
    diagnostics.add(asked_at, problem);
    return {};
  }
  const std::int64_t mistakes_before = diagnostics.count();
  const PackingFormat known = format ? *format : recognised_format(*text);
  Packing packing = parser_of(known)(*text, file.string(), diagnostics);
  if (packing.radius.empty() && diagnostics.count() == mistakes_before)
    diagnostics.add(asked_at, fmt::format("\"{}\" holds no balls; {}", file.string(), layout_of(known)));
  return packing;
}

Packing read_packing_file(const std::filesystem::path& file) {
  Diagnostics diagnostics;
  Packing packing = read_packing_file(file, Place{}, diagnostics);
  diagnostics.throw_if_any();
  return packing;
}

}  // namespace eigengrain::io
