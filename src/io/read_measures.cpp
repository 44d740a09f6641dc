#include "eigengrain/io/scene_reader.hpp"

#include "document.hpp"
#include "read_selection.hpp"
#include "scene_draft.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

namespace eigengrain::io {
void read_measures(const Section& root, SceneDraft& draft) {
  std::vector<model::Region>& regions = draft.scene.measures;
  std::size_t number = 0;
  for (const Section& section : root.sections("measures")) {
    section.check_keys();
    const std::string unnamed = fmt::format("region {}", number++);
    const std::string name = section.text("name").value_or(unnamed);
    const auto shape = read_shape(section);
    const auto same = [&](const model::Region& region) { return region.name == name; };
    if (std::any_of(regions.begin(), regions.end(), same))
      section.report("name", fmt::format("\"{}\" is the name of another region; choose another one", name));
    else if (shape)
      regions.push_back({name, *shape});
    if (!shape) draft.measures_complete = false;
  }
}

std::vector<model::Region> read_regions(std::span<const std::string> entries) {
  Diagnostics diagnostics;
  Document document;
  const std::string& file = document.files.emplace_back("--region");
  document.root = {.kind = Node::Kind::map, .file = &file, .children = {}};
  document.root.children.push_back(
      {.kind = Node::Kind::list, .key = "measures", .file = &file, .children = {}});
  std::vector<Node>& regions = document.root.children.front().children;
  for (const std::string& entry : entries) {
    const std::string& name = document.files.emplace_back("--region \"" + entry + "\"");
    regions.push_back(parse_yaml("{" + entry + "}", name, diagnostics));
    clear_lines(regions.back());
  }
  diagnostics.throw_if_any();
  SceneDraft draft;
  read_measures(Section(document.root, "", "", diagnostics), draft);
  diagnostics.throw_if_any();
  return std::move(draft.scene.measures);
}

}  // namespace eigengrain::io
