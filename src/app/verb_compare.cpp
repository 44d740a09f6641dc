#include "eigengrain/assembly/local_damping.hpp"
#include "eigengrain/base/error.hpp"
#include "eigengrain/cycle/policy.hpp"
#include "eigengrain/petsc/session.hpp"
#include "eigengrain/timestep/truth.hpp"

#include "compare/relaxation_report.hpp"
#include "compare/steps_report.hpp"
#include "compare/timesteps_report.hpp"
#include "input.hpp"
#include "text.hpp"
#include "verbs.hpp"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <cerrno>
#include <cmath>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <limits>

namespace eigengrain::app {
namespace {

/// Before anything is computed.
void check_page(const std::string& file) {
  if (file.empty()) return;
  const std::filesystem::path folder = std::filesystem::path(file).parent_path();
  if (std::filesystem::is_directory(file) || (!folder.empty() && !std::filesystem::is_directory(folder)))
    throw InputError(
        fmt::format("--output {}: cannot write there; name a file in a folder that exists, e.g. {}", file,
                    "report.html"));
}

void write_page(const std::string& file, const std::string& html) {
  if (file.empty()) return;
  std::ofstream out(file);
  out << html;
  out.flush();
  if (!out)
    throw InputError(fmt::format("--output {}: cannot write there ({}); name a file in a folder that exists",
                                 file, std::strerror(errno)));
}

template <class Report>
void publish(const Report& report, const Options& options) {
  write_json(options.json, to_json(report));
  write_page(options.page, page_of(report));
  print(report);
}

/// How far a scene runs, s.
double time_of(const assembly::State& state, const Options& options, double policy_dt) {
  if (options.time > 0) return options.time;
  const model::RunChoice& run = state.settings.run;
  if (run.time) return *run.time;
  if (run.steps) return static_cast<double>(*run.steps) * policy_dt;
  throw InputError(
      fmt::format("{}: the scene does not say how long to run; give a time, e.g. --time 0.1, or add run: "
                  "{{time: 0.1}} to it",
                  options.scene));
}

struct Limit {
  double dt = 0;
  const char* what = "";
};

/// The largest stable step at the start: the true one of what touches, or where nothing does what is proven
/// of the first contacts that may form.
Limit limit_of(const assembly::State& state) {
  const assembly::LinearSystem system(state.model);
  if (!system.elements.empty() && !system.unknowns.free_components().empty()) {
    const double limit =
        timestep::critical_timestep(system, assembly::damping_of_unknowns(state.model, system.unknowns))
            .limit;
    if (std::isfinite(limit)) return {limit, "true limit of the cycle at the start"};
  }
  model::Scene settings = state.settings;
  settings.timestep = {model::TimestepPolicy::bound, 1.0, {}};
  return {cycle::policy_of(settings).dt(state), "proven for the first contacts that may form"};
}

}  // namespace

void compare_timesteps(const Options& options) {
  check_page(options.page);
  for (const std::int64_t size : options.sizes)
    if (size < 10)
      throw InputError(
          fmt::format("--sizes {}: give numbers of balls from 10 on, e.g. 100,1000,10000", size));
  petsc::start();  // before the clocks of the comparison
  TimestepsReport report{.scenes = compare_scenes(options), .sizes = costs_by_size(options.sizes)};
  const auto done = std::count_if(report.scenes.begin(), report.scenes.end(),
                                  [](const ComparedScene& scene) { return scene.skipped.empty(); });
  publish(report, options);
  if (done == 0) throw InputError("no scene has a critical step to compare with; see above for each");
}

void compare_steps(const Options& options) {
  check_page(options.page);
  const assembly::State state = read_input(options).state;
  if (!state.settings.stages.empty())
    throw InputError(
        fmt::format("{}: a scene with stages changes its settings on the way; compare steps takes one with "
                    "run: {{time: ...}}, or "
                    "a state that a stage has saved with --set stages=[] and --time",
                    options.scene));
  petsc::start();
  const Limit limit = limit_of(state);
  timestep::StepStudyOptions study{
      .limit = limit.dt, .time = time_of(state, options, cycle::policy_of(state.settings).dt(state))};
  if (!options.fractions.empty()) study.fractions = options.fractions;
  fmt::print(stderr, "about {:.2g} steps of the cycle in all\n", timestep::steps_of(study));
  publish(
      StepsReport{
          .name = state.settings.name, .limit = limit.what, .study = timestep::study_steps(state, study)},
      options);
}

void compare_relaxation(const Options& options) {
  check_page(options.page);
  const RelaxationReport report = compare_relaxations(options);
  publish(report, options);
  if (std::ranges::all_of(report.scenes, [](const RelaxedScene& scene) { return !scene.skipped.empty(); }))
    throw InputError("no scene could be relaxed; see above for each");
}

}  // namespace eigengrain::app
