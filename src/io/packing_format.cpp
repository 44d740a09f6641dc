#include "packing_format.hpp"

#include "lammps_data_reader.hpp"
#include "lammps_dump_reader.hpp"
#include "packing_reader.hpp"
#include "text_columns.hpp"
#include "yade_text_reader.hpp"

#include <algorithm>
#include <array>
#include <cstddef>

namespace eigengrain::io {
namespace {

struct FormatDescription {
  PackingFormat format;
  std::string_view name;
  PackingParser parse;
  std::string_view layout;
};

constexpr std::array<FormatDescription, 4> formats{{
    {PackingFormat::packing, "packing", parse_packing, "a line is x y z r, in m"},
    {PackingFormat::lammps_data, "lammps-data", parse_lammps_data,
     "its section Atoms has lines id type diameter density x y z"},
    {PackingFormat::lammps_dump, "lammps-dump", parse_lammps_dump,
     "its last frame has lines with the columns x y z radius"},
    {PackingFormat::yade_text, "yade-text", parse_yade_text,
     "a line is x y z r, behind a first line \"#format x_y_z_r\""},
}};

const FormatDescription& description_of(PackingFormat format) {
  return *std::find_if(formats.begin(), formats.end(), [=](const auto& f) { return f.format == format; });
}

/// Whether it has the header of a data file: a line such as "100 atoms" among the first.
bool has_atom_count(std::string_view text) {
  constexpr std::int32_t longest_header = 50;
  Lines lines(text);
  while (const auto line = lines.next()) {
    const std::vector<std::string_view> words = words_of(*line);
    if (words.size() == 2 && words[1] == "atoms") return true;
    if (lines.number() == longest_header) break;
  }
  return false;
}

}  // namespace

std::vector<std::string> packing_format_names() {
  std::vector<std::string> names;
  for (const FormatDescription& f : formats) names.emplace_back(f.name);
  return names;
}

std::optional<PackingFormat> find_packing_format(std::string_view name) {
  for (const FormatDescription& f : formats)
    if (f.name == name) return f.format;
  return std::nullopt;
}

PackingFormat recognised_format(std::string_view text) {
  if (text.starts_with("ITEM:")) return PackingFormat::lammps_dump;
  if (text.starts_with("#format ")) return PackingFormat::yade_text;
  return has_atom_count(text) ? PackingFormat::lammps_data : PackingFormat::packing;
}

PackingParser parser_of(PackingFormat format) {
  return description_of(format).parse;
}

std::string_view layout_of(PackingFormat format) {
  return description_of(format).layout;
}

}  // namespace eigengrain::io
