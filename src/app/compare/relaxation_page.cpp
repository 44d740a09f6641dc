#include "eigengrain/base/text.hpp"

#include "../relaxing.hpp"
#include "../text.hpp"
#include "relaxation_report.hpp"
#include "report/chart.hpp"
#include "report/page.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace eigengrain::app {
namespace {

using relaxation::Moment;
using report::Axis;
using report::Cell;
using report::Emphasis;
using report::Mark;
using report::number_text;
using report::Page;

/// Below it nothing but rounding is seen.
constexpr double least_drawn = 1e-16;

report::Look look_of(std::size_t method) {
  using namespace report::colour;
  constexpr std::array looks{
      report::Look{Mark::square, ink, false},   report::Look{Mark::circle, blue, true},
      report::Look{Mark::diamond, green, true}, report::Look{Mark::triangle, purple, true},
      report::Look{Mark::cross, grey, false},   report::Look{Mark::circle, vermilion, false}};
  return looks[method % looks.size()];
}

/// Points of a course that show its shape: where something has changed by a tenth.
std::vector<report::Point> thinned(const std::vector<report::Point>& points) {
  std::vector<report::Point> kept;
  for (std::size_t k = 0; k < points.size(); ++k) {
    const bool last = k + 1 == points.size();
    const auto differs = [](double a, double b) { return !(std::abs(std::log(a / b)) < 0.1); };
    if (kept.empty() || last || differs(points[k].x, kept.back().x) || differs(points[k].y, kept.back().y))
      kept.push_back(points[k]);
  }
  return kept;
}

/// Curves of all methods, one value against another, both logarithmic.
template <class PointsOf>
void add_curves(const RelaxedScene& scene, const std::string& x_name, const std::string& y_name,
                const std::string& caption, Page& page, const PointsOf& points_of) {
  report::Chart chart{.title = y_name + " against " + x_name,
                      .x = Axis::logarithmic(1, 10),
                      .y = Axis::logarithmic(1, 10),
                      .x_name = x_name,
                      .y_name = y_name};
  double x_low = std::numeric_limits<double>::infinity();
  double y_low = x_low;
  double x_high = 0;
  double y_high = 0;
  for (std::size_t k = 0; k < scene.runs.size(); ++k) {
    report::Series series{.name = scene.runs[k].name, .look = look_of(k), .joined = true};
    for (const report::Point& point : points_of(scene.runs[k]))
      if (point.x > 0 && point.y > least_drawn) series.points.push_back(point);
    series.points = thinned(series.points);
    for (const report::Point& point : series.points) {
      x_low = std::min(x_low, point.x);
      x_high = std::max(x_high, point.x);
      y_low = std::min(y_low, point.y);
      y_high = std::max(y_high, point.y);
    }
    if (!series.points.empty()) chart.series.push_back(std::move(series));
  }
  if (chart.series.empty()) return;
  chart.x = Axis::logarithmic(x_low, x_high);
  chart.y = Axis::logarithmic(y_low, y_high);
  page.picture(svg_of(chart), caption);
}

void add_pictures(const RelaxedScene& scene, Page& page) {
  const auto course = [](auto x) {
    return [x](const MethodRun& run) {
      std::vector<report::Point> points;
      for (const Moment& moment : run.result.course) points.push_back({x(moment), moment.mean});
      return points;
    };
  };
  const auto seconds = [](const Moment& moment) { return moment.seconds; };
  const auto sweeps = [](const Moment& moment) { return static_cast<double>(moment.sweeps); };
  add_curves(scene, "seconds", "unbalanced ratio", "The larger mean unbalanced ratio, of forces or moments.",
             page, course(seconds));
  add_curves(scene, "sweeps over the contacts", "unbalanced ratio",
             "The same against work: a step, a residual, or a product with a matrix is one sweep.", page,
             course(sweeps));
  add_curves(scene, "sweeps over the contacts", "distance from the end / radius",
             "Root mean square distance of the bodies from where the method ended, over the mean radius.",
             page, [](const MethodRun& run) {
               std::vector<report::Point> points;
               for (const Distance& d : run.distances)
                 points.push_back({static_cast<double>(d.at.sweeps), d.distance});
               return points;
             });
}

void add_table(const RelaxedScene& scene, Page& page) {
  report::Table table{.columns = {{.name = "method"},
                                  {.name = "s to 1e-3", .number = true},
                                  {.name = "sweeps", .number = true},
                                  {.name = "s to the end", .number = true},
                                  {.name = "sweeps", .number = true},
                                  {.name = "steps", .number = true},
                                  {.name = "Newton", .number = true},
                                  {.name = "linear", .number = true},
                                  {.name = "ratio", .number = true},
                                  {.name = "forces from explicit", .number = true},
                                  {.name = "places", .number = true}},
                      .rows = {}};
  const auto missing = Cell{"·", Emphasis::faint};
  const auto add_moment = [&](std::vector<Cell>& row, const std::optional<Moment>& moment) {
    row.push_back(moment ? Cell{number_text(moment->seconds)} : missing);
    row.push_back(moment ? Cell{grouped(moment->sweeps)} : missing);
  };
  for (const MethodRun& run : scene.runs) {
    std::vector<Cell> row{{run.name}};
    if (!run.failure.empty()) {
      row.push_back({run.failure, Emphasis::bad});
      table.rows.push_back(std::move(row));
      continue;
    }
    add_moment(row, run.reaches(coarse));
    add_moment(row, run.reaches_end());
    row.push_back({grouped(run.result.explicit_steps + run.result.part_steps)});
    row.push_back({grouped(run.result.newton_iterations)});
    row.push_back({grouped(run.result.linear_iterations)});
    row.push_back({number_text(mean_of(run.result)), run.result.converged ? Emphasis::good : Emphasis::bad});
    row.push_back(run.from_explicit ? Cell{number_text(run.from_explicit->forces)} : missing);
    row.push_back(run.from_explicit ? Cell{number_text(run.from_explicit->mean_distance)} : missing);
    table.rows.push_back(std::move(row));
  }
  page.table(
      table,
      "From the explicit method's end: root mean square difference of contact forces over their mean, and of "
      "places over the mean radius. Friction admits many equilibria, so they need not be the same. ·: not "
      "reached.");
}

std::string verdict_of(const RelaxedScene& scene, double tolerance) {
  const auto run_of = [&](relaxation::Method method) -> const MethodRun* {
    for (const MethodRun& run : scene.runs)
      if (run.name == name_of(method) && run.failure.empty()) return &run;
    return nullptr;
  };
  const MethodRun* plain = run_of(relaxation::Method::explicit_cycle);
  const MethodRun* best = run_of(relaxation::Method::hybrid);
  if (plain == nullptr || best == nullptr) return "";
  std::string text;
  using End = std::optional<relaxation::Moment>;
  const auto times = [&](const End& slow, const End& fast, const std::string& what) {
    if (!slow || !fast || !(fast->seconds > 0) || fast->sweeps == 0) return;
    text += fmt::format(
        "To {} the default method takes {} times fewer seconds and {} times fewer sweeps than "
        "explicit cycles at 0.8 of PFC3D's estimate. ",
        what, number_text(slow->seconds / fast->seconds),
        number_text(static_cast<double>(slow->sweeps) / static_cast<double>(fast->sweeps)));
  };
  times(plain->reaches(coarse), best->reaches(coarse), "a ratio of 0.001");
  times(plain->reaches_end(), best->reaches_end(), fmt::format("the end ({:.0e})", tolerance));
  if (!plain->result.converged)
    text += fmt::format("Explicit cycles did not come to {:.0e} in {} steps. ", tolerance,
                        grouped(plain->result.explicit_steps));
  return text;
}

}  // namespace

std::string page_of(const RelaxationReport& report) {
  Page page("Ways to an equilibrium", fmt::format("eigengrain {}", EIGENGRAIN_VERSION));
  page.paragraph(
      fmt::format("Each method alone from the same start to a mean unbalanced ratio of {:.0e}. explicit: "
                  "cycles at 0.8 of PFC3D's "
                  "estimate of the step; tracked: at the tracked step; scaled: with masses scaled body by "
                  "body; fire: FIRE with "
                  "these masses; newton: Newton's method alone; hybrid: the default, tracked cycles and then "
                  "Newton's method. "
                  "Cycles have a local damping of 0.7.",
                  report.tolerance));
  for (const RelaxedScene& scene : report.scenes) {
    page.section(scene.name);
    if (!scene.skipped.empty()) {
      page.paragraph(scene.skipped);
      continue;
    }
    page.paragraph(fmt::format("{}, {} at the start. {}", counted(scene.bodies, "body", "bodies"),
                               counted(scene.contacts, "acting contact", "acting contacts"),
                               verdict_of(scene, report.tolerance)));
    add_pictures(scene, page);
    add_table(scene, page);
  }
  return page.finish();
}

}  // namespace eigengrain::app
