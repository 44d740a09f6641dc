#include "overrides.hpp"

#include "parsed.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <system_error>

namespace eigengrain::io {
namespace {

/// "contacts.0.kn" or "contacts[0].kn" -> contacts, 0, kn.
std::vector<std::string> split_path(std::string_view path) {
  std::vector<std::string> parts(1);
  for (const char c : path) {
    if (c == '.' || c == '[')
      parts.emplace_back();
    else if (c != ']' && c != ' ')
      parts.back() += c;
  }
  return parts;
}

Parsed<Node*> list_entry(Node& list, const std::string& part) {
  std::size_t index = 0;
  const auto [end, error] = std::from_chars(part.data(), part.data() + part.size(), index);
  const std::size_t count = list.children.size();
  if (error == std::errc() && end == part.data() + part.size() && index < count)
    return {.value = &list.children[index]};
  if (count == 0) return {.problem = fmt::format("\"{}\" is an entry of a list that has none", part)};
  return {.problem = fmt::format("\"{}\" is no entry of the list; its {} entries are numbered from 0 to {}",
                                 part, count, count - 1)};
}

/// The child that a part of the path names, made if it does not exist.
Parsed<Node*> descend(Node& node, const std::string& part, const std::string& file) {
  if (node.kind == Node::Kind::list) return list_entry(node, part);
  if (node.kind == Node::Kind::scalar)
    return {.problem = fmt::format("what stands before \"{}\" is a single value and has no keys", part)};
  if (node.kind == Node::Kind::null) node.kind = Node::Kind::map;
  if (Node* child = node.find(part)) return {.value = child};
  node.children.push_back({.key = part, .file = &file, .children = {}});
  return {.value = &node.children.back()};
}

void apply(const std::string& text, const std::string& file, Node& root, Diagnostics& diagnostics) {
  const std::size_t equals = text.find('=');
  const std::vector<std::string> parts = split_path(std::string_view(text).substr(0, equals));
  const bool complete = std::none_of(parts.begin(), parts.end(), [](const auto& p) { return p.empty(); });
  if (equals == std::string::npos || !complete)
    return diagnostics.add({file, 0}, "not of the form key=value; write e.g. \"timestep.safety=0.5\"");

  Diagnostics of_value;
  Node value = parse_yaml(std::string_view(text).substr(equals + 1), file, of_value);
  for (const Mistake& mistake : of_value.mistakes()) diagnostics.add({file, 0}, mistake.message);
  if (of_value.any()) return;

  Node* target = &root;
  for (const std::string& part : parts) {
    const auto [child, problem] = descend(*target, part, file);
    if (!child) return diagnostics.add({file, 0}, problem);
    target = *child;
  }
  clear_lines(value);
  value.key = target->key;
  *target = std::move(value);
}

}  // namespace

void apply_overrides(std::span<const std::string> overrides, std::string_view origin, Document& document,
                     Diagnostics& diagnostics) {
  for (const std::string& text : overrides) {
    const std::string& file = document.files.emplace_back(fmt::format("{} {}", origin, text));
    apply(text, file, document.root, diagnostics);
  }
}

}  // namespace eigengrain::io
