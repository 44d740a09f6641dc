#include "document.hpp"

#include <fmt/format.h>
#include <yaml-cpp/eventhandler.h>
#include <yaml-cpp/exceptions.h>
#include <yaml-cpp/parser.h>

#include <algorithm>
#include <map>
#include <sstream>
#include <utility>

namespace eigengrain::io {
namespace {

int line_of(const YAML::Mark& mark) {
  return mark.is_null() ? 0 : mark.line + 1;
}

std::size_t count_nodes(const Node& node) {
  std::size_t count = 1;
  for (const Node& child : node.children) count += count_nodes(child);
  return count;
}

/// Builds the tree of nodes from the events of the parser.
class TreeBuilder final : public YAML::EventHandler {
 public:
  TreeBuilder(const std::string& file, Diagnostics& diagnostics) : file_(file), diagnostics_(diagnostics) {}

  Node result() { return std::move(root_); }

  void OnDocumentStart(const YAML::Mark& mark) override {
    if (documents_++ > 0)
      throw YAML::ParserException(mark, "a second document begins; one file holds one scene");
  }
  void OnDocumentEnd() override {}
  void OnNull(const YAML::Mark& mark, YAML::anchor_t anchor) override {
    take(make(Node::Kind::null, mark), anchor);
  }
  void OnScalar(const YAML::Mark& mark, const std::string& /*tag*/, YAML::anchor_t anchor,
                const std::string& value) override {
    Node node = make(Node::Kind::scalar, mark);
    node.text = value;
    take(std::move(node), anchor);
  }
  void OnAlias(const YAML::Mark& mark, YAML::anchor_t anchor) override {
    const auto known = anchored_.find(anchor);
    if (known == anchored_.end())
      throw YAML::ParserException(mark, "an alias cannot be part of what it names");
    copied_ += count_nodes(known->second);
    if (copied_ > largest_copy) throw YAML::ParserException(mark, "the aliases repeat too much");
    take(known->second, 0);
  }
  void OnSequenceStart(const YAML::Mark& mark, const std::string& /*tag*/, YAML::anchor_t anchor,
                       YAML::EmitterStyle::value /*style*/) override {
    open_.push_back({make(Node::Kind::list, mark), anchor});
  }
  void OnMapStart(const YAML::Mark& mark, const std::string& /*tag*/, YAML::anchor_t anchor,
                  YAML::EmitterStyle::value /*style*/) override {
    open_.push_back({make(Node::Kind::map, mark), anchor});
  }
  void OnSequenceEnd() override { close(); }
  void OnMapEnd() override {
    report_repeated_keys(open_.back().node);
    close();
  }

 private:
  /// A list or map whose end has not been read yet.
  struct Open {
    Node node;
    YAML::anchor_t anchor = 0;
    bool has_key = false;  ///< of a map: whether the next node is a value
    std::string key{};
    int key_line = 0;
  };

  /// Enough for any scene; stops short texts that unfold to billions of nodes.
  static constexpr std::size_t largest_copy = 1'000'000;

  Node make(Node::Kind kind, const YAML::Mark& mark) const {
    return {.kind = kind, .line = line_of(mark), .file = &file_, .children = {}};
  }

  void close() {
    Open done = std::move(open_.back());
    open_.pop_back();
    take(std::move(done.node), done.anchor);
  }

  void take(Node node, YAML::anchor_t anchor) {
    if (anchor != 0) anchored_[anchor] = node;
    if (open_.empty()) {
      root_ = std::move(node);
    } else if (open_.back().node.kind == Node::Kind::list) {
      open_.back().node.children.push_back(std::move(node));
    } else if (!open_.back().has_key) {
      take_key(node);
    } else {
      take_value(std::move(node));
    }
  }

  void take_key(const Node& node) {
    Open& map = open_.back();
    if (node.kind != Node::Kind::scalar)
      diagnostics_.add(node.place(), fmt::format("{} stands where a key is wanted", kind_name(node.kind)));
    map.has_key = true;
    map.key = node.text;
    map.key_line = node.line;
  }

  void take_value(Node node) {
    Open& map = open_.back();
    map.has_key = false;
    node.key = std::move(map.key);
    node.line = map.key_line;
    map.node.children.push_back(std::move(node));
  }

  /// yaml-cpp keeps both values of a repeated key without a word.
  void report_repeated_keys(Node& map) {
    std::map<std::string_view, int> first_line;
    for (const Node& child : map.children) {
      const auto [known, added] = first_line.try_emplace(child.key, child.line);
      if (!added)
        diagnostics_.add(child.place(), fmt::format("the key \"{}\" stands twice in one section, first on "
                                                    "line {}; keep one of the two",
                                                    child.key, known->second));
    }
  }

  const std::string& file_;
  Diagnostics& diagnostics_;
  Node root_{.file = &file_, .children = {}};
  std::vector<Open> open_;
  std::map<YAML::anchor_t, Node> anchored_;
  std::size_t copied_ = 0;
  int documents_ = 0;
};

template <class Children>
auto find_child(Children& children, std::string_view name) -> decltype(children.data()) {
  const auto found =
      std::find_if(children.begin(), children.end(), [&](const Node& n) { return n.key == name; });
  return found == children.end() ? nullptr : &*found;
}

}  // namespace

const Node* Node::find(std::string_view name) const {
  return kind == Kind::map ? find_child(children, name) : nullptr;
}

Node* Node::find(std::string_view name) {
  return kind == Kind::map ? find_child(children, name) : nullptr;
}

void clear_lines(Node& node) {
  node.line = 0;
  for (Node& child : node.children) clear_lines(child);
}

std::string_view kind_name(Node::Kind kind) {
  switch (kind) {
    case Node::Kind::null:
      return "nothing";
    case Node::Kind::scalar:
      return "a single value";
    case Node::Kind::list:
      return "a list";
    case Node::Kind::map:
      return "a section";
  }
  return {};
}

Node parse_yaml(std::string_view text, const std::string& file, Diagnostics& diagnostics) {
  TreeBuilder builder(file, diagnostics);
  try {
    std::istringstream input{std::string(text)};
    YAML::Parser parser(input);
    while (parser.HandleNextDocument(builder)) continue;
  } catch (const YAML::Exception& error) {
    diagnostics.add({file, line_of(error.mark)}, fmt::format("not valid YAML: {}", error.msg));
  }
  return builder.result();
}

}  // namespace eigengrain::io
