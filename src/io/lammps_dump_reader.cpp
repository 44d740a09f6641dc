#include "lammps_dump_reader.hpp"

#include "lammps_units.hpp"
#include "text_columns.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>

namespace eigengrain::io {
namespace {

constexpr std::string_view frame_start = "ITEM: TIMESTEP";
constexpr std::array<std::string_view, 3> axes{"x", "y", "z"};

/// Which word of a row holds what.
struct Columns {
  std::array<std::size_t, 3> position{};
  std::array<bool, 3> scaled{};  ///< a fraction of the box
  std::size_t size = 0;
  double radius_factor = 1;  ///< 1/2 of a diameter
  std::optional<std::size_t> id;
  std::size_t count = 0;
};

/// Reads one frame.
class Frame {
 public:
  Frame(std::string_view text, std::int32_t first_line, const std::string& name, Diagnostics& diagnostics)
      : lines_(text, first_line), rows_(name, diagnostics) {}

  Packing read() {
    while (const auto line = lines_.next()) {
      if (line->starts_with("ITEM: NUMBER OF ATOMS")) {
        if (!read_count()) return {};
      } else if (line->starts_with("ITEM: BOX BOUNDS")) {
        if (!read_box(*line)) return {};
      } else if (line->starts_with("ITEM: ATOMS")) {
        read_atoms(*line);
        return rows_.result();
      }
    }
    rows_.report(lines_.number(), "no section",
                 "the last frame ends without \"ITEM: ATOMS\"; was it still being written?");
    return {};
  }

 private:
  bool read_count() {
    const auto line = lines_.next();
    const std::vector<std::string_view> words = line ? words_of(*line) : std::vector<std::string_view>();
    if (words.size() == 1)
      count_ = rows_.integer(words[0], "number of atoms", lines_.number());
    else
      rows_.report(lines_.number(), "count", "the number of atoms stands alone on the line behind its ITEM");
    return count_.has_value();
  }

  bool read_box(std::string_view item) {
    tilted_ = item.find("xy xz yz") != std::string_view::npos || item.find("abc") != std::string_view::npos;
    for (std::size_t k = 0; k < 3; ++k) {
      const auto line = lines_.next();
      const std::vector<std::string_view> words = line ? words_of(*line) : std::vector<std::string_view>();
      if (words.size() < 2) {
        rows_.report(lines_.number(), "box",
                     fmt::format("two bounds of the box along {} are wanted", axes[k]));
        return false;
      }
      const auto low = rows_.number(words[0], fmt::format("{}lo", axes[k]), lines_.number());
      const auto high = rows_.number(words[1], fmt::format("{}hi", axes[k]), lines_.number());
      if (!low || !high) return false;
      low_[k] = *low;
      length_[k] = *high - *low;
    }
    return true;
  }

  std::optional<Columns> columns_of(std::string_view item) {
    std::vector<std::string_view> names = words_of(item);
    names.erase(names.begin(), names.begin() + 2);  // ITEM: ATOMS
    const auto find = [&](std::string_view name) -> std::optional<std::size_t> {
      const auto found = std::find(names.begin(), names.end(), name);
      if (found == names.end()) return std::nullopt;
      return static_cast<std::size_t>(found - names.begin());
    };
    Columns columns{.id = find("id"), .count = names.size()};
    std::string missing;
    for (std::size_t k = 0; k < 3; ++k) {
      const std::string axis(axes[k]);
      auto found = find(axis);
      if (!found) found = find(axis + "u");
      for (const char* suffix : {"s", "su"}) {
        if (found) break;
        found = find(axis + suffix);
        columns.scaled[k] = found.has_value();
      }
      if (!found) missing += (missing.empty() ? "" : ", ") + axis;
      columns.position[k] = found.value_or(0);
    }
    const auto radius = find("radius");
    const auto diameter = find("diameter");
    if (!radius && !diameter) missing += missing.empty() ? "radius" : ", radius";
    columns.size = radius ? *radius : diameter.value_or(0);
    columns.radius_factor = radius ? 1 : 0.5;
    if (missing.empty()) return columns;
    rows_.report(
        lines_.number(), "columns",
        fmt::format("no column {}; write the dump as \"dump ID GROUP custom N FILE id x y z radius\"",
                    missing));
    return std::nullopt;
  }

  void read_atoms(std::string_view item) {
    const auto columns = columns_of(item);
    if (!columns) return;
    if (!count_)
      return rows_.report(lines_.number(), "count",
                          "the atoms begin, but \"ITEM: NUMBER OF ATOMS\" does not stand before");
    const auto& scaled = columns->scaled;
    if (tilted_ && std::any_of(scaled.begin(), scaled.end(), [](bool s) { return s; }))
      return rows_.report(lines_.number(), "tilted",
                          "coordinates scaled by a tilted box, which cannot be read; write x y z instead");
    for (std::int64_t read = 0; read < *count_; ++read) {
      const auto line = lines_.next();
      const std::vector<std::string_view> words = line ? words_of(*line) : std::vector<std::string_view>();
      if (words.empty() || words.front() == "ITEM:")
        return rows_.report(
            lines_.number(), "end",
            fmt::format("the last frame ends after {} of its {} atoms; was it still being written?", read,
                        *count_));
      read_atom(words, *columns);
    }
  }

  void read_atom(const std::vector<std::string_view>& words, const Columns& columns) {
    const std::int32_t line = lines_.number();
    if (words.size() != columns.count)
      return rows_.report(
          line, "width",
          fmt::format("{} columns, and \"ITEM: ATOMS\" names {}", words.size(), columns.count));
    Vec3 position;
    for (std::size_t k = 0; k < 3; ++k) {
      const auto value = rows_.number(words[columns.position[k]], axes[k], line);
      if (!value) return;
      position[static_cast<Eigen::Index>(k)] = columns.scaled[k] ? low_[k] + *value * length_[k] : *value;
    }
    const auto size =
        rows_.number(words[columns.size], columns.radius_factor == 1 ? "radius" : "diameter", line);
    if (!size) return;
    const double radius = columns.radius_factor * *size;
    if (!columns.id) return rows_.add(position, radius, line);
    if (const auto id = rows_.integer(words[*columns.id], "id", line)) rows_.add(*id, position, radius, line);
  }

  Lines lines_;
  PackingRows rows_;
  std::optional<std::int64_t> count_;
  bool tilted_ = false;
  std::array<double, 3> low_{};
  std::array<double, 3> length_{};
};

/// Units stand once, before the first frame.
void check_units(std::string_view text, const std::string& name, Diagnostics& diagnostics) {
  if (!text.starts_with("ITEM: UNITS")) return;
  Lines lines(text);
  lines.next();
  const auto line = lines.next();
  const std::vector<std::string_view> words = line ? words_of(*line) : std::vector<std::string_view>();
  PackingRows rows(name, diagnostics);
  if (!words.empty()) check_lammps_units(words.front(), lines.number(), rows);
}

}  // namespace

Packing parse_lammps_dump(std::string_view text, const std::string& name, Diagnostics& diagnostics) {
  check_units(text, name, diagnostics);
  const std::size_t start = text.rfind(frame_start);
  if (start == std::string_view::npos) {
    diagnostics.add({name, 1}, fmt::format("no frame; a frame begins with \"{}\"", frame_start));
    return {};
  }
  const auto before = std::count(text.begin(), text.begin() + static_cast<std::ptrdiff_t>(start), '\n');
  return Frame(text.substr(start), static_cast<std::int32_t>(before) + 1, name, diagnostics).read();
}

}  // namespace eigengrain::io
