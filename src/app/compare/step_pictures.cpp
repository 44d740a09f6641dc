#include "step_pictures.hpp"

#include "eigengrain/base/text.hpp"

#include "../text.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <vector>

namespace eigengrain::app {
namespace {

using report::Axis;
using report::Mark;
using report::number_text;
using report::Page;
using timestep::StepRun;
using timestep::StepStudy;

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

}  // namespace

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

}  // namespace eigengrain::app
