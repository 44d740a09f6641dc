#pragma once

#include "diagnostics.hpp"

#include <deque>
#include <string>
#include <string_view>
#include <vector>

namespace eigengrain::io {

/// One value of a YAML document. Unlike yaml-cpp's own nodes it knows the line of its key, which text it
/// comes from, and it cannot be shared or part of itself.
struct Node {
  enum class Kind { null, scalar, list, map };

  Kind kind = Kind::null;
  std::string text{};          ///< of a scalar
  std::string key{};           ///< under which it stands, if its parent is a map
  int line = 0;                ///< 1-based; of the key, if there is one
  const std::string* file{};   ///< the scene, or the override that put it there
  std::vector<Node> children;  ///< of a list or map

  Place place() const { return {*file, line}; }
  /// The child of that key, or nullptr.
  const Node* find(std::string_view name) const;
  Node* find(std::string_view name);
};

/// A document, and the names of the texts that its nodes come from.
struct Document {
  std::deque<std::string> files{};  ///< a deque: nodes point to its elements
  Node root{};
};

/// Reads one YAML document. A mistake of syntax, a key given twice and a key that is no plain word are
/// reported; what can be read is returned. `file` outlives the result.
Node parse_yaml(std::string_view text, const std::string& file, Diagnostics& diagnostics);

/// For what was read of the command line, where lines mean nothing.
void clear_lines(Node& node);

/// "a list", "a section", "a single value", "nothing".
std::string_view kind_name(Node::Kind kind);

}  // namespace eigengrain::io
