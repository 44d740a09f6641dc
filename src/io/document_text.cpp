#include "document_text.hpp"

#include <fmt/format.h>

namespace eigengrain::io {
namespace {

std::string quoted(std::string_view text) {
  std::string result = "\"";
  for (const char c : text) {
    const auto code = static_cast<unsigned char>(c);
    if (c == '"' || c == '\\')
      result += fmt::format("\\{}", c);
    else if (code < 0x20 || code == 0x7F)
      result += fmt::format("\\u{:04x}", code);
    else
      result += c;
  }
  return result + '"';
}

void append(const Node& node, std::string& text) {
  switch (node.kind) {
    case Node::Kind::null:
      text += "null";
      return;
    case Node::Kind::scalar:
      text += quoted(node.text);
      return;
    case Node::Kind::list:
    case Node::Kind::map:
      break;
  }
  const bool is_map = node.kind == Node::Kind::map;
  text += is_map ? '{' : '[';
  for (const Node& child : node.children) {
    if (&child != &node.children.front()) text += ", ";
    if (is_map) text += quoted(child.key) + ": ";
    append(child, text);
  }
  text += is_map ? '}' : ']';
}

}  // namespace

std::string node_text(const Node& node) {
  std::string text;
  append(node, text);
  return text;
}

std::string document_text(const Node& root, std::string_view left_out) {
  std::string text;
  for (const Node& child : root.children) {
    if (child.key == left_out) continue;
    text += fmt::format("{}\n{}: ", text.empty() ? "{" : ",", quoted(child.key));
    append(child, text);
  }
  return text.empty() ? "{}\n" : text + "\n}\n";
}

}  // namespace eigengrain::io
