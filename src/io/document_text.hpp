#pragma once

#include "document.hpp"

#include <string>
#include <string_view>

namespace eigengrain::io {

/// A node as YAML on one line, all scalars in quotes.
std::string node_text(const Node& node);

/// The document as JSON, which is YAML too, without the key `left_out` of its root: a line for each of the
/// other keys. Every scalar is a quoted text, since nodes do not say what else it was; what reads YAML here
/// takes numbers and flags from texts.
std::string document_text(const Node& root, std::string_view left_out);

}  // namespace eigengrain::io
