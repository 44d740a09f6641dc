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
using Words = std::vector<std::string_view>;

struct VolumeType {
  std::int64_t number;
  ElementKind kind;
};
constexpr std::array<VolumeType, 3> volume_types{
    {{4, ElementKind::tet4}, {5, ElementKind::hex8}, {11, ElementKind::tet10}}};

/// Volumes that are no elements of ours, by Gmsh's number.
constexpr std::array<std::pair<std::int64_t, std::string_view>, 10> other_volumes{
    {{6, "a prism of 6 nodes"},
     {7, "a pyramid of 5 nodes"},
     {12, "a brick of 27 nodes"},
     {13, "a prism of 18 nodes"},
     {14, "a pyramid of 14 nodes"},
     {17, "a brick of 20 nodes"},
     {18, "a prism of 15 nodes"},
     {19, "a pyramid of 13 nodes"},
     {29, "a tetrahedron of 20 nodes"},
     {30, "a tetrahedron of 35 nodes"}}};

/// Points, lines and faces of all orders, by Gmsh's numbers.
bool is_flat(std::int64_t type) {
  constexpr std::array<std::pair<std::int64_t, std::int64_t>, 6> ranges{
      {{1, 3}, {8, 10}, {15, 16}, {20, 28}, {34, 34}, {36, 70}}};
  return std::any_of(ranges.begin(), ranges.end(),
                     [&](const auto& range) { return type >= range.first && type <= range.second; });
}

/// Reads one file: the format, then sections of which the nodes and the elements are wanted.
class GmshFile {
 public:
  GmshFile(std::string_view text, VolumeMeshRows& rows) : lines_(text), rows_(rows) {}

  void read() {
    if (!read_format()) return;
    bool nodes = false;
    bool elements = false;
    while (const auto words = next_row()) {
      if (words->front() == "$Nodes") {
        begin("$Nodes", "nodes");
        nodes = true;
        if (!(old_ ? read_old_nodes() : read_nodes())) rows_.lose_nodes();
      } else if (words->front() == "$Elements") {
        begin("$Elements", "elements");
        elements = true;
        if (old_)
          read_old_elements();
        else
          read_elements();
      }
    }
    for (const auto& [found, section] : {std::pair(nodes, "$Nodes"), std::pair(elements, "$Elements")})
      if (!found)
        rows_.report(lines_.number(), "section", fmt::format("the file ends without a section {}", section));
  }

 private:
  /// The words of the next line that has any.
  std::optional<Words> next_row() {
    while (const auto line = lines_.next()) {
      Words words = words_of(*line);
      if (!words.empty()) return words;
    }
    return std::nullopt;
  }

  void report(std::string_view kind, std::string message) {
    rows_.report(lines_.number(), kind, std::move(message));
  }
  std::optional<std::int64_t> integer(std::string_view word, std::string_view what) {
    return rows_.integer(word, what, lines_.number());
  }

  bool read_format() {
    auto words = next_row();
    while (words && words->front() != "$MeshFormat" && words->front() != "$NOD") words = next_row();
    if (!words) {
      rows_.report(0, "format", "no section $MeshFormat, with which a mesh of Gmsh begins");
      return false;
    }
    if (words->front() == "$NOD") {
      report("version", "version 1 of Gmsh's format; save it anew as 4.1 or 2.2 (Mesh.MshFileVersion = 4.1)");
      return false;
    }
    words = next_row();
    if (!words || words->size() < 2) {
      report("format", "$MeshFormat is followed by neither version nor type, such as \"4.1 0 8\"");
      return false;
    }
    if ((*words)[1] != "0") {
      report("binary",
             "binary numbers, which are not read; save the mesh as text: \"gmsh FILE -save -setnumber "
             "Mesh.Binary 0 -o TEXT.msh\", or \"Mesh.Binary = 0;\" in the .geo file");
      return false;
    }
    const std::string_view version = words->front();
    old_ = version == "2" || version.starts_with("2.");
    if (old_ || version == "4.1") return true;
    report("version",
           fmt::format("version {} of Gmsh's format; save it anew as 4.1 or 2.2 (Mesh.MshFileVersion = 4.1)",
                       version));
    return false;
  }

  void begin(std::string_view section, std::string_view things) {
    section_ = section;
    things_ = things;
    count_.reset();
    done_ = 0;
  }

  /// The next row of the section in hand, which has at least `least` columns; reports its end if it is there.
  std::optional<Words> row(std::size_t least) {
    const Lines here = lines_;
    auto words = next_row();
    if (!words || words->front().starts_with('$')) {
      report("end", count_
                        ? fmt::format("the section {} ends after {} of the {} {} that it counts", section_,
                                      done_, *count_, things_)
                        : fmt::format("the section {} does not say how many {} it has", section_, things_));
      if (words) lines_ = here;
      return std::nullopt;
    }
    if (words->size() >= least) return words;
    report("columns", fmt::format("{} columns; {} or more are wanted", words->size(), least));
    words->clear();
    return words;
  }

  /// Whether the section ends where it should.
  bool check_end() {
    const Lines here = lines_;
    const auto words = next_row();
    const bool ends = words && words->front().starts_with("$End");
    if (!ends)
      report("end", fmt::format("$End{} is wanted behind the {} {} that the section counts",
                                section_.substr(1), count_.value_or(0), things_));
    if (words && words->front().starts_with('$')) lines_ = here;
    return ends;
  }

  /// A row with the number of rows to come.
  void read_count() {
    if (const auto words = row(1)) count_ = integer(words->front(), section_);
  }

  bool read_old_nodes() {
    read_count();
    if (!count_) return false;
    bool whole = true;
    for (; done_ < *count_; ++done_) {
      const auto words = row(4);
      if (!words) return false;
      const auto number = words->empty() ? std::nullopt : integer(words->front(), "number of a node");
      whole = whole && number.has_value();
      if (number) add_node(*number, std::span(*words).subspan(1));
    }
    return check_end() && whole;
  }
  void add_node(std::int64_t number, std::span<const std::string_view> words) {
    rows_.add_node(number, rows_.position(words, lines_.number()), lines_.number());
  }

  void read_old_elements() {
    read_count();
    if (!count_) return;
    for (; done_ < *count_; ++done_) {
      const auto words = row(3);
      if (!words) return;
      if (!words->empty()) take_old_element(*words);
    }
    check_end();
  }

  void take_old_element(const Words& words) {
    const auto number = integer(words[0], "number of an element");
    const auto type = integer(words[1], "type of an element");
    const auto tags = integer(words[2], "number of tags");
    if (!number || !type || !tags) return;
    constexpr std::size_t before_tags = 3;
    if (*tags < 0 || *tags > std::ssize(words) - std::ptrdiff_t{before_tags})
      return report("tags",
                    fmt::format("element {} has {} tags, but only {} columns", *number, *tags, words.size()));
    if (is_flat(*type)) return rows_.skip_elements(1);
    const std::optional<ElementKind> kind = kind_of(*type, number);
    if (kind)
      take_element(*number, *kind, std::span(words).subspan(before_tags + static_cast<std::size_t>(*tags)));
  }

  /// What stands in the first row of a section of version 4.1: the number of blocks.
  std::optional<std::int64_t> read_blocks() {
    const auto words = row(4);
    if (!words || words->empty()) return std::nullopt;
    const auto blocks = integer((*words)[0], section_);
    count_ = integer((*words)[1], section_);
    return count_ ? blocks : std::nullopt;
  }
  /// The first row of a block: type of its elements and number of its rows.
  struct Block {
    std::string_view type;
    std::int64_t count = 0;
  };
  std::optional<Block> read_block() {
    const auto words = row(4);
    if (!words || words->empty()) return std::nullopt;
    const auto count = integer((*words)[3], "rows of a block");
    if (!count) return std::nullopt;
    if (*count <= *count_ - done_) return Block{(*words)[2], *count};
    report("end", fmt::format("a block of {} {}; the section {} counts {} in all, and {} stood before",
                              *count, things_, section_, *count_, done_));
    return std::nullopt;
  }

  bool read_nodes() {
    const auto blocks = read_blocks();
    if (!blocks) return false;
    bool whole = true;
    std::vector<std::optional<std::int64_t>> numbers;
    for (std::int64_t b = 0; b < *blocks; ++b) {
      const auto block = read_block();
      if (!block) return false;
      numbers.clear();
      for (std::int64_t k = 0; k < block->count; ++k) {
        const auto words = row(1);
        if (!words) return false;
        numbers.push_back(integer(words->front(), "number of a node"));
      }
      for (const auto& number : numbers) {
        const auto words = row(1);
        if (!words) return false;
        ++done_;
        whole = whole && number.has_value();
        if (number) add_node(*number, *words);
      }
    }
    return check_end() && whole;
  }

  void read_elements() {
    const auto blocks = read_blocks();
    if (!blocks) return;
    for (std::int64_t b = 0; b < *blocks; ++b) {
      const auto block = read_block();
      if (!block) return;
      const auto type = integer(block->type, "type of elements");
      if (!type) return;
      const bool flat = is_flat(*type);
      const std::optional<ElementKind> kind = flat ? std::nullopt : kind_of(*type, std::nullopt);
      for (std::int64_t k = 0; k < block->count; ++k) {
        const auto words = row(1);
        if (!words) return;
        ++done_;
        if (flat) rows_.skip_elements(1);
        if (!kind) continue;
        const auto number = integer(words->front(), "number of an element");
        if (number) take_element(*number, *kind, std::span(*words).subspan(1));
      }
    }
    check_end();
  }

  /// None, with a report at the first, of volumes that are not read.
  std::optional<ElementKind> kind_of(std::int64_t type, std::optional<std::int64_t> element) {
    for (const VolumeType& volume : volume_types)
      if (volume.number == type) return volume.kind;
    if (!reported_types_.insert(type).second) return std::nullopt;
    const auto* const other = std::find_if(other_volumes.begin(), other_volumes.end(),
                                           [&](const auto& entry) { return entry.first == type; });
    report(
        "type",
        fmt::format("{} of type {}{}; read are tetrahedra of 4 nodes (type 4) or 10 (11) and bricks of 8 (5)",
                    element ? fmt::format("element {} is", *element) : std::string("elements"), type,
                    other == other_volumes.end() ? std::string() : fmt::format(", {}", other->second)));
    return std::nullopt;
  }

  void take_element(std::int64_t number, ElementKind kind, std::span<const std::string_view> words) {
    if (std::ssize(words) != nodes_of(kind))
      return report("nodes", fmt::format("element {} has {} nodes; a {} has {}", number, words.size(),
                                         name_of(kind), nodes_of(kind)));
    std::array<std::int64_t, 10> nodes{};
    for (std::size_t k = 0; k < words.size(); ++k) {
      const auto node = integer(words[k], "node of an element");
      if (!node) return;
      nodes[k] = *node;
    }
    // Gmsh has the middle of edge 23 before that of 13.
    if (kind == ElementKind::tet10) std::swap(nodes[8], nodes[9]);
    rows_.add_element(number, kind, std::span(nodes).first(words.size()), lines_.number());
  }

  Lines lines_;
  VolumeMeshRows& rows_;
  bool old_ = false;                   ///< version 2
  std::string_view section_;           ///< the one in hand, as "$Nodes"
  std::string_view things_;            ///< what it holds
  std::optional<std::int64_t> count_;  ///< how many it says to hold
  std::int64_t done_ = 0;              ///< how many it had so far
  std::set<std::int64_t> reported_types_;
};

}  // namespace

void read_gmsh(std::string_view text, VolumeMeshRows& rows) {
  GmshFile(text, rows).read();
}

}  // namespace eigengrain::io
