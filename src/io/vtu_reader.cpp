#include "text_columns.hpp"
#include "volume_mesh_formats.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <set>
#include <span>
#include <utility>
#include <vector>

namespace eigengrain::io {
namespace {

using model::ElementKind;

struct VolumeType {
  std::int64_t number;
  ElementKind kind;
};
constexpr std::array<VolumeType, 3> volume_types{
    {{10, ElementKind::tet4}, {12, ElementKind::hex8}, {24, ElementKind::tet10}}};

/// Points, lines and faces of all orders, by VTK's numbers.
bool is_flat(std::int64_t type) {
  constexpr std::array<std::int64_t, 22> flat{0,  1,  2,  3,  4,  5,  6,  7,  8,  9,  21,
                                              22, 23, 28, 30, 34, 35, 36, 68, 69, 70, 75};
  return std::find(flat.begin(), flat.end(), type) != flat.end();
}

/// Volumes that are no elements of ours, by VTK's numbers.
constexpr std::array<std::pair<std::int64_t, std::string_view>, 8> other_volumes{
    {{11, "a voxel"},
     {13, "a wedge"},
     {14, "a pyramid"},
     {25, "a brick of 20 points"},
     {26, "a wedge of 15 points"},
     {27, "a pyramid of 13 points"},
     {29, "a brick of 27 points"},
     {42, "a polyhedron"}}};

/// What stands between < and >.
struct Tag {
  std::string_view name;        ///< with a slash in front where an element ends
  std::string_view attributes;  ///< what stands behind it
  std::size_t begin = 0;        ///< where < stands
  std::size_t end = 0;          ///< behind >
};

std::optional<Tag> next_tag(std::string_view text, std::size_t from) {
  constexpr std::string_view comment = "<!--";
  constexpr std::string_view comment_end = "-->";
  std::size_t begin = text.find('<', from);
  while (begin < text.size() && text.substr(begin).starts_with(comment)) {
    const std::size_t end = text.find(comment_end, begin + comment.size());
    if (end == std::string_view::npos) return std::nullopt;
    begin = text.find('<', end + comment_end.size());
  }
  if (begin == std::string_view::npos) return std::nullopt;
  char quote = 0;
  std::size_t end = begin + 1;
  for (; end < text.size() && (quote != 0 || text[end] != '>'); ++end)
    if (text[end] == quote)
      quote = 0;
    else if (quote == 0 && (text[end] == '"' || text[end] == '\''))
      quote = text[end];
  if (end == text.size()) return std::nullopt;
  const std::string_view inner = text.substr(begin + 1, end - begin - 1);
  const std::size_t name = std::min(inner.find_first_of(" \t\r\n/", 1), inner.size());
  return Tag{inner.substr(0, name), inner.substr(name), begin, end + 1};
}

/// The value of `key`; none if it is not there.
std::optional<std::string_view> attribute(const Tag& tag, std::string_view key) {
  std::string_view rest = tag.attributes;
  while (true) {
    const std::size_t begin = rest.find_first_not_of(" \t\r\n/");
    const std::size_t open = rest.find_first_of("\"'");
    if (open == std::string_view::npos || begin >= open) return std::nullopt;
    const std::size_t close = rest.find(rest[open], open + 1);
    if (close == std::string_view::npos) return std::nullopt;
    const std::string_view name = rest.substr(begin, rest.find_first_of(" \t\r\n=", begin) - begin);
    if (name == key) return rest.substr(open + 1, close - open - 1);
    rest.remove_prefix(close + 1);
  }
}

/// The text of a DataArray.
struct Array {
  std::string_view text;
  std::int32_t line = 0;  ///< on which it begins
};

/// Whole numbers and where they stand.
struct Integers {
  std::vector<std::int64_t> value;
  std::vector<std::int32_t> line;
};

/// Calls visit(word, line) for all words of an array.
template <class Visit>
void for_each_word(const Array& array, const Visit& visit) {
  Lines lines(array.text, array.line);
  while (const auto line = lines.next())
    for (const std::string_view word : words_of(*line)) visit(word, lines.number());
}

class VtuFile {
 public:
  VtuFile(std::string_view text, VolumeMeshRows& rows) : text_(text), rows_(rows) {}

  void read() {
    if (!find_arrays()) return;
    take_points();
    take_cells();
  }

 private:
  /// Tags come one after the other.
  std::int32_t line_of(const Tag& tag) { return line_at(tag.begin); }
  std::int32_t line_at(std::size_t place) {
    const auto at = [&](std::size_t k) { return text_.begin() + static_cast<std::ptrdiff_t>(k); };
    line_ += static_cast<std::int32_t>(std::count(at(counted_), at(place), '\n'));
    counted_ = place;
    return line_;
  }

  /// Whether all arrays that make a mesh are there, as text.
  bool find_arrays() {
    std::string_view parent;
    bool is_grid = false;
    bool has_piece = false;
    for (auto tag = next_tag(text_, 0); tag; tag = next_tag(text_, tag->end)) {
      if (tag->name == "VTKFile") {
        const std::string_view type = attribute(*tag, "type").value_or("");
        is_grid = type == "UnstructuredGrid";
        if (!is_grid) {
          rows_.report(line_of(*tag), "type",
                       fmt::format("a VTKFile of type \"{}\"; save an UnstructuredGrid", type));
          return false;
        }
      } else if (tag->name == "Piece") {
        if (has_piece) {
          rows_.report(line_of(*tag), "piece", "a second Piece; save the mesh as one");
          return false;
        }
        has_piece = true;
        points_wanted_ = attribute(*tag, "NumberOfPoints");
        cells_wanted_ = attribute(*tag, "NumberOfCells");
        piece_line_ = line_of(*tag);
      } else if (tag->name == "Points" || tag->name == "Cells" || tag->name == "PointData" ||
                 tag->name == "CellData" || tag->name == "FieldData") {
        parent = tag->name;
      } else if (tag->name == "DataArray") {
        if (!take_array(*tag, parent)) return false;
      } else if (tag->name == "AppendedData") {
        break;  // what stands there may be anything
      }
    }
    if (!is_grid) {
      rows_.report(0, "type", "no VTKFile in XML, of type UnstructuredGrid");
      return false;
    }
    return all_are_there();
  }

  std::optional<Array>* wanted_array(const Tag& tag, std::string_view parent) {
    if (parent == "Points") return &points_;
    if (parent != "Cells") return nullptr;
    const std::string_view name = attribute(tag, "Name").value_or("");
    if (name == "connectivity") return &connectivity_;
    if (name == "offsets") return &offsets_;
    return name == "types" ? &types_ : nullptr;
  }

  bool take_array(const Tag& tag, std::string_view parent) {
    std::optional<Array>* const array = wanted_array(tag, parent);
    if (array == nullptr) return true;
    const std::string_view format = attribute(tag, "format").value_or("ascii");
    if (format != "ascii") {
      rows_.report(
          line_of(tag), "format",
          fmt::format("a DataArray with format=\"{}\", which is not read; save the mesh as text (ParaView: "
                      "Data Mode Ascii; vtkXMLWriter: SetDataModeToAscii; meshio convert --ascii)",
                      format));
      return false;
    }
    const std::string_view components = attribute(tag, "NumberOfComponents").value_or("3");
    if (array == &points_ && components != "3") {
      rows_.report(line_of(tag), "components",
                   fmt::format("points of {} coordinates; three are wanted", components));
      return false;
    }
    const bool is_empty = tag.attributes.ends_with('/');
    const std::size_t end = is_empty ? tag.end : std::min(text_.find('<', tag.end), text_.size());
    *array = Array{text_.substr(tag.end, end - tag.end), line_at(tag.end)};
    return true;
  }

  bool all_are_there() {
    bool all = true;
    for (const auto& [array, what] :
         {std::pair(&points_, "in Points"), std::pair(&connectivity_, "\"connectivity\" in Cells"),
          std::pair(&offsets_, "\"offsets\" in Cells"), std::pair(&types_, "\"types\" in Cells")})
      if (!array->has_value()) {
        rows_.report(piece_line_, "array", fmt::format("there is no DataArray {}", what));
        all = false;
      }
    return all;
  }

  /// Whether there are as many as the Piece says.
  bool check_count(std::optional<std::string_view> wanted, std::string_view key, std::int64_t found,
                   std::int32_t line) {
    if (!wanted) return true;
    const auto count = rows_.integer(*wanted, key, piece_line_);
    if (count == found) return true;
    if (count) rows_.report(line, "count", fmt::format("{} here, and {}=\"{}\"", found, key, *count));
    return false;
  }

  void take_points() {
    std::vector<std::string_view> words;
    std::int64_t number = 0;
    for_each_word(*points_, [&](std::string_view word, std::int32_t line) {
      words.push_back(word);
      if (words.size() < 3) return;
      rows_.add_node(number++, rows_.position(words, line), line);
      words.clear();
    });
    if (!words.empty())
      rows_.report(
          points_->line, "count",
          fmt::format("{} numbers, which are not three for each point", 3 * number + std::ssize(words)));
    if (!words.empty() || !check_count(points_wanted_, "NumberOfPoints", number, points_->line))
      rows_.lose_nodes();
  }

  std::optional<Integers> integers_of(const Array& array, std::string_view name) {
    Integers integers;
    bool all = true;
    for_each_word(array, [&](std::string_view word, std::int32_t line) {
      const auto value = rows_.integer(word, name, line);
      all = all && value.has_value();
      integers.value.push_back(value.value_or(0));
      integers.line.push_back(line);
    });
    return all ? std::optional(std::move(integers)) : std::nullopt;
  }

  void take_cells() {
    const auto types = integers_of(*types_, "types");
    const auto offsets = integers_of(*offsets_, "offsets");
    const auto connectivity = integers_of(*connectivity_, "connectivity");
    if (!types || !offsets || !connectivity) return;
    if (!check_count(cells_wanted_, "NumberOfCells", std::ssize(types->value), types_->line)) return;
    if (types->value.size() != offsets->value.size())
      return rows_.report(offsets_->line, "count",
                          fmt::format("{} offsets and {} types; each cell has one of both",
                                      offsets->value.size(), types->value.size()));
    std::int64_t begin = 0;
    for (std::size_t cell = 0; cell < types->value.size(); ++cell) {
      const std::int64_t end = offsets->value[cell];
      if (end < begin || end > std::ssize(connectivity->value))
        return rows_.report(
            offsets->line[cell], "offset",
            fmt::format("offset {} of cell {} is not between {}, where the cell before ends, and {}, "
                        "where the connectivity ends",
                        end, cell, begin, connectivity->value.size()));
      const auto first = static_cast<std::size_t>(begin);
      const std::int32_t line = end > begin ? connectivity->line[first] : types->line[cell];
      take_cell(static_cast<std::int64_t>(cell), types->value[cell],
                std::span(connectivity->value).subspan(first, static_cast<std::size_t>(end - begin)), line);
      begin = end;
    }
  }

  void take_cell(std::int64_t number, std::int64_t type, std::span<const std::int64_t> points,
                 std::int32_t line) {
    const auto* const volume = std::find_if(volume_types.begin(), volume_types.end(),
                                            [&](const VolumeType& v) { return v.number == type; });
    if (volume == volume_types.end()) return take_other(number, type, line);
    if (std::ssize(points) != nodes_of(volume->kind))
      return rows_.report(line, "points",
                          fmt::format("cell {} has {} points; a {} has {}", number, points.size(),
                                      name_of(volume->kind), nodes_of(volume->kind)));
    rows_.add_element(number, volume->kind, points, line);
  }

  void take_other(std::int64_t number, std::int64_t type, std::int32_t line) {
    if (is_flat(type)) return rows_.skip_elements(1);
    if (!reported_types_.insert(type).second) return;
    const auto* const other = std::find_if(other_volumes.begin(), other_volumes.end(),
                                           [&](const auto& entry) { return entry.first == type; });
    rows_.report(
        line, "type",
        fmt::format("cell {} is of type {}{}; read are tetrahedra of 4 points (type 10) or 10 (24) and "
                    "bricks of 8 (12)",
                    number, type,
                    other == other_volumes.end() ? std::string() : fmt::format(", {}", other->second)));
  }

  std::string_view text_;
  VolumeMeshRows& rows_;
  std::size_t counted_ = 0;  ///< up to where line_ counts
  std::int32_t line_ = 1;
  std::int32_t piece_line_ = 0;
  std::optional<std::string_view> points_wanted_;
  std::optional<std::string_view> cells_wanted_;
  std::optional<Array> points_;
  std::optional<Array> connectivity_;
  std::optional<Array> offsets_;
  std::optional<Array> types_;
  std::set<std::int64_t> reported_types_;
};

}  // namespace

void read_vtu(std::string_view text, VolumeMeshRows& rows) {
  VtuFile(text, rows).read();
}

}  // namespace eigengrain::io
