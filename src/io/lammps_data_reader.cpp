#include "lammps_data_reader.hpp"

#include "lammps_units.hpp"
#include "text_columns.hpp"

#include <fmt/format.h>

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>

namespace eigengrain::io {
namespace {

constexpr std::array<std::string_view, 7> columns{"id", "type", "diameter", "density", "x", "y", "z"};

/// Reads one file, whose order is: a title, the header with counts and box, sections.
class DataFile {
 public:
  DataFile(std::string_view text, const std::string& name, Diagnostics& diagnostics)
      : lines_(text), rows_(name, diagnostics) {}

  Packing read() {
    read_title();
    if (find_atoms()) read_atoms();
    return rows_.result();
  }

 private:
  void read_title() {
    const auto title = lines_.next();
    if (!title) return;
    const std::size_t at = title->find("units = ");
    if (at == std::string_view::npos) return;
    const std::vector<std::string_view> words = words_of(title->substr(at + 8));
    if (!words.empty()) check_lammps_units(words.front(), lines_.number(), rows_);
  }

  /// Goes on to the section of atoms; whether it is there and has radii.
  bool find_atoms() {
    while (const auto line = lines_.next()) {
      const std::vector<std::string_view> words = words_of(*line);
      if (words.size() == 2 && words[1] == "atoms")
        count_ = rows_.integer(words[0], "atoms", lines_.number());
      if (words.size() == 1 && words[0] == "Atoms") return check_style(*line) && check_count();
    }
    rows_.report(lines_.number(), "no section", "the file ends without a section Atoms");
    return false;
  }

  /// The style stands behind the keyword, as in "Atoms # sphere".
  bool check_style(std::string_view keyword) {
    const std::size_t hash = keyword.find('#');
    const std::vector<std::string_view> style =
        hash == std::string_view::npos ? std::vector<std::string_view>() : words_of(keyword.substr(hash + 1));
    if (style.empty() || style.front() == "sphere") return true;
    rows_.report(
        lines_.number(), "style",
        fmt::format(
            "atoms of style \"{}\", of which no radii can be read; write the data with atom_style sphere",
            style.front()));
    return false;
  }

  bool check_count() {
    if (count_) return true;
    rows_.report(lines_.number(), "count",
                 "the section Atoms begins, but the header does not say how many (\"100 atoms\")");
    return false;
  }

  void read_atoms() {
    std::int64_t read = 0;
    while (read < *count_) {
      const auto line = lines_.next();
      const std::vector<std::string_view> words = line ? words_of(*line) : std::vector<std::string_view>();
      if (line && words.empty() && read == 0) continue;  // between the keyword and the rows
      if (words.empty())
        return rows_.report(
            lines_.number(), "end",
            fmt::format("the section Atoms ends after {} of the {} atoms that the header counts", read,
                        *count_));
      ++read;
      read_atom(words);
    }
  }

  void read_atom(const std::vector<std::string_view>& words) {
    const std::int32_t line = lines_.number();
    if (words.size() != columns.size() && words.size() != columns.size() + 3)
      return rows_.report(
          line, "columns",
          fmt::format("{} columns; an atom of style sphere has seven, id type diameter density x y z, or "
                      "ten with image flags",
                      words.size()));
    std::array<double, columns.size()> values{};
    const auto id = rows_.integer(words[0], columns[0], line);
    if (!id) return;
    for (std::size_t k = 2; k < columns.size(); ++k) {
      const auto value = rows_.number(words[k], columns[k], line);
      if (!value) return;
      values[k] = *value;
    }
    if (values[2] == 0)
      return rows_.report(line, "point",
                          fmt::format("atom {} has diameter 0, a point without a radius", *id));
    rows_.add(*id, {values[4], values[5], values[6]}, values[2] / 2, line);
  }

  Lines lines_;
  PackingRows rows_;
  std::optional<std::int64_t> count_;
};

}  // namespace

Packing parse_lammps_data(std::string_view text, const std::string& name, Diagnostics& diagnostics) {
  return DataFile(text, name, diagnostics).read();
}

}  // namespace eigengrain::io
