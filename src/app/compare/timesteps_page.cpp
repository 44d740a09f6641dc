#include "eigengrain/base/text.hpp"

#include "../text.hpp"
#include "report/chart.hpp"
#include "report/page.hpp"
#include "run_lengths.hpp"
#include "scene_section.hpp"
#include "size_section.hpp"
#include "standing.hpp"
#include "timesteps_report.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>

namespace eigengrain::app {
namespace {

using report::Axis;
using report::Cell;
using report::Emphasis;
using report::Mark;
using report::Page;
using timestep::Estimate;

std::string key_of_verdicts() {
  return report::svg_of_key({{look_of(Verdict::proven), "safe, proven"},
                             {look_of(Verdict::probable), "safe but for a stated probability"},
                             {look_of(Verdict::safe_here), "a rule, safe here"},
                             {look_of(Verdict::unsafe), "UNSAFE: longer than the true step"}});
}

std::string names_of(const std::vector<const Standing*>& standings) {
  std::vector<std::string> names;
  for (const Standing* standing : standings) names.push_back(standing->name);
  return fmt::format("{}", fmt::join(names, ", "));
}

std::vector<const ComparedScene*> compared(const TimestepsReport& report) {
  std::vector<const ComparedScene*> scenes;
  for (const ComparedScene& scene : report.scenes)
    if (scene.skipped.empty()) scenes.push_back(&scene);
  return scenes;
}

void add_safety(const TimestepsReport& report, Page& page) {
  const std::vector<Standing> standings = standings_of(report.scenes);
  std::vector<const Standing*> kept;
  std::vector<const Standing*> lucky;
  std::vector<const Standing*> broken;
  std::vector<const Standing*> unsafe;
  for (const Standing& s : standings) {
    const bool rule = s.claim == timestep::Claim::none;
    if (s.unsafe == 0)
      (rule ? lucky : kept).push_back(&s);
    else
      (rule ? unsafe : broken).push_back(&s);
  }
  page.section("Which estimates are safe");
  page.paragraph(
      fmt::format("Of {} in {}, {} never exceed the true critical step. {} of these claim it, with a proof "
                  "or but for a stated "
                  "probability.",
                  counted(static_cast<std::int64_t>(standings.size()), "estimate", "estimates"),
                  counted(static_cast<std::int64_t>(compared(report).size()), "scene", "scenes"),
                  kept.size() + lucky.size(), kept.size()));
  if (!broken.empty())
    page.paragraph(fmt::format("THESE CLAIM TO BE SAFE AND ARE NOT, which is a mistake of the program: {}.",
                               names_of(broken)));
  if (!lucky.empty())
    page.paragraph(fmt::format("Rules that were safe in these scenes, which says nothing of others: {}.",
                               names_of(lucky)));
  std::stable_sort(unsafe.begin(), unsafe.end(),
                   [](const Standing* a, const Standing* b) { return a->unsafe > b->unsafe; });
  std::vector<std::string> most;
  for (const Standing* s : unsafe)
    most.push_back(
        fmt::format("{} in {}", s->name, s->unsafe == s->scenes ? "all" : std::to_string(s->unsafe)));
  if (!most.empty()) page.paragraph(fmt::format("Unsafe in some scenes: {}.", fmt::join(most, ", ")));
}

Cell cell_of_matrix(const ComparedScene& scene, const std::string& name) {
  const Estimate* e = timestep::find_estimate(scene.comparison, name);
  if (e == nullptr) return {"·", Emphasis::faint};
  if (!e->safe) return {"▲" + ratio_text(e->ratio_to_true), Emphasis::bad};
  return {ratio_text(e->ratio_to_true), verdict_on(*e) == Verdict::proven ? Emphasis::good : Emphasis::none};
}

/// Scenes against estimates, in as many tables as it takes to keep them as wide as a page.
void add_matrix(const TimestepsReport& report, Page& page) {
  constexpr std::size_t most_columns = 13;
  const std::vector<const ComparedScene*> scenes = compared(report);
  const std::size_t tables = (scenes.size() + most_columns - 1) / most_columns;
  for (std::size_t t = 0; t < tables; ++t) {
    const std::size_t begin = t * scenes.size() / tables;
    const std::size_t end = (t + 1) * scenes.size() / tables;
    report::Table table{.columns = {{.name = "estimate"}}, .rows = {}};
    for (std::size_t k = begin; k < end; ++k)
      table.columns.push_back({.name = scenes[k]->name, .number = true, .upright = true});
    for (const Standing& standing : standings_of(report.scenes)) {
      std::vector<Cell> row{{standing.name}};
      for (std::size_t k = begin; k < end; ++k) row.push_back(cell_of_matrix(*scenes[k], standing.name));
      table.rows.push_back(std::move(row));
    }
    page.table(table,
               t > 0
                   ? ""
                   : "Ratio of each estimate to the true critical step, before any safety factor. ▲: unsafe. "
                     "Blue: proven. ·: the scene has no such estimate.");
  }
}

void add_sources(const TimestepsReport& report, Page& page) {
  report::Table table{.columns = {{.name = "estimate"},
                                  {.name = "claims"},
                                  {.name = "scenes", .number = true},
                                  {.name = "unsafe in", .number = true},
                                  {.name = "smallest", .number = true},
                                  {.name = "median", .number = true},
                                  {.name = "largest", .number = true},
                                  {.name = "largest in"},
                                  {.name = "cost", .number = true},
                                  {.name = "source"}},
                      .rows = {}};
  for (const Standing& s : standings_of(report.scenes))
    table.rows.push_back(
        {{s.name},
         {s.claim == timestep::Claim::none ? "-" : std::string(timestep::name_of(s.claim)),
          s.claim == timestep::Claim::proven ? Emphasis::good : Emphasis::none},
         {std::to_string(s.scenes)},
         {s.unsafe == 0 ? "-" : std::to_string(s.unsafe), s.unsafe == 0 ? Emphasis::none : Emphasis::bad},
         {ratio_text(s.smallest)},
         {ratio_text(s.median)},
         {ratio_text(s.largest), s.unsafe == 0 ? Emphasis::none : Emphasis::bad},
         {s.largest_in},
         {report::number_text(s.median_products)},
         {s.source, Emphasis::faint}});
  page.table(table,
             "Ratios to the true critical step over all scenes, what each estimate claims of itself, and "
             "where it is "
             "from. Cost: median over the scenes, in products with K that take the same time.");
}

void add_run_lengths(const TimestepsReport& report, Page& page) {
  const std::vector<RunLengths> lengths = run_lengths(report.scenes);
  if (lengths.empty()) return;
  page.section("Steps saved in a run");
  std::vector<std::string> best;
  for (const RunLengths& mine : lengths)
    if (mine.always_safe() && best.size() < 3)
      best.push_back(fmt::format("{} ({:.2f})", mine.name, mine.median()));
  page.paragraph(
      best.empty()
          ? "None of them is below the limit of the cycle in every scene."
          : fmt::format(
                "The shortest runs, in the median over scenes, that stay below the limit of the cycle "
                "everywhere: {}.",
                fmt::join(best, ", ")));
  double low = 0.5;
  double high = 2;
  report::StripChart chart{.title = "Steps of a run by estimate, relative to PFC3D's rule",
                           .x = Axis::logarithmic(1, 2),
                           .x_name = "steps for the same time, relative to 0.8 of PFC3D's estimate",
                           .guide = 1.0};
  for (const RunLengths& mine : lengths) {
    report::Strip strip{.name = mine.name, .values = {}, .middle = mine.median()};
    for (const RunLength& length : mine.lengths) {
      if (!(length.relative_steps > 0)) continue;  // an estimate without limit
      low = std::min(low, length.relative_steps);
      high = std::max(high, length.relative_steps);
      strip.values.push_back(
          {length.relative_steps, look_of(length.safe ? Verdict::proven : Verdict::unsafe)});
    }
    chart.strips.push_back(std::move(strip));
  }
  chart.x = Axis::logarithmic(low, high);
  page.picture(
      svg_of(chart),
      "Number of steps for the same time; a mark a scene, a bar at the median; to the left is faster. On top "
      "those that are safe in every scene. "
      "Circles: "
      "the step is below the limit of the cycle, with local damping and dashpots. Triangles: it is not. "
      "Rules "
      "are taken times 0.8, whatever the damping, as codes do; estimates that are proven, or safe but for a "
      "stated probability, times 0.98 and times what damping leaves of the true step; policies with their "
      "own "
      "safety.");
}

}  // namespace

std::string page_of(const TimestepsReport& report) {
  const std::vector<const ComparedScene*> scenes = compared(report);
  Page page(
      "Estimated against true critical timesteps",
      fmt::format("{}, eigengrain {}", counted(static_cast<std::int64_t>(scenes.size()), "scene", "scenes"),
                  EIGENGRAIN_VERSION));
  page.paragraph(
      "The explicit cycle is stable up to a step of 2/√λ, λ the largest eigenvalue of M⁻¹K of the whole "
      "scene. Every "
      "code estimates that step. Here each estimate stands beside the truth, with what it costs and whether "
      "a run may "
      "trust in it. Ratios are before any safety factor.");
  std::vector<std::string> skipped;
  for (const ComparedScene& scene : report.scenes)
    if (!scene.skipped.empty())
      skipped.push_back(fmt::format("Left out: {} ({}).", scene.name, scene.skipped));
  page.list(skipped);
  if (scenes.size() > 1) {
    add_safety(report, page);
    add_sources(report, page);
    add_matrix(report, page);
  }
  add_run_lengths(report, page);
  add_sizes(report.sizes, page);
  if (!scenes.empty()) {
    page.section(scenes.size() > 1 ? "Scene by scene" : "Error against cost");
    page.picture(key_of_verdicts(), "");
  }
  const bool alone = scenes.size() == 1;  // the sources of several are in the table across them
  for (const ComparedScene* scene : scenes) add_scene(*scene, alone, page);
  return page.finish();
}

}  // namespace eigengrain::app
