#include "eigengrain/base/error.hpp"
#include "eigengrain/io/suggest.hpp"

#include "read_fixed.hpp"
#include "read_selection.hpp"
#include "scene_draft.hpp"
#include "settings_reader.hpp"
#include "state_changes.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <iterator>
#include <utility>

namespace eigengrain::io {
namespace {

std::vector<model::GroupChoice> read_groups(const Section& parent, const SceneDraft& draft) {
  std::vector<model::GroupChoice> groups;
  for (const Section& section : parent.sections("groups")) {
    section.check_keys();
    const auto name = section.text("name");
    model::Selection selection = read_selection(section, draft);
    if (!name) continue;
    const bool again =
        std::any_of(groups.begin(), groups.end(), [&](const auto& group) { return group.name == *name; });
    if (again)
      section.report("name", fmt::format("\"{}\" is the name of another group; choose another one", *name));
    else
      groups.push_back({*name, std::move(selection)});
  }
  return groups;
}

/// Sections of the scene that no stage may set, and why.
constexpr std::array<std::pair<std::string_view, std::string_view>, 6> not_to_set{{
    {"balls", "balls come in with `balls` of the stage itself"},
    {"clumps", "clumps are those that the scene starts with"},
    {"planar", "the plane is that which the scene starts with"},
    {"run", "a stage has a `run` of its own"},
    {"groups", "a stage has `groups` of its own"},
    {"stages", "stages follow one another as they stand in the file"},
}};

std::vector<std::string> read_set(const Section& stage) {
  std::vector<std::string> settings;
  for (const FreeKey& free : stage.free_keys("set")) {
    std::string plain = free.key;  // as a path of an override is read
    std::erase_if(plain, [](char c) { return c == ' ' || c == ']'; });
    const std::string_view first = std::string_view(plain).substr(0, plain.find_first_of(".["));
    const auto forbidden = std::find_if(not_to_set.begin(), not_to_set.end(),
                                        [&](const auto& entry) { return entry.first == first; });
    if (forbidden != not_to_set.end())
      stage.report("set", fmt::format("{}: {}", free.key, forbidden->second));
    else
      settings.push_back(free.key + "=" + free.value);
  }
  return settings;
}

/// Reports a group that no stage before makes.
void check_group(const Section& section, const std::string& name, const std::vector<std::string>& known) {
  if (std::find(known.begin(), known.end(), name) != known.end()) return;
  section.report("group",
                 known.empty()
                     ? fmt::format("there is no group \"{0}\"; make it first, e.g. \"groups: [{{name: "
                                   "{0}, box: {{min: [0, 0, 0], max: [1, 1, 1]}}}}]\"",
                                   name)
                     : fmt::format("there is no group \"{}\"{} (groups: {})", name, did_you_mean(name, known),
                                   fmt::join(known, ", ")));
}

/// In a planar scene what moves a ball out of the plane, or lets it go, is a mistake.
void check_stays_in_plane(const Section& section, const model::BodyChange& change, int normal) {
  const char axis = "xyz"[normal];
  const auto check_along = [&](const char* key, const std::optional<Vec3>& v) {
    if (v && (*v)[normal] != 0)
      section.report(key, fmt::format("{} along {} leaves the plane; write 0 there", (*v)[normal], axis));
  };
  const auto check_about = [&](const char* key, const std::optional<Vec3>& w) {
    for (int k = 0; w && k < 3; ++k)
      if (k != normal && (*w)[k] != 0)
        section.report(key,
                       fmt::format("{} about {}; in a planar scene balls turn about {} alone: write 0 there",
                                   (*w)[k], "xyz"[k], axis));
  };
  check_along("velocity", change.velocity);
  check_along("force", change.force);
  check_about("spin", change.spin);
  check_about("moment", change.moment);
  for (int k = 0; k < 3; ++k)
    if ((k == normal && change.free.component(k)) || (k != normal && change.free.component(3 + k))) {
      section.report("free",
                     fmt::format("in a planar scene balls have three free components, x and y in the plane "
                                 "and the rotation about {}; name those only",
                                 axis));
      break;
    }
}

model::BodyChange read_change(const Section& section, const SceneDraft& draft,
                              const std::vector<std::string>& groups) {
  section.check_keys();
  model::BodyChange change{.of = read_selection(section, draft),
                           .fix = read_fixed(section, "fix"),
                           .free = read_fixed(section, "free"),
                           .velocity = section.vector("velocity"),
                           .spin = section.vector("spin"),
                           .force = section.vector("force"),
                           .moment = section.vector("moment"),
                           .damping = section.quantity("damping")};
  if (const auto growth = section.section("growth")) {
    growth->check_keys();
    change.growth = growth->quantity("factor");
    change.over = growth->quantity("over").value_or(0);
  }
  if (section.has("group"))
    if ((change.of.group = section.text("group"))) check_group(section, *change.of.group, groups);
  constexpr std::array<std::string_view, 8> changes{"fix",   "free",   "velocity", "spin",
                                                    "force", "moment", "damping",  "growth"};
  if (std::none_of(changes.begin(), changes.end(), [&](std::string_view key) { return section.has(key); }))
    section.report("changes nothing; add e.g. \"fix: [x]\" or \"velocity: [0, 0, 1]\", or remove the entry");
  if ((change.fix.bits() & change.free.bits()) != 0)
    section.report("free", "a component cannot be fixed and freed at once; name it once");
  if (draft.planar) check_stays_in_plane(section, change, draft.planar->normal);
  return change;
}

model::ContactChoice read_choice(const Section& section, const SceneDraft& draft,
                                 const std::vector<std::string>& groups) {
  section.check_keys();
  model::ContactChoice choice{
      .take = section.text("take").value_or(""), .of = read_selection(section, draft), .wall = {}};
  if (section.has("group"))
    if ((choice.of.group = section.text("group"))) check_group(section, *choice.of.group, groups);
  if (section.has("wall"))
    if ((choice.wall = section.text("wall"))) check_wall_name(section, *choice.wall, draft);
  std::vector<std::string> names;
  for (const model::ContactRule& rule : draft.scene.contacts)
    if (rule.by_choice()) names.push_back(rule.name);
  if (!choice.take.empty() && draft.contacts_complete &&
      std::find(names.begin(), names.end(), choice.take) == names.end())
    section.report(
        "take", fmt::format("no entry of contacts has the name \"{}\"{}; add one, e.g. \"- {{name: {}, law: "
                            "linear, kn: 1e5 N/m}}\"",
                            choice.take, did_you_mean(choice.take, names), choice.take));
  return choice;
}

std::string read_save(const Section& section) {
  const auto name = section.text("save");
  if (!name) return {};
  if (name->find_first_of("/\\") != std::string::npos || !name->ends_with(".h5") || name->size() == 3)
    section.report("save", fmt::format("\"{}\": a name without folders that ends in .h5 is wanted, as states "
                                       "stand in the folder of results; write e.g. \"tilted.h5\"",
                                       *name));
  return *name;
}

/// The materials of the balls that a stage adds, as far as they are right.
void note_materials(const Section& stage, SceneDraft& draft) {
  const auto& materials = draft.scene.materials;
  for (const Section& balls : stage.sections("balls")) {
    if (!balls.has("material")) continue;
    const auto name = balls.text("material");
    const auto found = std::find_if(materials.begin(), materials.end(),
                                    [&](const model::Material& material) { return material.name == name; });
    if (name && found != materials.end())
      draft.materials_to_come.insert(static_cast<std::int32_t>(found - materials.begin()));
  }
}

model::Stage read_stage(const Section& section, SceneDraft& draft, std::vector<std::string>& groups) {
  section.check_keys();
  model::Stage stage;
  stage.name = section.text("name").value_or("");
  stage.repeat = section.integer("repeat").value_or(1);
  stage.settings = read_set(section);
  stage.adds_balls = section.has("balls");
  note_materials(section, draft);
  stage.groups = read_groups(section, draft);
  for (const model::GroupChoice& group : stage.groups) groups.push_back(group.name);
  for (const Section& change : section.sections("bodies"))
    stage.bodies.push_back(read_change(change, draft, groups));
  for (const Section& choice : section.sections("contacts"))
    stage.contacts.push_back(read_choice(choice, draft, groups));
  if (const auto run = section.section("run")) stage.run = read_end_of_run(*run, draft);
  if (const auto relax = section.section("relax")) {
    relax->check_keys();
    stage.relax = model::RelaxChoice{.tolerance = relax->quantity("tolerance").value_or(0),
                                     .max_steps = relax->integer("max_steps").value_or(0)};
  }
  if (section.has("run") && section.has("relax"))
    section.report("relax", "not beside run; make it a stage of its own");
  stage.save = read_save(section);
  constexpr std::array<std::string_view, 8> does{"set",      "balls", "groups", "bodies",
                                                 "contacts", "run",   "relax",  "save"};
  if (std::none_of(does.begin(), does.end(), [&](std::string_view key) { return section.has(key); }))
    section.report("does nothing; add e.g. \"run: {steps: 1000}\", or remove the entry");
  return stage;
}

bool same_columns(const model::History& l, const model::History& r) {
  const auto names = [](const model::History& table) {
    std::vector<std::string> result;
    for (const model::Region& region : table.measures) result.push_back(region.name);
    return result;
  };
  return l.energies == r.energies && l.unbalanced == r.unbalanced && l.walls == r.walls &&
         l.wall_moments == r.wall_moments && l.wall_positions == r.wall_positions && l.ledger == r.ledger &&
         l.balls == r.balls && names(l) == names(r);
}

/// A table goes on through the stages, so it keeps its columns.
void report_changed_tables(const Section& stage, const model::Scene& before, const model::Scene& now) {
  for (const model::History& table : now.histories) {
    const auto same = std::find_if(before.histories.begin(), before.histories.end(),
                                   [&](const model::History& other) { return other.file == table.file; });
    if (same != before.histories.end() && !same_columns(*same, table))
      stage.report("set",
                   fmt::format("the table \"{}\" would go on with other columns; give the new one another "
                               "name",
                               table.file));
  }
}

}  // namespace

void read_stages(const Section& root, SceneDraft& draft) {
  draft.scene.groups = read_groups(root, draft);
  std::vector<std::string> groups;
  for (const model::GroupChoice& group : draft.scene.groups) groups.push_back(group.name);
  for (const Section& section : root.sections("stages"))
    draft.scene.stages.push_back(read_stage(section, draft, groups));
  if (root.has("run") && !draft.scene.stages.empty())
    root.report("run",
                "not beside stages, each of which says how far it runs; make it a stage, or remove it");
}

void check_stages(const Section& root, const SceneDraft& draft, std::string_view document) {
  std::string text(document);
  const std::vector<Section> sections = root.sections("stages");
  const std::size_t count = std::min(sections.size(), draft.scene.stages.size());
  model::Scene before = draft.scene;
  before.bodies = {};
  for (std::size_t k = 0; k < count; ++k) {
    const Section& section = sections[k];
    SceneDraft added;
    added.scene.materials = draft.scene.materials;
    added.scene.cell = draft.scene.cell;
    added.planar = draft.planar;
    added.folder = draft.folder;
    read_ball_entries(section.sections("balls"), added);
    if (draft.planar && draft.scene.bodies.size() > 0)
      check_planar_balls(added, draft.scene.bodies.position[0][draft.planar->normal], section.diagnostics());
    const std::vector<std::string>& settings = draft.scene.stages[k].settings;
    if (settings.empty()) continue;
    try {
      model::Scene now =
          read_settings_text(text, draft.folder, fmt::format("{}, {}", draft.scene.name, section.path()),
                             settings, draft.scene.bodies.material, section.path() + ".set");
      if (const auto problem = forbidden_change(before, now)) section.report("set", *problem);
      report_changed_tables(section, before, now);
      text = now.document;
      before = std::move(now);
    } catch (const InputError& error) {
      for (const Mistake& mistake : error.mistakes()) section.report("set", mistake.message);
    }
  }
}

}  // namespace eigengrain::io
