#include "text_columns.hpp"
#include "volume_mesh_formats.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <set>
#include <span>
#include <string>
#include <utility>
#include <vector>

namespace eigengrain::io {
namespace {

using model::ElementKind;

constexpr std::array<std::pair<std::string_view, ElementKind>, 3> volume_types{
    {{"C3D4", ElementKind::tet4}, {"C3D8", ElementKind::hex8}, {"C3D10", ElementKind::tet10}}};

/// How the names of elements begin that are no volumes: points, springs, lines, faces, shells.
constexpr std::array<std::string_view, 36> flat_types{
    "MASS",  "ROTARYI", "SPRING", "DASHPOT", "CONN", "DCOUP", "GAP",  "T2D", "T3D",  "B2",   "B3",   "PIPE",
    "ELBOW", "S3",      "S4",     "S8",      "S9",   "STRI",  "SAX",  "DS",  "M3D",  "MAX",  "SFM",  "R2D",
    "R3D",   "RAX",     "RB2D",   "RB3D",    "CPS",  "CPE",   "CGPE", "CAX", "CGAX", "DC1D", "DC2D", "DCAX"};

/// Keywords that make nodes or elements, or put them elsewhere.
constexpr std::array<std::string_view, 8> generators{"NGEN",  "NFILL",  "NCOPY",  "NMAP",
                                                     "ELGEN", "ELCOPY", "SYSTEM", "PARAMETER"};

std::string_view trimmed(std::string_view text) {
  constexpr std::string_view blanks = " \t\r\v\f";
  const std::size_t first = text.find_first_not_of(blanks);
  if (first == std::string_view::npos) return {};
  return text.substr(first, text.find_last_not_of(blanks) - first + 1);
}

std::string in_capitals(std::string_view text) {
  std::string result(text);
  for (char& c : result) c = static_cast<char>(std::toupper(static_cast<unsigned char>(c)));
  return result;
}

/// What stands between commas, without a last one that is empty.
void split(std::string_view line, std::vector<std::string_view>& fields) {
  fields.clear();
  while (!line.empty()) {
    const std::size_t end = std::min(line.find(','), line.size());
    fields.push_back(trimmed(line.substr(0, end)));
    line.remove_prefix(std::min(end + 1, line.size()));
  }
  if (!fields.empty() && fields.back().empty()) fields.pop_back();
}

/// A line that begins with a star: "*ELEMENT, TYPE=C3D4".
struct Keyword {
  std::string name;                                           ///< in capitals, without the star
  std::vector<std::pair<std::string, std::string>> settings;  ///< in capitals

  const std::string* find(std::string_view key) const {
    for (const auto& [name_of_it, value] : settings)
      if (name_of_it == key) return &value;
    return nullptr;
  }
};

class AbaqusFile {
 public:
  AbaqusFile(std::string_view text, VolumeMeshRows& rows) : lines_(text), rows_(rows) {}

  void read() {
    while (const auto untrimmed = lines_.next()) {
      const std::string_view line = trimmed(*untrimmed);
      if (line.empty() || line.starts_with("**")) continue;
      if (line.front() == '*') {
        end_element();
        take_keyword(keyword_of(line));
      } else if (holds_ == Holds::nodes) {
        take_node(line);
      } else if (holds_ == Holds::elements) {
        take_element_line(line);
      } else if (holds_ == Holds::flat_elements) {
        rows_.skip_elements(1);
      }
    }
    end_element();
  }

 private:
  enum class Holds : std::uint8_t { nothing, nodes, elements, flat_elements };

  void report(std::string_view kind, std::string message) {
    rows_.report(lines_.number(), kind, std::move(message));
  }

  Keyword keyword_of(std::string_view line) {
    std::string whole(line);
    while (whole.back() == ',') {
      const auto more = lines_.next();
      if (!more) break;
      if (const std::string_view text = trimmed(*more); !text.starts_with("**"))
        whole += ' ' + std::string(text);
    }
    split(whole, fields_);
    Keyword keyword;
    for (const std::string_view field : fields_) {
      const std::size_t equals = std::min(field.find('='), field.size());
      keyword.settings.emplace_back(in_capitals(trimmed(field.substr(0, equals))),
                                    in_capitals(trimmed(field.substr(std::min(equals + 1, field.size())))));
    }
    keyword.name = keyword.settings.front().first.substr(1);
    return keyword;
  }

  void take_keyword(const Keyword& keyword) {
    holds_ = Holds::nothing;
    if (keyword.name == "NODE") {
      // Nodes of the assembly itself are reference points, with numbers of their own.
      if (no_other_place(keyword) && (!in_assembly_ || in_instance_)) holds_ = Holds::nodes;
    } else if (keyword.name == "ELEMENT") {
      if (no_other_place(keyword)) begin_elements(keyword);
    } else if (keyword.name == "INCLUDE") {
      report("include", "*INCLUDE is not followed; put the text of that file into this one");
    } else if (std::find(generators.begin(), generators.end(), keyword.name) != generators.end()) {
      report("generator",
             fmt::format(
                 "*{} is not followed; write all nodes and elements themselves, under *NODE and *ELEMENT",
                 keyword.name));
    } else if (keyword.name == "ASSEMBLY" || keyword.name == "END ASSEMBLY") {
      in_assembly_ = keyword.name == "ASSEMBLY";
    } else if (keyword.name == "INSTANCE" || keyword.name == "END INSTANCE") {
      in_instance_ = keyword.name == "INSTANCE";
    }
  }

  bool no_other_place(const Keyword& keyword) {
    if (keyword.find("INPUT") != nullptr) {
      report("include",
             fmt::format("*{}, INPUT is not followed; put the text of that file here", keyword.name));
      return false;
    }
    if (const std::string* system = keyword.find("SYSTEM"); system != nullptr && *system != "R") {
      report("system", fmt::format("coordinates of SYSTEM={}; write rectangular ones", *system));
      return false;
    }
    return true;
  }

  void begin_elements(const Keyword& keyword) {
    const std::string* const type = keyword.find("TYPE");
    if (type == nullptr) return report("type", "*ELEMENT without a TYPE; write e.g. \"*ELEMENT, TYPE=C3D4\"");
    for (const auto& [name, kind] : volume_types)
      if (name == *type) {
        type_ = name;
        kind_ = kind;
        holds_ = Holds::elements;
        return;
      }
    if (std::any_of(flat_types.begin(), flat_types.end(),
                    [&](std::string_view t) { return type->starts_with(t); }))
      holds_ = Holds::flat_elements;
    else if (reported_types_.insert(*type).second)
      report("type",
             fmt::format("elements of TYPE={}; read are C3D4 and C3D10 (tetrahedra) and C3D8 (bricks): write "
                         "one of these, or leave out elements that are no volumes",
                         *type));
  }

  void take_node(std::string_view line) {
    split(line, fields_);
    if (fields_.empty()) return;
    const auto number = rows_.integer(fields_.front(), "number of a node", lines_.number());
    if (!number) return rows_.lose_nodes();
    rows_.add_node(*number, rows_.position(std::span(fields_).subspan(1), lines_.number()), lines_.number());
  }

  /// An element may go on over several lines: all but the last end with a comma.
  void take_element_line(std::string_view line) {
    if (numbers_.empty()) first_line_ = lines_.number();
    split(line, fields_);
    for (const std::string_view field : fields_) {
      const auto number = rows_.integer(
          field, numbers_.empty() ? "number of an element" : "node of an element", lines_.number());
      readable_ = readable_ && number.has_value();
      numbers_.push_back(number.value_or(0));
    }
    if (line.back() != ',' || std::ssize(numbers_) > nodes_of(kind_)) end_element();
  }

  void end_element() {
    if (!numbers_.empty() && readable_) {
      const std::span<const std::int64_t> nodes = std::span<const std::int64_t>(numbers_).subspan(1);
      if (std::ssize(nodes) == nodes_of(kind_))
        rows_.add_element(numbers_.front(), kind_, nodes, first_line_);
      else
        rows_.report(
            first_line_, "nodes",
            fmt::format("element {} has {} nodes; a {} has {} (a line that goes on in the next one ends "
                        "with a comma)",
                        numbers_.front(), nodes.size(), type_, nodes_of(kind_)));
    }
    numbers_.clear();
    readable_ = true;
  }

  Lines lines_;
  VolumeMeshRows& rows_;
  Holds holds_ = Holds::nothing;  ///< what stands in the lines below the last keyword
  bool in_assembly_ = false;
  bool in_instance_ = false;
  std::string_view type_;  ///< of the elements in hand
  ElementKind kind_ = ElementKind::tet4;
  std::vector<std::int64_t> numbers_;  ///< of the element in hand and its nodes so far
  bool readable_ = true;               ///< all of them
  std::int32_t first_line_ = 0;        ///< of it
  std::set<std::string> reported_types_;
  std::vector<std::string_view> fields_;
};

}  // namespace

void read_abaqus_input(std::string_view text, VolumeMeshRows& rows) {
  AbaqusFile(text, rows).read();
}

}  // namespace eigengrain::io
