#pragma once

#include "eigengrain/base/vec.hpp"
#include "eigengrain/io/schema.hpp"

#include "document.hpp"

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace eigengrain::io {

/// A key of a section that may have any, with its value as YAML.
struct FreeKey {
  std::string key;
  std::string value;
};

/// A light view of one section of the scene. Its getters know from the schema which kind, unit, range and
/// default a key has; what does not fit is reported with its place, and the getter returns nothing.
class Section {
 public:
  /// pattern: the section's path in the schema ("balls[]"); path: its own ("balls[3]").
  Section(const Node& node, std::string path, std::string_view pattern, Diagnostics& diagnostics,
          std::string_view law = {});

  /// The same section of a contact whose law is known, so that only this law's parameters are keys.
  Section with_law(std::string_view law) const;

  /// Reports the keys that the schema does not know, and the required ones that are missing; but `optional`
  /// may be.
  void check_keys(std::string_view optional = {}) const;

  bool has(std::string_view key) const { return node_->find(key) != nullptr; }
  std::optional<double> quantity(std::string_view key) const;
  std::optional<Vec3> vector(std::string_view key) const;
  std::optional<std::vector<Vec3>> vectors(std::string_view key) const;
  std::optional<std::vector<double>> quantities(std::string_view key) const;
  std::optional<std::int64_t> integer(std::string_view key) const;
  /// A list of whole numbers; a single one counts as a list.
  std::optional<std::vector<std::int64_t>> integers(std::string_view key) const;
  std::optional<bool> flag(std::string_view key) const;
  /// A text, or one word out of the schema's.
  std::optional<std::string> text(std::string_view key) const;
  /// A list of texts, or of words out of the schema's; a single one counts as a list.
  std::optional<std::vector<std::string>> texts(std::string_view key) const;
  std::optional<Section> section(std::string_view key) const;
  std::vector<Section> sections(std::string_view key) const;
  /// All keys of a section that the schema leaves open.
  std::vector<FreeKey> free_keys(std::string_view key) const;

  /// A mistake at the key, or where the section begins if the key is absent.
  void report(std::string_view key, std::string_view message) const;
  /// A mistake of the section as a whole.
  void report(std::string_view message) const;
  /// "`radius` is missing; add e.g. ..."
  void report_missing(std::string_view key, std::string_view why = {}) const;

  const std::string& path() const { return path_; }
  Place place() const { return node_->place(); }
  /// Of the key, or where the section begins if the key is absent.
  Place place(std::string_view key) const;
  Diagnostics& diagnostics() const { return *diagnostics_; }

 private:
  const KeyDescription& describe(std::string_view key) const;
  const Node* value(std::string_view key, Node::Kind kind) const;
  std::optional<double> read_number(const Node& node, const std::string& path,
                                    const KeyDescription& key) const;
  std::optional<Vec3> read_vector(const Node& list, const std::string& path, const KeyDescription& key,
                                  std::string_view example) const;
  std::optional<std::int64_t> read_whole_number(const Node& node, const std::string& path,
                                                const KeyDescription& key) const;
  std::optional<std::string> read_word(const Node& node, const std::string& path,
                                       const KeyDescription& key) const;
  void report_unknown_key(const Node& child) const;
  void report_at(const Node& node, std::string_view path, std::string_view message) const;
  std::string path_of(std::string_view key) const;
  std::string takes() const;

  const Node* node_;
  std::string path_;
  std::string pattern_;
  std::string_view law_;
  std::vector<const KeyDescription*> keys_;
  Diagnostics* diagnostics_;
};

}  // namespace eigengrain::io
