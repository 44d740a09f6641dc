#include "volume_mesh_reader.hpp"

#include "text_file.hpp"
#include "volume_mesh_formats.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>

namespace eigengrain::io {
namespace {

struct Format {
  std::string_view ending;
  MeshWords words;
  void (*read)(std::string_view text, VolumeMeshRows& rows);
};

constexpr std::array<Format, 3> formats{{{".msh", {"node", "element"}, read_gmsh},
                                         {".inp", {"node", "element"}, read_abaqus_input},
                                         {".vtu", {"point", "cell"}, read_vtu}}};

std::string nothing_in(const std::string& name, const VolumeMeshRows& rows) {
  if (rows.skipped() == 0) return fmt::format("\"{}\" holds no elements", name);
  return fmt::format(
      "\"{}\" holds no volumes, only {} points, lines or faces; mesh its volume (Gmsh: -3), and where there "
      "are physical groups, put the volume into one, as Gmsh writes nothing else",
      name, rows.skipped());
}

}  // namespace

model::Mesh parse_volume_mesh(std::string_view contents, const std::string& name, double unit,
                              const Place& asked_at, Diagnostics& diagnostics) {
  const auto* const format = std::find_if(formats.begin(), formats.end(),
                                          [&](const Format& f) { return has_ending(name, f.ending); });
  if (format == formats.end()) {
    diagnostics.add(
        asked_at,
        fmt::format("\"{}\" ends in none of .msh (Gmsh), .inp (Abaqus, CalculiX) and .vtu (VTK), the "
                    "volume meshes that can be read",
                    name));
    return {};
  }
  const std::int64_t mistakes_before = diagnostics.count();
  VolumeMeshRows rows(name, format->words, diagnostics);
  format->read(contents, rows);
  if (rows.elements() == 0) {
    if (diagnostics.count() == mistakes_before) diagnostics.add(asked_at, nothing_in(name, rows));
    return {};
  }
  return rows.result(unit);
}

model::Mesh read_volume_mesh(const std::filesystem::path& file, double unit, const Place& asked_at,
                             Diagnostics& diagnostics) {
  const auto [contents, problem] = read_text_file(file);
  if (!contents) {
    diagnostics.add(asked_at, problem);
    return {};
  }
  return parse_volume_mesh(*contents, file.string(), unit, asked_at, diagnostics);
}

}  // namespace eigengrain::io
