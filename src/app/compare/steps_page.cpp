#include "eigengrain/base/text.hpp"

#include "../text.hpp"
#include "report/chart.hpp"
#include "report/page.hpp"
#include "steps_report.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>
#include <string>
#include <vector>

namespace eigengrain::app {
namespace {

using report::Axis;
using report::Cell;
using report::Emphasis;
using report::Look;
using report::Mark;
using report::number_text;
using report::Page;
using timestep::Statistics;
using timestep::StepRun;
using timestep::StepStudy;

/// An error that runs are drawn by, as a part of something of its own kind.
struct Error {
  const char* name;
  double (*of)(const StepRun& run, const StepStudy& study);
  Look look;
};
constexpr Error trajectory_error{
    "trajectory",
    [](const StepRun& r, const StepStudy& s) { return r.trajectory / s.mean_radius; },
    {Mark::circle, report::colour::blue, true}};
constexpr Error end_error{"final state",
                          [](const StepRun& r, const StepStudy& s) { return r.final_state / s.mean_radius; },
                          {Mark::diamond, report::colour::green, true}};
constexpr Error energy_error{"energy balance",
                             [](const StepRun& r, const StepStudy& s) { return r.energy / s.energy; },
                             {Mark::square, report::colour::ink, false}};
constexpr Error restitution_error{"restitution",
                                  [](const StepRun& r, const StepStudy&) { return r.restitution; },
                                  {Mark::triangle, report::colour::vermilion, true}};

/// Of what is left where trajectories have parted.
constexpr std::array statistical_errors{
    Error{"mean kinetic energy",
          [](const StepRun& r, const StepStudy& s) {
            return std::abs(r.statistics.kinetic / s.reference.statistics.kinetic - 1);
          },
          {Mark::circle, report::colour::blue, true}},
    Error{"mean elastic energy",
          [](const StepRun& r, const StepStudy& s) {
            return std::abs(r.statistics.elastic / s.reference.statistics.elastic - 1);
          },
          {Mark::diamond, report::colour::green, true}},
    Error{"mean force at the end",
          [](const StepRun& r, const StepStudy& s) {
            return std::abs(r.statistics.contact_force / s.reference.statistics.contact_force - 1);
          },
          {Mark::cross, report::colour::purple, false}}};

/// Below this nothing but rounding is seen.
constexpr double least_drawn = 1e-14;

std::vector<Error> errors_of(const StepStudy& study) {
  std::vector<Error> drawn{energy_error, restitution_error};
  if (study.sensitivity.chaotic())
    drawn.insert(drawn.end(), statistical_errors.begin(), statistical_errors.end());
  else
    drawn.insert(drawn.end(), {trajectory_error, end_error});
  return drawn;
}

void add_error_picture(const StepStudy& study, Page& page) {
  double low = std::numeric_limits<double>::infinity();
  double high = 0;
  report::Chart chart{.title = "Errors against the step",
                      .x = Axis::logarithmic(1.01 * study.runs.front().fraction, study.runs.back().fraction),
                      .y = Axis::logarithmic(1, 10),
                      .x_name = "step as a part of the limit",
                      .y_name = "relative error",
                      .height = 460};
  for (const Error& error : errors_of(study)) {
    report::Series series{.name = error.name, .look = error.look, .joined = true};
    for (const StepRun& run : study.runs) {
      const double value = error.of(run, study);
      if (!run.trouble.empty() || !(value > least_drawn)) continue;
      series.points.push_back({run.fraction, value});
      low = std::min(low, value);
      high = std::max(high, value);
    }
    if (!series.points.empty()) chart.series.push_back(std::move(series));
  }
  if (!(high > 0)) return;
  chart.y = Axis::logarithmic(low, high);
  for (const int order : {1, 2}) {
    const double x_low = chart.x.low();
    const double end = chart.y.high() * 0.8;
    double start = end * std::pow(x_low / chart.x.high(), order);
    double x_start = x_low;
    if (start < chart.y.low()) {
      x_start = chart.x.high() * std::pow(chart.y.low() / end, 1.0 / order);
      start = chart.y.low();
    }
    chart.guides.push_back({fmt::format("order {}", order), {{x_start, start}, {chart.x.high(), end}}});
  }
  const char* paths =
      "Trajectory and final state: root mean square distance of the balls from the reference, over the mean "
      "radius. ";
  const char* means =
      "Trajectories have parted and are left out; means are those of the run and, for the force, of its end, "
      "against those of the smallest step. ";
  page.picture(
      svg_of(chart),
      fmt::format(
          "Errors against the step. {}Energy balance: largest imbalance of the energy ledger, over the "
          "largest energy in motion and springs. Restitution: root mean square error over the impacts. "
          "Dashed: orders 1 and 2.",
          study.sensitivity.chaotic() ? means : paths));
}

void add_time_picture(const StepStudy& study, Page& page) {
  report::Chart chart{.title = "Time of a run against the step",
                      .x = Axis::linear(0, study.runs.back().fraction),
                      .y = Axis::logarithmic(1, 10),
                      .x_name = "step as a part of the limit",
                      .y_name = "relative to the largest step",
                      .height = 320};
  const StepRun* last = nullptr;
  for (const StepRun& run : study.runs)
    if (run.trouble.empty()) last = &run;
  if (last == nullptr || !(last->seconds > 0)) return;
  report::Series steps{.name = "steps", .look = {Mark::square, report::colour::ink, false}, .joined = true};
  report::Series seconds{
      .name = "seconds", .look = {Mark::circle, report::colour::blue, true}, .joined = true};
  double low = 1;
  double high = 1;
  for (const StepRun& run : study.runs) {
    if (!run.trouble.empty()) continue;
    const double relative_steps = static_cast<double>(run.steps) / static_cast<double>(last->steps);
    const double relative_seconds = run.seconds / last->seconds;
    steps.points.push_back({run.fraction, relative_steps});
    seconds.points.push_back({run.fraction, relative_seconds});
    low = std::min({low, relative_steps, relative_seconds});
    high = std::max({high, relative_steps, relative_seconds});
  }
  chart.y = Axis::logarithmic(low, high);
  chart.series = {steps, seconds};
  page.picture(svg_of(chart),
               fmt::format("What a larger step saves: steps and seconds of the run, relative to the run "
                           "with the largest step, which took {} steps and {} s.",
                           grouped(last->steps), number_text(last->seconds)));
}

Cell cell(double value) {
  return std::isfinite(value) ? Cell{number_text(value)} : Cell{"·", Emphasis::faint};
}
Cell cell(const std::optional<double>& order) {
  return order ? Cell{fmt::format("{:.2f}", *order)} : Cell{"·", Emphasis::faint};
}

void add_error_table(const StepStudy& study, Page& page) {
  report::Table table{.columns = {{.name = "of limit", .number = true},
                                  {.name = "step [s]", .number = true},
                                  {.name = "steps", .number = true},
                                  {.name = "seconds", .number = true},
                                  {.name = "trajectory [m]", .number = true},
                                  {.name = "order", .number = true},
                                  {.name = "final state [m]", .number = true},
                                  {.name = "energy [J]", .number = true},
                                  {.name = "order", .number = true},
                                  {.name = "restitution", .number = true},
                                  {.name = "order", .number = true}},
                      .rows = {}};
  for (const StepRun& run : study.runs) {
    std::vector<Cell> row{{fmt::format("{:.4f}", run.fraction)}, {number_text(run.dt)}, {grouped(run.steps)}};
    if (run.trouble.empty())
      row.insert(row.end(), {cell(run.seconds), cell(run.trajectory), cell(run.trajectory_order),
                             cell(run.final_state), cell(run.energy), cell(run.energy_order),
                             cell(run.restitution), cell(run.restitution_order)});
    else
      row.push_back({"blew up: " + run.trouble, Emphasis::bad});
    table.rows.push_back(std::move(row));
  }
  page.table(table,
             "Errors, with the order observed against the run with about half the step. ·: the scene has no "
             "such thing, or the "
             "error is too near to that of the reference to tell an order.");
}

void add_statistics(const StepStudy& study, Page& page) {
  report::Table table{.columns = {{.name = "of limit"},
                                  {.name = "kinetic [J]", .number = true},
                                  {.name = "elastic [J]", .number = true},
                                  {.name = "contact force [N]", .number = true},
                                  {.name = "contacts", .number = true},
                                  {.name = "height [m]", .number = true}},
                      .rows = {}};
  const auto exact = [](double value) {
    return std::isfinite(value) ? Cell{fmt::format("{:.6g}", value)} : Cell{"·", Emphasis::faint};
  };
  const auto add = [&](const std::string& name, const Statistics& s) {
    table.rows.push_back({{name},
                          exact(s.kinetic),
                          exact(s.elastic),
                          exact(s.contact_force),
                          exact(s.contacts),
                          exact(s.height)});
  };
  add("smallest step", study.reference.statistics);
  for (const StepRun& run : study.runs)
    if (run.trouble.empty()) add(fmt::format("{:.4f}", run.fraction), run.statistics);
  add("by chaos alone", study.sensitivity.departure);
  page.table(
      table,
      "Means over the run of kinetic and elastic energy; at the end the mean force of the acting contacts, "
      "their number, and the height of the centre of mass. Last line: by how much a shift of all balls by "
      "10⁻¹⁰ of a radius changes each.");
}

/// "0.0048 at 0.05 of the limit, at worst 1.98 (at 0.89)": errors need not grow with the step.
std::string course_of(const Error& error, const std::vector<const StepRun*>& runs, const StepStudy& study) {
  const StepRun* worst = runs.front();
  for (const StepRun* run : runs)
    if (error.of(*run, study) > error.of(*worst, study)) worst = run;
  return fmt::format("{} at {:.2f} of the limit, at worst {} (at {:.2f})",
                     number_text(error.of(*runs.front(), study)), runs.front()->fraction,
                     number_text(error.of(*worst, study)), worst->fraction);
}

/// The page in a few sentences.
std::string verdict(const StepStudy& study) {
  std::vector<const StepRun*> runs;
  std::vector<std::string> lost;
  for (const StepRun& run : study.runs)
    if (run.trouble.empty())
      runs.push_back(&run);
    else
      lost.push_back(fmt::format("{:.2f}", run.fraction));
  std::string text;
  if (!lost.empty()) text += fmt::format("Runs blow up at {} of the limit. ", fmt::join(lost, ", "));
  if (runs.empty()) return text;
  text += fmt::format(
      "A step of {:.2f} of the limit takes {} times fewer steps than one of {:.2f}. ", runs.back()->fraction,
      number_text(static_cast<double>(runs.front()->steps) / static_cast<double>(runs.back()->steps)),
      runs.front()->fraction);
  if (study.sensitivity.chaotic())
    text += fmt::format(
        "The motion is chaotic: a shift of all balls by 10⁻¹⁰ of a radius grows {} times within the run, so "
        "trajectories say nothing of the step, and means do. ",
        number_text(study.sensitivity.growth));
  else
    text += fmt::format("From the path, in radii: {}. ", course_of(trajectory_error, runs, study));
  if (std::isfinite(runs.front()->energy))
    text += fmt::format("Energy balance, over the energy in motion and springs: {}. ",
                        course_of(energy_error, runs, study));
  if (std::isfinite(runs.front()->restitution))
    text += fmt::format("Coefficients of restitution: {}. ", course_of(restitution_error, runs, study));
  return text;
}

}  // namespace

std::string page_of(const StepsReport& report) {
  const StepStudy& study = report.study;
  Page page("What a larger step costs in accuracy",
            fmt::format("{}, eigengrain {}", report.name, EIGENGRAIN_VERSION));
  page.paragraph(verdict(study));
  page.paragraph(
      fmt::format("The scene ran for {} s with steps that are parts of the limit, {:.6e} s ({}). The "
                  "reference took steps of {} s{}; "
                  "its trajectory is known to {} m. Runs are compared at {}. A shift of all balls by 10⁻¹⁰ "
                  "of a radius grows {} "
                  "times.",
                  number_text(study.time), study.limit, report.limit, number_text(study.reference.dt),
                  study.reference.extrapolated_order > 0
                      ? fmt::format(", extrapolated to none at order {} (observed {:.3f})",
                                    study.reference.extrapolated_order, study.reference.order)
                      : std::string(),
                  number_text(study.reference.uncertainty), counted(study.samples, "moment", "moments"),
                  number_text(study.sensitivity.growth)));
  page.section("Errors");
  add_error_picture(study, page);
  add_error_table(study, page);
  page.section("Time saved");
  add_time_picture(study, page);
  page.section("Statistics");
  add_statistics(study, page);
  return page.finish();
}

}  // namespace eigengrain::app
