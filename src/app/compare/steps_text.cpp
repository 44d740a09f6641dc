#include "../comparison_json.hpp"
#include "../text.hpp"
#include "steps_report.hpp"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <cmath>
#include <optional>

namespace eigengrain::app {
namespace {

using nlohmann::ordered_json;
using timestep::Statistics;
using timestep::StepRun;
using timestep::StepStudy;

std::string text_or_dash(double value) {
  return std::isfinite(value) ? fmt::format("{:.3e}", value) : "-";
}
std::string order_text(const std::optional<double>& order) {
  return order ? fmt::format("{:.2f}", *order) : "-";
}

ordered_json number(double value) {
  return json_number(value);
}
ordered_json number(const std::optional<double>& value) {
  return value ? json_number(*value) : ordered_json(nullptr);
}

ordered_json json_of(const Statistics& s) {
  return {{"kinetic", number(s.kinetic)},
          {"elastic", number(s.elastic)},
          {"contact_force", number(s.contact_force)},
          {"contacts", number(s.contacts)},
          {"height", number(s.height)}};
}

ordered_json json_of(const StepRun& run) {
  return {{"dt", run.dt},
          {"fraction", run.fraction},
          {"steps", run.steps},
          {"seconds", run.seconds},
          {"trajectory", number(run.trajectory)},
          {"trajectory_order", number(run.trajectory_order)},
          {"final_state", number(run.final_state)},
          {"energy", number(run.energy)},
          {"energy_order", number(run.energy_order)},
          {"restitution", number(run.restitution)},
          {"restitution_order", number(run.restitution_order)},
          {"mean_restitution", number(run.mean_restitution)},
          {"statistics", json_of(run.statistics)},
          {"trouble", run.trouble}};
}

void print_errors(const StepStudy& study) {
  fmt::print("{:>8} {:>11} {:>9} {:>9}  {:>10} {:>5}  {:>10}  {:>10} {:>5}  {:>10} {:>5}\n", "of limit",
             "dt [s]", "steps", "seconds", "path [m]", "order", "end [m]", "energy [J]", "order", "restit.",
             "order");
  for (const StepRun& run : study.runs) {
    fmt::print("{:>8.4f} {:>11.4e} {:>9} ", run.fraction, run.dt, run.steps);
    if (!run.trouble.empty())
      fmt::print("blew up: {}\n", run.trouble);
    else
      fmt::print("{:>9.2g}  {:>10} {:>5}  {:>10}  {:>10} {:>5}  {:>10} {:>5}\n", run.seconds,
                 text_or_dash(run.trajectory), order_text(run.trajectory_order),
                 text_or_dash(run.final_state), text_or_dash(run.energy), order_text(run.energy_order),
                 text_or_dash(run.restitution), order_text(run.restitution_order));
  }
}

void print_statistics(const StepStudy& study) {
  fmt::print("\n{:>8}  {:>12} {:>12} {:>12} {:>9} {:>13}\n", "of limit", "kinetic [J]", "elastic [J]",
             "force [N]", "contacts", "height [m]");
  const auto line = [](const std::string& what, const Statistics& s) {
    const auto cell = [](double value, int width) {
      return fmt::format("{:>{}}", std::isfinite(value) ? fmt::format("{:.5g}", value) : "-", width);
    };
    fmt::print("{:>8}  {} {} {} {} {}\n", what, cell(s.kinetic, 12), cell(s.elastic, 12),
               cell(s.contact_force, 12), cell(s.contacts, 9), cell(s.height, 13));
  };
  line("smallest", study.reference.statistics);
  for (const StepRun& run : study.runs)
    if (run.trouble.empty()) line(fmt::format("{:.4f}", run.fraction), run.statistics);
  line("by chaos", study.sensitivity.departure);
}

}  // namespace

void print(const StepsReport& report) {
  const StepStudy& study = report.study;
  fmt::print("{}: {:g} s, limit {:.6e} s ({})\n", report.name, study.time, study.limit, report.limit);
  fmt::print("reference: steps of {:.3e} s{}, its trajectory is known to {:.1e} m\n", study.reference.dt,
             study.reference.extrapolated_order > 0
                 ? fmt::format(", extrapolated at order {} (observed {:.3f})",
                               study.reference.extrapolated_order, study.reference.order)
                 : std::string(),
             study.reference.uncertainty);
  fmt::print("a shift of all balls by 1e-10 of a radius grows {:.2g} times{}\n\n", study.sensitivity.growth,
             study.sensitivity.chaotic()
                 ? ": CHAOTIC, trajectories say nothing of the step; compare the statistics"
                 : "");
  print_errors(study);
  print_statistics(study);
  fmt::print(
      "\npath: root mean square over balls and {} of the distance from the reference; end: at the end\n",
      counted(study.samples, "sample", "samples"));
  fmt::print("energy: largest imbalance of the ledger, of {:.3g} J in motion and springs at most\n",
             study.energy);
  if (study.impacts > 0)
    fmt::print("restitution: root mean square error over {}, mean {:.6f}\n",
               counted(study.impacts, "impact", "impacts"), study.reference.mean_restitution);
}

nlohmann::ordered_json to_json(const StepsReport& report) {
  const StepStudy& study = report.study;
  ordered_json runs = ordered_json::array();
  for (const StepRun& run : study.runs) runs.push_back(json_of(run));
  return {{"subject", "steps"},
          {"scene", report.name},
          {"limit", study.limit},
          {"limit_is", report.limit},
          {"time", study.time},
          {"samples", study.samples},
          {"mean_radius", study.mean_radius},
          {"energy", number(study.energy)},
          {"impacts", study.impacts},
          {"reference",
           {{"dt", study.reference.dt},
            {"order", number(study.reference.order)},
            {"extrapolated_order", study.reference.extrapolated_order},
            {"uncertainty", number(study.reference.uncertainty)},
            {"mean_restitution", number(study.reference.mean_restitution)},
            {"statistics", json_of(study.reference.statistics)}}},
          {"sensitivity",
           {{"growth", number(study.sensitivity.growth)},
            {"chaotic", study.sensitivity.chaotic()},
            {"departure", json_of(study.sensitivity.departure)}}},
          {"runs", runs}};
}

}  // namespace eigengrain::app
