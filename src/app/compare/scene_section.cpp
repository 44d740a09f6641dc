#include "scene_section.hpp"

#include "../text.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

namespace eigengrain::app {
namespace {

using report::Axis;
using report::Emphasis;
using report::Page;
using timestep::Estimate;

/// Errors below this are drawn as none: a hundredth of a percent.
constexpr double nearest_error = 1e-4;

void add_scene_picture(const ComparedScene& scene, Page& page) {
  double low_cost = 1;
  double high_cost = 10;
  double lowest = -0.1;
  double highest = 0;
  report::Chart chart{
      .title = "Error against cost of each estimate in " + scene.name,
      .x = Axis::logarithmic(1, 10),
      .y = Axis::signed_distance(-1, 1, nearest_error),
      .x_name = fmt::format("cost in products with K that take the same time (one takes {} s)",
                            report::number_text(scene.product_seconds)),
      .y_name = "step, from the true one",
      .height = 520};
  for (const Estimate& e : scene.comparison.estimates) {
    const double cost = equivalent_products(scene, e);
    const double error = e.ratio_to_true - 1;
    chart.series.push_back({.name = e.name, .look = look_of(verdict_on(e)), .points = {{cost, error}}});
    if (!std::isfinite(error)) continue;
    low_cost = std::min(low_cost, cost);
    high_cost = std::max(high_cost, cost);
    lowest = std::min(lowest, error);
    highest = std::max(highest, error);
  }
  chart.x = Axis::logarithmic(low_cost, high_cost);
  chart.y = Axis::signed_distance(lowest, highest, nearest_error);
  chart.guides.push_back({"", {{chart.x.low(), 0}, {chart.x.high(), 0}}});
  page.picture(
      svg_of(chart),
      fmt::format(
          "{}: what each estimate is off by, against what it costs. On the dashed line the estimate is "
          "the true step; below it the step is shorter than need be, above it the run blows up. "
          "Logarithmic both ways from {}%.",
          scene.name, report::number_text(100 * nearest_error)));
}

void add_scene_table(const ComparedScene& scene, bool with_sources, Page& page) {
  report::Table table{.columns = {{.name = "estimate"},
                                  {.name = "step [s]", .number = true},
                                  {.name = "of true", .number = true},
                                  {.name = "cost", .number = true},
                                  {.name = "seconds", .number = true},
                                  {.name = "verdict"}},
                      .rows = {}};
  if (with_sources) table.columns.push_back({.name = "source"});
  std::vector<const Estimate*> sorted;
  for (const Estimate& e : scene.comparison.estimates) sorted.push_back(&e);
  std::stable_sort(sorted.begin(), sorted.end(), [](const Estimate* a, const Estimate* b) {
    return std::abs(a->ratio_to_true - 1) < std::abs(b->ratio_to_true - 1);
  });
  const auto emphasis_of = [](Verdict verdict) {
    if (verdict == Verdict::unsafe) return Emphasis::bad;
    return verdict == Verdict::proven ? Emphasis::good : Emphasis::none;
  };
  for (const Estimate* e : sorted) {
    const Verdict verdict = verdict_on(*e);
    std::string said = text_of(verdict);
    if (verdict == Verdict::probable)
      said = fmt::format("safe but for p < {}", report::number_text(e->failure));
    if (e->range)
      said +=
          fmt::format("; {} to {} as the frame turns", ratio_text(e->range->least / e->dt * e->ratio_to_true),
                      ratio_text(e->range->largest / e->dt * e->ratio_to_true));
    table.rows.push_back({{e->name},
                          {fmt::format("{:.4e}", e->dt)},
                          {ratio_text(e->ratio_to_true), emphasis_of(verdict)},
                          {report::number_text(equivalent_products(scene, *e))},
                          {report::number_text(e->seconds)},
                          {said, emphasis_of(verdict)},
                          {e->source, Emphasis::faint}});
  }
  page.table(table, "Nearest to the truth first. Cost: in products with K that take the same time.");
}

}  // namespace

std::string ratio_text(double ratio) {
  if (!std::isfinite(ratio)) return "∞";
  const double excess = ratio - 1;
  if (excess > 1e-9 && excess < 5e-4)
    return "1+" + report::power_of_ten(static_cast<int>(std::lround(std::log10(excess))));
  return ratio < 10 ? fmt::format("{:.3f}", ratio) : report::number_text(ratio);
}

void add_scene(const ComparedScene& scene, bool with_sources, Page& page) {
  const timestep::Comparison& c = scene.comparison;
  page.subsection(scene.name);
  page.paragraph(fmt::format(
      "{}, {}, {}. True critical step {:.6e} s, undamped, to a residual of {:.1e}; limit of the cycle with "
      "its damping "
      "{:.6e} s. The truth took {} products with K and {} s.",
      counted(c.bodies, "ball", "balls"), counted(c.contacts, "acting contact", "acting contacts"),
      counted(c.unknowns, "unknown", "unknowns"), c.truth.dt, c.truth.residual, c.truth.limit,
      c.truth.products, report::number_text(c.truth.seconds)));
  std::vector<std::string> unsafe;
  const Estimate* best = nullptr;
  for (const Estimate& e : c.estimates) {
    if (!e.safe) unsafe.push_back(e.name);
    if (e.safe && e.claim == timestep::Claim::proven && (best == nullptr || e.dt > best->dt)) best = &e;
  }
  page.paragraph(fmt::format(
      "{}{}",
      unsafe.empty() ? "No estimate is unsafe here."
                     : fmt::format("Unsafe here: {}.", fmt::join(unsafe, ", ")),
      best == nullptr
          ? std::string()
          : fmt::format(" The longest proven step is that of {}: {} of the truth, at the cost of {} "
                        "products.",
                        best->name, ratio_text(best->ratio_to_true),
                        report::number_text(equivalent_products(scene, *best)))));
  add_scene_picture(scene, page);
  add_scene_table(scene, with_sources, page);
  std::vector<std::string> left_out;
  for (const timestep::LeftOut& none : c.left_out)
    left_out.push_back(none.name + " does not apply: " + none.reason);
  page.list(left_out);
}

}  // namespace eigengrain::app
