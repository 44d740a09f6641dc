#include "yade_text_reader.hpp"

#include "eigengrain/io/suggest.hpp"

#include "text_columns.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>

namespace eigengrain::io {
namespace {

/// A format by its name, as YADE writes it in the first line.
struct Format {
  std::string_view name;
  std::size_t first = 0;  ///< the column of x; y z r follow
  std::size_t count = 0;  ///< columns
  bool more = false;      ///< there may be more
};

constexpr std::array<Format, 4> formats{{
    {"x_y_z_r", 0, 4},
    {"x_y_z_r_matId", 0, 5},
    {"x_y_z_r_attrs", 0, 4, true},
    {"id_x_y_z_r_matId", 1, 6},
}};
constexpr std::array<std::string_view, 4> column_names{"x", "y", "z", "r"};

std::optional<Format> read_format(std::string_view line, PackingRows& rows) {
  constexpr std::string_view start = "#format ";
  if (!line.starts_with(start)) {
    rows.report(1, "format", "the first line is not the name of a format, such as \"#format x_y_z_r\"");
    return std::nullopt;
  }
  const std::vector<std::string_view> words = words_of(line.substr(start.size()));
  const std::string_view name = words.empty() ? std::string_view() : words.front();
  std::vector<std::string> names;
  for (const Format& format : formats) {
    if (format.name == name) return format;
    names.emplace_back(format.name);
  }
  rows.report(1, "format",
              fmt::format("format \"{}\" cannot be read{} (those that can: {})", name,
                          did_you_mean(name, names), fmt::join(names, ", ")));
  return std::nullopt;
}

void take_row(const std::vector<std::string_view>& words, const Format& format, std::int32_t line,
              PackingRows& rows) {
  if (words.size() < format.count || (words.size() > format.count && !format.more))
    return rows.report(line, "columns",
                       fmt::format("{} columns; format {} has {}{}", words.size(), format.name, format.count,
                                   format.more ? " or more" : ""));
  std::array<double, 4> values{};
  for (std::size_t k = 0; k < values.size(); ++k) {
    const auto value = rows.number(words[format.first + k], column_names[k], line);
    if (!value) return;
    values[k] = *value;
  }
  rows.add({values[0], values[1], values[2]}, values[3], line);
}

}  // namespace

Packing parse_yade_text(std::string_view text, const std::string& name, Diagnostics& diagnostics) {
  PackingRows rows(name, diagnostics);
  Lines lines(text);
  const auto format = read_format(lines.next().value_or(std::string_view()), rows);
  if (!format) return {};
  while (const auto line = lines.next()) {
    const std::vector<std::string_view> words = words_of(*line);
    if (!words.empty()) take_row(words, *format, lines.number(), rows);
  }
  return rows.result();
}

}  // namespace eigengrain::io
