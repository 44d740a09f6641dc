#pragma once

#include <limits>
#include <string>
#include <string_view>
#include <vector>

/// The one table of what a scene file may say. The reader takes the allowed keys, units, ranges and defaults
/// from it, and docs/scene-schema.md is generated from it.
namespace eigengrain::io {

enum class KeyKind {
  section,       ///< a map of keys
  section_list,  ///< a list of maps
  quantity,      ///< a number, perhaps with a unit
  vector,        ///< three quantities
  vectors,       ///< a list of vectors
  quantities,    ///< a list of them
  integer,
  integers,  ///< a list of whole numbers
  flag,
  text,   ///< a name or a path
  texts,  ///< a list of names
  word,   ///< one word out of a few
  words,  ///< a list of words out of a few
};

/// Valid values of a quantity or integer, or of each of a vector or list of them.
struct Range {
  double low = -std::numeric_limits<double>::infinity();
  double high = std::numeric_limits<double>::infinity();
  bool low_allowed = true;
  bool high_allowed = true;

  bool contains(double value) const;
  /// "> 0", "from 0 up to, but not including, 1"; empty if everything is allowed.
  std::string text() const;
};

/// One key of the scene. Entries of a list are written [], as in materials[].density.
struct KeyDescription {
  std::string path;
  KeyKind kind = KeyKind::quantity;
  std::string unit{};  ///< of a quantity or vector, SI; empty for a pure number
  Range range{};
  bool required = false;             ///< wherever its section stands
  std::string fallback{};            ///< the default as a scene file would write it; empty: none
  std::vector<std::string> words{};  ///< of a word or words
  std::string example{};             ///< a valid value
  std::string description{};
  std::string from_materials{};  ///< keys of materials that say it where it is left out
  std::string law{};  ///< the contact law, or kind of bond, whose parameter it is; empty for all other keys

  /// The last part of the path.
  std::string_view name() const;
  /// The path of the section that the key stands in; empty for the scene itself.
  std::string_view section() const;
};

/// Every key, section after section; parameters of laws come from contact::law_descriptions().
const std::vector<KeyDescription>& scene_schema();

/// The keys of one section; of a contact or bond, those of the law or kind given, or of every one if it is
/// empty.
std::vector<const KeyDescription*> section_keys(std::string_view section, std::string_view law = {});

/// Names of the contact laws that a scene may ask for, "none" included.
std::vector<std::string> law_names();

/// Kinds of bonds that a scene may ask for.
std::vector<std::string> bond_names();

/// The text of docs/scene-schema.md.
std::string schema_markdown();

}  // namespace eigengrain::io
