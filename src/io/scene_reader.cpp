#include "eigengrain/io/scene_reader.hpp"

#include "document.hpp"
#include "document_text.hpp"
#include "overrides.hpp"
#include "scene_draft.hpp"
#include "section.hpp"
#include "settings_reader.hpp"
#include "text_file.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <functional>
#include <utility>

namespace eigengrain::io {
namespace {

/// Puts the balls into a draft that has its materials, contacts and cell.
using TakeBalls = std::function<void(const Section& root, SceneDraft& draft)>;

void read_sections(const Section& root, SceneDraft& draft, const TakeBalls& take_balls) {
  read_gravity(root, draft);
  read_materials(root, draft);
  read_periodic(root, draft);
  read_planar(root, draft);
  read_contacts(root, draft);
  take_balls(root, draft);
  read_walls(root, draft);
  read_deformables(root, draft);
  read_damping(root, draft);
  read_timestep(root, draft);
  read_mass_scaling(root, draft);
  read_run(root, draft);
  read_stages(root, draft);
  read_measures(root, draft);
  read_histories(root, draft);
  read_outputs(root, draft);
}

Document read_document(std::string_view yaml, std::string_view name, std::span<const std::string> overrides,
                       std::string_view origin, Diagnostics& diagnostics) {
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
  apply_overrides(overrides, origin, document, diagnostics);
  return document;
}

constexpr std::string_view balls_key = "balls";
constexpr std::string_view planar_key = "planar";
constexpr std::string_view clumps_key = "clumps";
constexpr std::string_view deformables_key = "deformables";

void make_absolute(Node* path, const std::filesystem::path& folder) {
  if (path != nullptr && path->kind == Node::Kind::scalar && !path->text.empty())
    path->text = std::filesystem::absolute(folder / path->text).lexically_normal().string();
}

void make_paths_of_wall_absolute(Node& wall, const std::filesystem::path& folder) {
  for (Node& child : wall.children) {
    make_absolute(child.key == "motion_file" ? &child : nullptr, folder);
    make_absolute(child.key == "mesh" ? child.find("file") : nullptr, folder);
  }
}

void make_paths_of_stage_absolute(Node& stage, const std::filesystem::path& folder) {
  if (Node* balls = stage.find(balls_key))
    for (Node& entry : balls->children) make_absolute(entry.find("file"), folder);
  Node* set = stage.find("set");
  if (set == nullptr) return;
  for (Node& child : set->children) {
    const std::string_view key = child.key;
    const bool names_file = key.ends_with(".motion_file") || key.ends_with(".mesh.file");
    make_absolute(key.starts_with("walls") && names_file ? &child : nullptr, folder);
    if (key == "walls")
      for (Node& wall : child.children) make_paths_of_wall_absolute(wall, folder);
    else if (key.starts_with("walls"))
      make_paths_of_wall_absolute(child, folder);
  }
}

/// The document with the paths of files that walls and stages name made absolute: a state, which keeps it,
/// may stand in any folder.
std::string document_for_states(const Document& document, const std::filesystem::path& folder) {
  Node root;
  for (const Node& section : document.root.children)
    if (section.key != balls_key && section.key != clumps_key) root.children.push_back(section);
  for (Node& section : root.children) {
    if (section.key == "walls")
      for (Node& wall : section.children) make_paths_of_wall_absolute(wall, folder);
    if (section.key == deformables_key)
      for (Node& entry : section.children)
        if (Node* mesh = entry.find("mesh")) make_absolute(mesh->find("file"), folder);
    if (section.key == "stages")
      for (Node& stage : section.children) make_paths_of_stage_absolute(stage, folder);
  }
  return document_text(root, balls_key);
}

/// Of balls that exist, what the checks of the rest ask for: their materials.
void take_materials_of_balls(const Section& root, SceneDraft& draft,
                             std::span<const std::int32_t> material_of_ball) {
  for (const std::string_view key : {balls_key, clumps_key})
    if (root.has(key))
      root.report(key,
                  fmt::format("a state has its {} already; leave the key out, or start from the scene", key));
  const auto count = static_cast<std::int32_t>(draft.scene.materials.size());
  const bool known = std::all_of(material_of_ball.begin(), material_of_ball.end(),
                                 [&](std::int32_t material) { return material >= 0 && material < count; });
  if (known)
    draft.scene.bodies.material.assign(material_of_ball.begin(), material_of_ball.end());
  else
    root.report("materials",
                fmt::format("the balls of the state are made of more materials than these {}; keep their "
                            "number and their order",
                            count));
}

}  // namespace

model::Scene read_scene_text(std::string_view yaml, const std::filesystem::path& folder,
                             std::string_view name, std::span<const std::string> overrides) {
  Diagnostics diagnostics;
  const Document document = read_document(yaml, name, overrides, "--set", diagnostics);
  SceneDraft draft;
  draft.scene.name = name;
  draft.folder = folder;
  draft.scene.document = document_for_states(document, folder);
  const Section root(document.root, "", "", diagnostics);
  root.check_keys(root.has(clumps_key) || root.has(deformables_key) ? balls_key : std::string_view());
  read_sections(root, draft, [](const Section& section, SceneDraft& into) {
    read_balls(section, into);
    read_clumps(section, into);
  });
  check_scene(root, draft);
  check_deformation(root, draft);
  check_planar(root, draft);
  take_from_materials(draft, diagnostics);
  check_mass_scaling(root, draft);
  check_placement(root, draft);
  append_nodes(draft);
  diagnostics.throw_if_any();
  check_stages(root, draft, draft.scene.document);
  diagnostics.throw_if_any();
  add_notes(draft);
  return std::move(draft.scene);
}

model::Scene read_settings_text(std::string_view text, const std::filesystem::path& folder,
                                std::string_view name, std::span<const std::string> overrides,
                                std::span<const std::int32_t> material_of_ball, std::string_view origin) {
  Diagnostics diagnostics;
  const Document document = read_document(text, name, overrides, origin, diagnostics);
  SceneDraft draft;
  draft.scene.name = name;
  draft.folder = folder;
  draft.scene.document = document_for_states(document, folder);
  const Section root(document.root, "", "", diagnostics);
  root.check_keys(balls_key);
  for (const std::string& override_text : overrides)
    if (override_text.starts_with(planar_key))
      root.report(planar_key,
                  "a state keeps the plane and the masses that it was started with; leave the "
                  "override out, or start from the scene");
  read_sections(root, draft, [&](const Section& section, SceneDraft& into) {
    take_materials_of_balls(section, into, material_of_ball);
  });
  check_scene(root, draft);
  check_deformation(root, draft);
  take_from_materials(draft, diagnostics);
  check_mass_scaling(root, draft);
  diagnostics.throw_if_any();
  add_notes(draft);
  draft.scene.bodies = {};
  return std::move(draft.scene);
}

model::Bodies read_added_balls(const model::Scene& settings, std::int64_t stage, std::int64_t repetition) {
  Diagnostics diagnostics;
  const Document document = read_document(settings.document, settings.name, {}, "--set", diagnostics);
  SceneDraft draft;
  draft.repetition = repetition;
  draft.wraps = false;
  const Section root(document.root, "", "", diagnostics);
  read_materials(root, draft);
  read_periodic(root, draft);
  read_planar(root, draft);
  const std::vector<Section> stages = root.sections("stages");
  read_ball_entries(stages[static_cast<std::size_t>(stage)].sections(balls_key), draft);
  diagnostics.throw_if_any();
  return std::move(draft.scene.bodies);
}

model::Scene read_scene(const std::filesystem::path& file, std::span<const std::string> overrides) {
  const auto [text, problem] = read_text_file(file);
  if (!text) throw InputError(problem);
  return read_scene_text(*text, file.parent_path(), file.string(), overrides);
}

}  // namespace eigengrain::io
