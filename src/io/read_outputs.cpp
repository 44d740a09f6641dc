#include "eigengrain/io/suggest.hpp"

#include "scene_draft.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <map>
#include <set>
#include <string>

namespace eigengrain::io {
namespace {

/// What is wrong with the name of a table, and what to write instead; empty if nothing is.
std::string problem_of_name(const std::string& name) {
  constexpr std::string_view ending = ".csv";
  const auto unusable = [](char c) { return c == '/' || c == '\\' || static_cast<unsigned char>(c) < 32; };
  if (std::any_of(name.begin(), name.end(), unusable))
    return "a name without folders is wanted, as tables stand in the folder of results; write e.g. "
           "\"energies.csv\"";
  if (!name.ends_with(ending)) return fmt::format("does not end in .csv; write e.g. \"{}.csv\"", name);
  if (name.size() == ending.size()) return "has nothing before .csv; write e.g. \"energies.csv\"";
  return {};
}

void check_balls(const Section& section, const std::vector<std::int64_t>& balls, const SceneDraft& draft) {
  std::set<std::int64_t> seen;
  // Of a state, the reader knows the materials of its balls only.
  const auto count = std::ssize(draft.scene.bodies.material);
  for (const std::int64_t ball : balls) {
    if (!seen.insert(ball).second)
      section.report("balls", fmt::format("ball {} stands there twice; name it once", ball));
    else if (draft.balls_complete && draft.materials_to_come.empty() && ball >= count)
      section.report("balls",
                     fmt::format("there is no ball {}; the {} of the scene are numbered from 0 to {}", ball,
                                 count, count - 1));
  }
}

/// The regions that a table names.
std::vector<model::Region> chosen_regions(const Section& section, const std::vector<std::string>& wanted,
                                          const SceneDraft& draft) {
  std::vector<model::Region> chosen;
  std::vector<std::string> names;
  for (const model::Region& region : draft.scene.measures) names.push_back(region.name);
  for (const std::string& name : wanted) {
    const auto found = std::find(names.begin(), names.end(), name);
    const auto same = [&](const model::Region& region) { return region.name == name; };
    if (std::any_of(chosen.begin(), chosen.end(), same))
      section.report("measures", fmt::format("\"{}\" stands there twice; name it once", name));
    else if (found != names.end())
      chosen.push_back(draft.scene.measures[static_cast<std::size_t>(found - names.begin())]);
    else if (draft.measures_complete)
      section.report(
          "measures",
          names.empty()
              ? fmt::format("there is no region \"{0}\"; add it, e.g. \"measures: [{{name: {0}}}]\" "
                            "for all that there is",
                            name)
              : fmt::format("there is no region \"{}\"{} (measures: {})", name, did_you_mean(name, names),
                            fmt::join(names, ", ")));
  }
  return chosen;
}

/// The columns of a table; false if something is wrong with them, which has been reported.
bool read_columns(const Section& section, const SceneDraft& draft, model::History& history) {
  const auto of = section.texts("of");
  const auto balls = section.integers("balls");
  const auto regions = section.texts("measures");
  if (!of || !balls || !regions) return false;
  if (of->empty() && balls->empty() && regions->empty()) {
    section.report(
        "no columns; add e.g. \"of: [energies, unbalanced, walls]\", or the numbers of balls, \"balls: "
        "[0]\"");
    return false;
  }
  const auto wanted = [&](std::string_view word) {
    return std::find(of->begin(), of->end(), word) != of->end();
  };
  history.energies = wanted("energies");
  history.unbalanced = wanted("unbalanced");
  history.walls = wanted("walls");
  history.wall_moments = wanted("wall_moments");
  history.wall_positions = wanted("wall_positions");
  history.ledger = wanted("ledger");
  history.balls = *balls;
  history.measures = chosen_regions(section, *regions, draft);
  const bool of_walls = history.walls || history.wall_moments || history.wall_positions;
  if (of_walls && draft.scene.walls.empty() && draft.scene.surfaces.empty() && draft.walls_complete)
    section.report("of", "walls, and the scene has none; remove the word, or add walls");
  check_balls(section, *balls, draft);
  return true;
}

}  // namespace

void read_histories(const Section& root, SceneDraft& draft) {
  std::map<std::string, Place> places;
  for (const Section& section : root.sections("histories")) {
    section.check_keys();
    model::History history;
    const auto file = section.text("file");
    if (file) {
      const std::string problem = problem_of_name(*file);
      const auto [first, added] = places.try_emplace(*file, section.place("file"));
      if (!problem.empty())
        section.report("file", fmt::format("\"{}\": {}", *file, problem));
      else if (!added)
        section.report("file",
                       fmt::format("\"{}\" is the file of another table already ({}); choose another name",
                                   *file, text_of(first->second)));
    }
    const auto every = section.integer("every");
    const bool complete = read_columns(section, draft, history);
    if (!file || !every || !complete) continue;
    history.file = *file;
    history.every = *every;
    draft.scene.histories.push_back(std::move(history));
  }
}

void read_outputs(const Section& root, SceneDraft& draft) {
  const auto section = root.section("outputs");
  if (!section) return;
  section->check_keys();
  draft.scene.outputs.checkpoint_every =
      section->integer("checkpoint").value_or(draft.scene.outputs.checkpoint_every);
  draft.scene.outputs.series_every = section->integer("series").value_or(0);
  const auto fields = section->texts("fields").value_or(std::vector<std::string>{});
  draft.scene.outputs.series_stress = std::find(fields.begin(), fields.end(), "stress") != fields.end();
  if (!fields.empty() && !section->has("series"))
    section->report("fields", "of frames that nothing writes; add e.g. \"series: 1000\", or remove fields");
}

}  // namespace eigengrain::io
