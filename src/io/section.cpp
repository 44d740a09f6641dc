#include "section.hpp"

#include "eigengrain/base/assert.hpp"
#include "eigengrain/io/suggest.hpp"

#include "document_text.hpp"
#include "quantity.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <utility>

namespace eigengrain::io {
namespace {

/// The default of a key as a node, so that defaults are read the way the scene is; nullptr if there is none.
const Node* default_node(const KeyDescription& key) {
  static const std::map<std::string_view, Node> nodes = [] {
    static const std::string file = "default";
    Diagnostics diagnostics;
    std::map<std::string_view, Node> parsed;
    for (const KeyDescription& each : scene_schema())
      if (!each.fallback.empty())
        parsed.try_emplace(each.fallback, parse_yaml(each.fallback, file, diagnostics));
    EIGENGRAIN_ASSERT(!diagnostics.any());
    return parsed;
  }();
  return key.fallback.empty() ? nullptr : &nodes.at(key.fallback);
}

std::string wanted(const KeyDescription& key) {
  switch (key.kind) {
    case KeyKind::section:
      return "a section";
    case KeyKind::section_list:
      return "a list of sections";
    case KeyKind::vector:
      return "a list of three values";
    case KeyKind::vectors:
      return "a list of lists of three values";
    case KeyKind::quantities:
      return "a list of values";
    case KeyKind::integers:
      return "a list of whole numbers";
    case KeyKind::texts:
    case KeyKind::words:
      return "a list of words";
    default:
      return "a single value";
  }
}

std::string example_line(const KeyDescription& key) {
  return fmt::format("\"{}: {}\"", key.name(), key.example);
}

}  // namespace

Section::Section(const Node& node, std::string path, std::string_view pattern, Diagnostics& diagnostics,
                 std::string_view law)
    : node_(&node),
      path_(std::move(path)),
      pattern_(pattern),
      law_(law),
      keys_(section_keys(pattern, law)),
      diagnostics_(&diagnostics) {}

Section Section::with_law(std::string_view law) const {
  return {*node_, path_, pattern_, *diagnostics_, law};
}

void Section::check_keys(std::string_view optional) const {
  for (const Node& child : node_->children) {
    const bool known =
        std::any_of(keys_.begin(), keys_.end(), [&](const auto* key) { return key->name() == child.key; });
    if (!known) report_unknown_key(child);
  }
  // Without its law it is open what a contact needs.
  for (const KeyDescription* key : keys_)
    if (key->required && key->name() != optional && (key->law.empty() || !law_.empty()) && !has(key->name()))
      report_missing(key->name());
}

void Section::report_unknown_key(const Node& child) const {
  std::vector<std::string> names;
  for (const KeyDescription* key : keys_) names.emplace_back(key->name());
  const std::string guess = did_you_mean(child.key, names);
  diagnostics_->add(child.place(), fmt::format("{}: unknown key{} ({})", path_of(child.key), guess, takes()),
                    fmt::format("{}: unknown key", pattern_));
}

std::string Section::takes() const {
  std::vector<std::string_view> names_once;  // laws share some of their keys
  for (const KeyDescription* key : keys_) {
    if (!law_.empty() && key->law.empty()) continue;  // what the user looks for is a parameter of the law
    if (std::find(names_once.begin(), names_once.end(), key->name()) == names_once.end())
      names_once.push_back(key->name());
  }
  const std::string names = fmt::format("{}", fmt::join(names_once, ", "));
  if (!law_.empty())
    return fmt::format("a {} {} takes {}", law_, pattern_.ends_with(".bond") ? "bond" : "contact",
                       names.empty() ? "no parameters" : names);
  if (pattern_.empty()) return fmt::format("a scene takes {}", names);
  return fmt::format("{} takes {}", pattern_, names);
}

std::optional<double> Section::quantity(std::string_view key) const {
  const Node* node = value(key, Node::Kind::scalar);
  return node != nullptr ? read_number(*node, path_of(key), describe(key)) : std::nullopt;
}

std::optional<Vec3> Section::vector(std::string_view key) const {
  const KeyDescription& description = describe(key);
  const Node* node = value(key, Node::Kind::list);
  return node != nullptr ? read_vector(*node, path_of(key), description, description.example) : std::nullopt;
}

std::optional<Vec3> Section::read_vector(const Node& list, const std::string& path, const KeyDescription& key,
                                         std::string_view example) const {
  if (list.children.size() != 3) {
    report_at(list, path, fmt::format("{} values; three are wanted, e.g. {}", list.children.size(), example));
    return std::nullopt;
  }
  Vec3 result;
  bool complete = true;
  for (int k = 0; k < 3; ++k) {
    const auto component = read_number(list.children[k], fmt::format("{}[{}]", path, k), key);
    complete = complete && component.has_value();
    result[k] = component.value_or(0);
  }
  return complete ? std::optional(result) : std::nullopt;
}

std::optional<std::vector<Vec3>> Section::vectors(std::string_view key) const {
  const Node* node = value(key, Node::Kind::list);
  if (node == nullptr) return std::nullopt;
  std::vector<Vec3> result;
  for (std::size_t k = 0; k < node->children.size(); ++k) {
    const Node& child = node->children[k];
    const std::string path = fmt::format("{}[{}]", path_of(key), k);
    if (child.kind != Node::Kind::list) {
      report_at(child, path,
                fmt::format("{} stands where a list of three values is wanted, e.g. [0, 0, 0]",
                            kind_name(child.kind)));
    } else if (const auto vector = read_vector(child, path, describe(key), "[0, 0, 0]")) {
      result.push_back(*vector);
    }
  }
  return result.size() == node->children.size() ? std::optional(result) : std::nullopt;
}

std::optional<std::vector<double>> Section::quantities(std::string_view key) const {
  const Node* list = value(key, Node::Kind::list);
  if (list == nullptr) return std::nullopt;
  std::vector<double> result;
  for (std::size_t k = 0; k < list->children.size(); ++k) {
    const auto number = read_number(list->children[k], fmt::format("{}[{}]", path_of(key), k), describe(key));
    if (number) result.push_back(*number);
  }
  return result.size() == list->children.size() ? std::optional(result) : std::nullopt;
}

std::optional<std::int64_t> Section::integer(std::string_view key) const {
  const Node* node = value(key, Node::Kind::scalar);
  return node != nullptr ? read_whole_number(*node, path_of(key), describe(key)) : std::nullopt;
}

std::optional<std::vector<std::int64_t>> Section::integers(std::string_view key) const {
  const Node* given = node_->find(key);
  if (given != nullptr && given->kind == Node::Kind::scalar) {
    const auto number = integer(key);
    return number ? std::optional(std::vector{*number}) : std::nullopt;
  }
  const Node* list = value(key, Node::Kind::list);
  if (list == nullptr) return std::nullopt;
  std::vector<std::int64_t> result;
  for (std::size_t k = 0; k < list->children.size(); ++k) {
    const auto number =
        read_whole_number(list->children[k], fmt::format("{}[{}]", path_of(key), k), describe(key));
    if (number) result.push_back(*number);
  }
  return result.size() == list->children.size() ? std::optional(result) : std::nullopt;
}

std::optional<bool> Section::flag(std::string_view key) const {
  const Node* node = value(key, Node::Kind::scalar);
  if (node == nullptr) return std::nullopt;
  if (node->text == "true") return true;
  if (node->text == "false") return false;
  report(key, fmt::format("\"{}\"; write true or false", node->text));
  return std::nullopt;
}

std::optional<std::string> Section::text(std::string_view key) const {
  const Node* node = value(key, Node::Kind::scalar);
  return node != nullptr ? read_word(*node, path_of(key), describe(key)) : std::nullopt;
}

std::optional<std::vector<std::string>> Section::texts(std::string_view key) const {
  const Node* given = node_->find(key);
  if (given != nullptr && given->kind == Node::Kind::scalar) {
    const auto word = text(key);
    return word ? std::optional(std::vector{*word}) : std::nullopt;
  }
  const Node* list = value(key, Node::Kind::list);
  if (list == nullptr) return std::nullopt;
  std::vector<std::string> result;
  for (std::size_t k = 0; k < list->children.size(); ++k) {
    const auto word = read_word(list->children[k], fmt::format("{}[{}]", path_of(key), k), describe(key));
    if (word) result.push_back(*word);
  }
  return result.size() == list->children.size() ? std::optional(result) : std::nullopt;
}

std::optional<Section> Section::section(std::string_view key) const {
  const Node* node = value(key, Node::Kind::map);
  if (node == nullptr) return std::nullopt;
  return Section(*node, path_of(key), describe(key).path, *diagnostics_);
}

std::vector<Section> Section::sections(std::string_view key) const {
  std::vector<Section> result;
  const Node* node = value(key, Node::Kind::list);
  if (node == nullptr) return result;
  const KeyDescription& description = describe(key);
  const std::string pattern = description.path + "[]";
  for (std::size_t k = 0; k < node->children.size(); ++k) {
    const Node& child = node->children[k];
    std::string path = fmt::format("{}[{}]", path_of(key), k);
    if (child.kind == Node::Kind::map)
      result.emplace_back(child, std::move(path), pattern, *diagnostics_);
    else
      report_at(child, path,
                fmt::format("{} stands where a section is wanted, e.g. \"{}: {}\"", kind_name(child.kind),
                            key, description.example));
  }
  return result;
}

std::vector<FreeKey> Section::free_keys(std::string_view key) const {
  std::vector<FreeKey> result;
  if (const Node* node = value(key, Node::Kind::map))
    for (const Node& child : node->children) result.push_back({child.key, node_text(child)});
  return result;
}

std::optional<double> Section::read_number(const Node& node, const std::string& path,
                                           const KeyDescription& key) const {
  if (node.kind != Node::Kind::scalar) {
    report_at(node, path, fmt::format("{} stands where a number is wanted", kind_name(node.kind)));
    return std::nullopt;
  }
  const auto [number, problem] = read_quantity(node.text, key.unit);
  if (!number) {
    report_at(node, path, problem);
  } else if (!key.range.contains(*number)) {
    report_at(node, path,
              fmt::format("\"{}\" is out of range; a value {} is wanted, e.g. {}", node.text,
                          key.range.text(), example_line(key)));
  } else {
    return number;
  }
  return std::nullopt;
}

std::optional<std::int64_t> Section::read_whole_number(const Node& node, const std::string& path,
                                                       const KeyDescription& key) const {
  if (node.kind != Node::Kind::scalar) {
    report_at(node, path,
              fmt::format("{} stands where a whole number is wanted, e.g. {}", kind_name(node.kind),
                          example_line(key)));
    return std::nullopt;
  }
  const auto [number, problem] = read_integer(node.text);
  if (!number)
    report_at(node, path, problem);
  else if (!key.range.contains(static_cast<double>(*number)))
    report_at(node, path, fmt::format("{}; a whole number {} is wanted", *number, key.range.text()));
  else
    return number;
  return std::nullopt;
}

std::optional<std::string> Section::read_word(const Node& node, const std::string& path,
                                              const KeyDescription& key) const {
  if (node.kind != Node::Kind::scalar || node.text.empty()) {
    const std::string_view found = node.kind == Node::Kind::scalar ? "an empty text" : kind_name(node.kind);
    report_at(node, path, fmt::format("{} stands where a word is wanted, e.g. {}", found, example_line(key)));
    return std::nullopt;
  }
  if (key.words.empty() || std::find(key.words.begin(), key.words.end(), node.text) != key.words.end())
    return node.text;
  std::string choice;
  for (const std::string& word : key.words) choice += fmt::format("{}{}", choice.empty() ? "" : ", ", word);
  report_at(node, path,
            fmt::format("\"{}\" is none of {}{}", node.text, choice, did_you_mean(node.text, key.words)));
  return std::nullopt;
}

/// The node of a key, or its default, if it is of the kind wanted; what stands there otherwise is reported.
const Node* Section::value(std::string_view key, Node::Kind kind) const {
  const KeyDescription& description = describe(key);
  const Node* node = node_->find(key);
  if (node == nullptr) return default_node(description);
  if (node->kind == kind) return node;
  if (node->kind == Node::Kind::null)
    report(key, fmt::format("empty; give it a value, e.g. {}, or remove the key", example_line(description)));
  else
    report(key, fmt::format("{} stands where {} is wanted, e.g. {}", kind_name(node->kind),
                            wanted(description), example_line(description)));
  return nullptr;
}

Place Section::place(std::string_view key) const {
  const Node* node = node_->find(key);
  return node != nullptr ? node->place() : place();
}

void Section::report(std::string_view key, std::string_view message) const {
  const Node* node = node_->find(key);
  report_at(node != nullptr ? *node : *node_, path_of(key), message);
}

void Section::report(std::string_view message) const {
  report_at(*node_, path_, message);
}

void Section::report_missing(std::string_view key, std::string_view why) const {
  const std::string section = path_.empty() ? "" : path_ + ": ";
  diagnostics_->add(
      place(), fmt::format("{}{} is missing{}; add e.g. {}", section, key, why, example_line(describe(key))),
      fmt::format("{}.{} missing", pattern_, key));
}

void Section::report_at(const Node& node, std::string_view path, std::string_view message) const {
  // In a long list the same key is likely to have the same mistake, whatever the entry.
  const std::string_view inside = path.substr(std::min(path.size(), path_.size()));
  diagnostics_->add(node.place(), path.empty() ? std::string(message) : fmt::format("{}: {}", path, message),
                    fmt::format("{}{}", pattern_, inside));
}

const KeyDescription& Section::describe(std::string_view key) const {
  const auto found =
      std::find_if(keys_.begin(), keys_.end(), [&](const auto* k) { return k->name() == key; });
  EIGENGRAIN_ASSERT(found != keys_.end(), pattern_, key);
  return **found;
}

std::string Section::path_of(std::string_view key) const {
  return path_.empty() ? std::string(key) : fmt::format("{}.{}", path_, key);
}

}  // namespace eigengrain::io
