#include "eigengrain/io/scene_reader.hpp"

#include "document.hpp"
#include "overrides.hpp"
#include "scene_draft.hpp"
#include "section.hpp"
#include "text_file.hpp"

#include <fmt/format.h>

#include <utility>

namespace eigengrain::io {
namespace {

void read_sections(const Section& root, SceneDraft& draft) {
  root.check_keys();
  read_gravity(root, draft);
  read_materials(root, draft);
  read_periodic(root, draft);
  read_contacts(root, draft);
  read_balls(root, draft);
  read_walls(root, draft);
  read_damping(root, draft);
  read_timestep(root, draft);
  read_run(root, draft);
  read_histories(root, draft);
  read_outputs(root, draft);
  check_scene(root, draft);
}

Document read_document(std::string_view yaml, std::string_view name, std::span<const std::string> overrides,
                       Diagnostics& diagnostics) {
  Document document;
  document.root = parse_yaml(yaml, document.files.emplace_back(name), diagnostics);
  // Half of a document would only give mistakes that are none.
  diagnostics.throw_if_any();
  if (document.root.kind == Node::Kind::null) document.root.kind = Node::Kind::map;
  if (document.root.kind != Node::Kind::map) {
    diagnostics.add(document.root.place(),
                    fmt::format("a scene is a section of keys such as \"balls:\", not {}",
                                kind_name(document.root.kind)));
    diagnostics.throw_if_any();
  }
  apply_overrides(overrides, document, diagnostics);
  return document;
}

}  // namespace

model::Scene read_scene_text(std::string_view yaml, const std::filesystem::path& folder,
                             std::string_view name, std::span<const std::string> overrides) {
  Diagnostics diagnostics;
  const Document document = read_document(yaml, name, overrides, diagnostics);
  SceneDraft draft;
  draft.scene.name = name;
  draft.folder = folder;
  read_sections(Section(document.root, "", "", diagnostics), draft);
  diagnostics.throw_if_any();
  add_notes(draft);
  return std::move(draft.scene);
}

model::Scene read_scene(const std::filesystem::path& file, std::span<const std::string> overrides) {
  const auto [text, problem] = read_text_file(file);
  if (!text) throw InputError(problem);
  return read_scene_text(*text, file.parent_path(), file.string(), overrides);
}

}  // namespace eigengrain::io
