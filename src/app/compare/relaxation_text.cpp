#include "eigengrain/base/text.hpp"

#include "../relaxing.hpp"
#include "../text.hpp"
#include "relaxation_report.hpp"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <algorithm>

namespace eigengrain::app {
namespace {

using nlohmann::ordered_json;
using relaxation::Moment;

std::string seconds_text(const std::optional<Moment>& moment) {
  return moment ? fmt::format("{:.2g}", moment->seconds) : "-";
}
std::string sweeps_text(const std::optional<Moment>& moment) {
  return moment ? grouped(moment->sweeps) : "-";
}

ordered_json json_of(const Moment& moment) {
  return {{"seconds", moment.seconds},
          {"sweeps", moment.sweeps},
          {"mean", moment.mean},
          {"max", moment.max},
          {"stage", moment.stage}};
}

ordered_json json_of(const MethodRun& run) {
  ordered_json json{{"method", run.name}};
  if (!run.failure.empty()) {
    json["failure"] = run.failure;
    return json;
  }
  json["converged"] = run.result.converged;
  json["mean"] = mean_of(run.result);
  json["floor"] = run.result.end.floor;
  json["unsupported"] = run.result.end.unsupported;
  json["steps"] = run.result.explicit_steps;
  json["part_steps"] = run.result.part_steps;
  json["iterations"] = run.result.newton_iterations;
  json["linear_iterations"] = run.result.linear_iterations;
  json["seconds"] = run.result.seconds;
  if (run.from_explicit) json["from_explicit"] = to_json(*run.from_explicit);
  ordered_json& course = json["course"] = ordered_json::array();
  for (const Moment& moment : run.result.course) course.push_back(json_of(moment));
  ordered_json& distances = json["distances"] = ordered_json::array();
  for (const Distance& distance : run.distances)
    distances.push_back(
        {{"seconds", distance.at.seconds}, {"sweeps", distance.at.sweeps}, {"distance", distance.distance}});
  return json;
}

}  // namespace

void print(const RelaxationReport& report) {
  for (const RelaxedScene& scene : report.scenes) {
    if (!scene.skipped.empty()) {
      fmt::print("{}: {}\n", scene.name, scene.skipped);
      continue;
    }
    fmt::print("{}: {}, {}\n", scene.name, counted(scene.bodies, "body", "bodies"),
               counted(scene.contacts, "acting contact", "acting contacts"));
    fmt::print("{:>10} {:>9} {:>9} {:>10} {:>10} {:>9} {:>6} {:>8} {:>9}  {}\n", "method", "s to 1e-3",
               "s to end", "sweeps", "sweeps", "steps", "Newton", "linear", "ratio", "forces from explicit");
    for (const MethodRun& run : scene.runs) {
      if (!run.failure.empty()) {
        fmt::print("{:>10} {}\n", run.name, run.failure);
        continue;
      }
      const std::optional<Moment> end = run.reaches_end();
      fmt::print("{:>10} {:>9} {:>9} {:>10} {:>10} {:>9} {:>6} {:>8} {:>9.1e}  {}\n", run.name,
                 seconds_text(run.reaches(coarse)), seconds_text(end), sweeps_text(run.reaches(coarse)),
                 sweeps_text(end), grouped(run.result.explicit_steps + run.result.part_steps),
                 run.result.newton_iterations, run.result.linear_iterations, mean_of(run.result),
                 run.from_explicit ? fmt::format("{:.1e}", run.from_explicit->forces) : "-");
    }
    fmt::print("\n");
  }
  fmt::print("a sweep goes once over the contacts: a step, a residual, or a product with a matrix\n");
}

ordered_json to_json(const RelaxationReport& report) {
  ordered_json scenes = ordered_json::array();
  for (const RelaxedScene& scene : report.scenes) {
    ordered_json json{{"name", scene.name}, {"file", scene.file}};
    if (!scene.skipped.empty()) {
      json["skipped"] = scene.skipped;
    } else {
      json["bodies"] = scene.bodies;
      json["contacts"] = scene.contacts;
      ordered_json& runs = json["runs"] = ordered_json::array();
      for (const MethodRun& run : scene.runs) runs.push_back(json_of(run));
    }
    scenes.push_back(std::move(json));
  }
  return {{"subject", "relaxation"}, {"tolerance", report.tolerance}, {"scenes", scenes}};
}

}  // namespace eigengrain::app
