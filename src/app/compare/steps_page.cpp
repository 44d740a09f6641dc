#include "eigengrain/base/text.hpp"

#include "../text.hpp"
#include "report/page.hpp"
#include "step_pictures.hpp"
#include "steps_report.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <cmath>
#include <optional>
#include <string>
#include <vector>

namespace eigengrain::app {
namespace {

using report::Cell;
using report::Emphasis;
using report::number_text;
using report::Page;
using timestep::Statistics;
using timestep::StepRun;
using timestep::StepStudy;

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
