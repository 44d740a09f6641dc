#include "volume_mesh_rows.hpp"

#include "quantity.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cstddef>
#include <system_error>

namespace eigengrain::io {

using model::ElementKind;
using model::MeshProblem;

class VolumeMeshRows::Index {
 public:
  explicit Index(std::span<const std::int64_t> numbers) {
    for (std::size_t row = 0; row < numbers.size(); ++row)
      sorted_.emplace_back(numbers[row], static_cast<std::int32_t>(row));
    if (!std::is_sorted(sorted_.begin(), sorted_.end())) std::sort(sorted_.begin(), sorted_.end());
  }

  /// The row of the node, or none.
  std::optional<std::int32_t> find(std::int64_t number) const {
    if (sorted_.empty() || number < sorted_.front().first || number > sorted_.back().first)
      return std::nullopt;
    // Without gaps the node is as many behind the first one as its number says.
    const auto offset =
        static_cast<std::uint64_t>(number) - static_cast<std::uint64_t>(sorted_.front().first);
    if (offset < sorted_.size() && sorted_[offset].first == number) return sorted_[offset].second;
    const auto found = std::lower_bound(sorted_.begin(), sorted_.end(), std::pair(number, std::int32_t{0}));
    if (found->first != number) return std::nullopt;
    return found->second;
  }
  /// Calls visit(row, first row) for every node whose number another one has.
  template <class Visit>
  void for_each_repeated(const Visit& visit) const {
    for (std::size_t k = 1, first = 0; k < sorted_.size(); ++k)
      if (sorted_[k].first == sorted_[first].first)
        visit(static_cast<std::size_t>(sorted_[k].second), static_cast<std::size_t>(sorted_[first].second));
      else
        first = k;
  }
  std::string text() const {
    if (sorted_.empty()) return "there are none";
    return fmt::format("they are {} to {}", sorted_.front().first, sorted_.back().first);
  }

 private:
  std::vector<std::pair<std::int64_t, std::int32_t>> sorted_;  ///< number and row
};

void VolumeMeshRows::report(std::int32_t line, std::string_view kind, std::string message) {
  wrong_ = true;
  diagnostics_.add({name_, line}, std::move(message), kind);
}

std::optional<std::int64_t> VolumeMeshRows::integer(std::string_view word, std::string_view what,
                                                    std::int32_t line) {
  std::int64_t value = 0;
  const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), value);
  if (error == std::errc() && end == word.data() + word.size()) return value;
  report(line, "integer", fmt::format("{}: \"{}\" is not a whole number", what, word));
  return std::nullopt;
}

std::optional<Vec3> VolumeMeshRows::position(std::span<const std::string_view> words, std::int32_t line) {
  if (words.size() < 3) {
    report(line, "coordinates", fmt::format("{} coordinates; three are wanted", words.size()));
    return std::nullopt;
  }
  Vec3 x;
  for (int k = 0; k < 3; ++k) {
    const std::string_view word = words[static_cast<std::size_t>(k)];
    const auto [number, problem] = read_leading_number(word, "a coordinate is a plain number");
    if (!number || !number->rest.empty()) {
      report(line, "number",
             fmt::format("\"{}\" {}", word,
                         number ? "is not a number; a coordinate is a plain number" : problem));
      return std::nullopt;
    }
    x[k] = number->value;
  }
  return x;
}

void VolumeMeshRows::add_node(std::int64_t number, const std::optional<Vec3>& position, std::int32_t line) {
  positions_.push_back(position.value_or(Vec3::Zero()));
  node_numbers_.push_back(number);
  node_lines_.push_back(line);
}

void VolumeMeshRows::add_element(std::int64_t number, ElementKind kind, std::span<const std::int64_t> nodes,
                                 std::int32_t line) {
  if (element_numbers_.empty()) mesh_.kind = kind;
  if (kind != mesh_.kind) {
    if (!mixed_)
      report(
          line, {},
          fmt::format("{0} {1} is a {2}, and {0} {3} on line {4} a {5}; write elements of one kind, and of "
                      "each kind a file of its own",
                      words_.element, number, name_of(kind), element_numbers_.front(), element_lines_.front(),
                      name_of(mesh_.kind)));
    mixed_ = true;
    return;
  }
  element_numbers_.push_back(number);
  element_lines_.push_back(line);
  element_nodes_.insert(element_nodes_.end(), nodes.begin(), nodes.end());
}

bool VolumeMeshRows::find_nodes(const Index& index) {
  const auto per_element = static_cast<std::size_t>(nodes_of(mesh_.kind));
  mesh_.elements.resize(element_nodes_.size());
  for (std::size_t k = 0; k < element_nodes_.size(); ++k) {
    const std::optional<std::int32_t> row = index.find(element_nodes_[k]);
    mesh_.elements[k] = row.value_or(0);
    if (row || some_lost_) continue;
    const std::size_t e = k / per_element;
    report(element_lines_[e], "no node",
           fmt::format("{} {} names {} {}, which does not exist ({})", words_.element, element_numbers_[e],
                       words_.node, element_nodes_[k], index.text()));
  }
  return !wrong_;
}

/// Meshers leave points of their geometry and of the faces that they do not write.
void VolumeMeshRows::keep_used_nodes(double unit) {
  std::vector<std::int32_t> kept(positions_.size(), -1);
  for (const std::int32_t row : mesh_.elements) kept[static_cast<std::size_t>(row)] = 0;
  for (std::size_t row = 0; row < kept.size(); ++row) {
    if (kept[row] < 0) continue;
    kept[row] = mesh_.node_count();
    mesh_.nodes.emplace_back(unit * positions_[row]);
  }
  for (std::int32_t& row : mesh_.elements) row = kept[static_cast<std::size_t>(row)];
}

void VolumeMeshRows::report_problems() {
  using Kind = MeshProblem::Kind;
  constexpr std::int64_t most = 10;
  for (const MeshProblem& p : model::problems_of(mesh_)) {
    const auto e = static_cast<std::size_t>(p.index);
    const std::string where =
        fmt::format("{} {} at {}", words_.element, element_numbers_[e], text_of(p.place));
    const auto add = [&](std::string message, const char* kind) {
      wrong_ = true;
      diagnostics_.add({name_, element_lines_[e]}, std::move(message), kind, most);
    };
    switch (p.kind) {
      case Kind::inverted:
        add(fmt::format("{} is turned inside out: its volume is negative, or is at some point of it; put its "
                        "{}s in the order of the format, or mesh that place anew",
                        where, words_.node),
            "inverted");
        break;
      case Kind::degenerate:
        add(fmt::format("{} has no volume; remove it, or mesh that place anew", where), "degenerate");
        break;
      case Kind::repeated:
        add(fmt::format("{} names a {} twice; remove it, or mesh that place anew", where, words_.node),
            "repeated");
        break;
      case Kind::branching:
        add(fmt::format(
                "{0} shares a face with two others, or with one that lies on the same side of it, as where "
                "it stands twice; write every {1} once (Gmsh's version 2.2 repeats those in several "
                "physical groups, 4.1 does not)",
                where, words_.element),
            "branching");
        break;
      case Kind::parts:
        add(fmt::format(
                "{0} has no {1} in common with {2} {3}, neither directly nor through others; write each "
                "body to a file of its own, or merge the {1}s that lie at one place",
                where, words_.node, words_.element, element_numbers_.front()),
            "parts");
        break;
      case Kind::unused:  // they have been left out
        break;
    }
  }
}

model::Mesh VolumeMeshRows::result(double unit) {
  const Index index(node_numbers_);
  index.for_each_repeated([&](std::size_t row, std::size_t first) {
    report(node_lines_[row], "twice",
           fmt::format("{} {} stands twice, first on line {}; write one mesh to a file", words_.node,
                       node_numbers_[row], node_lines_[first]));
  });
  if (!find_nodes(index)) return {};
  keep_used_nodes(unit);
  mesh_.name = name_;
  report_problems();
  return wrong_ ? model::Mesh{} : std::move(mesh_);
}

}  // namespace eigengrain::io
