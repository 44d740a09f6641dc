#include "eigengrain/base/error.hpp"
#include "eigengrain/io/suggest.hpp"
#include "eigengrain/petsc/session.hpp"
#include "eigengrain/relaxation/relax.hpp"

#include "compare/equilibrium_difference.hpp"
#include "equilibrium_report.hpp"
#include "input.hpp"
#include "interrupt.hpp"
#include "loading.hpp"
#include "progress.hpp"
#include "relaxing.hpp"
#include "state_report.hpp"
#include "text.hpp"
#include "verbs.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace eigengrain::app {
namespace {

using assembly::State;
using relaxation::RelaxResult;

/// A method by name, as an option gives it.
relaxation::Method method_of(const std::string& option, const std::string& name) {
  if (const auto found = relaxation::find_method(name)) return *found;
  std::vector<std::string> known;
  for (const relaxation::NamedMethod& method : relaxation::methods) known.emplace_back(method.name);
  throw InputError(fmt::format("{} {}: there is no such method{} (methods: {})", option, name,
                               io::did_you_mean(name, known), fmt::join(known, ", ")));
}

nlohmann::ordered_json stages_of(const RelaxResult& result) {
  nlohmann::ordered_json stages = nlohmann::ordered_json::array();
  for (const relaxation::RelaxStage& stage : result.stages)
    stages.push_back({{"name", stage.name},
                      {"steps", stage.steps},
                      {"iterations", stage.iterations},
                      {"linear_iterations", stage.linear_iterations},
                      {"seconds", stage.seconds},
                      {"mean", stage.mean}});
  return stages;
}

/// The same start by another method, and how far its end is from this one: as text, and in the report.
std::string compare_with(relaxation::Method method, State state, const State& end, const Options& options,
                         nlohmann::ordered_json& report) {
  const std::string name(relaxation::name_of(method));
  RelaxResult other;
  try {
    other = relax_with_reports(state, options.tolerance, options.max_steps, method);
  } catch (const SolverError& error) {
    return fmt::format("nothing to compare with: {}", error.what());
  }
  if (!other.converged)
    return fmt::format("{} found no equilibrium in {} to compare with (ratio {:.1e})", name,
                       counted(other.explicit_steps, "step", "steps"), mean_of(other));
  const EquilibriumDifference difference = difference_of(state, end);
  report["against"] = to_json(difference);
  report["against"]["method"] = name;
  report["against"]["seconds"] = other.seconds;
  report["against"]["steps"] = other.explicit_steps;
  return fmt::format("from the end of {} ({} in {}): {}", name,
                     counted(other.explicit_steps, "step", "steps"), duration_text(other.seconds),
                     text_of(difference));
}

nlohmann::ordered_json to_json(const RelaxResult& result, const State& state) {
  nlohmann::ordered_json report{{"converged", result.converged},
                                {"method", result.method},
                                {"steps", result.explicit_steps},
                                {"part_steps", result.part_steps},
                                {"iterations", result.newton_iterations},
                                {"linear_iterations", result.linear_iterations},
                                {"attempts", result.attempts},
                                {"sweeps", result.course.empty() ? 0 : result.course.back().sweeps},
                                {"linear_method", result.linear_method},
                                {"linear_failures", result.linear_failures},
                                {"stages", stages_of(result)},
                                {"time", state.time},
                                {"seconds", result.seconds},
                                {"explicit_seconds", result.explicit_seconds},
                                {"start", {{"mean", result.start.mean}, {"max", result.start.max}}}};
  if (std::ranges::any_of(state.model.wall_motions,
                          [](const auto& motion) { return motion.servo.has_value(); }))
    report["missing_force"] = result.missing_force;
  add_balance(report, result.end);
  report["statuses"] = to_json(statuses_of(state));
  report["reactions"] = reactions_of(state);
  add_energies(report, state);
  return report;
}

}  // namespace

void relax(const Options& options) {
  const relaxation::Method method = method_of("--method", options.method);
  std::optional<relaxation::Method> against;
  if (!options.against.empty()) against = method_of("--against", options.against);
  if (!options.petsc.empty()) petsc::set_options(options.petsc);
  if (!options.loads.empty()) {
    if (against)
      throw InputError("--against compares one equilibrium, and --load finds many; leave one of the two out");
    return relax_along(options);
  }
  Input input = read_input(options);
  print_notes(input.state.settings);
  const std::optional<State> start = against ? std::optional<State>(input.state) : std::nullopt;
  const std::filesystem::path file = input.folder / (input.stem + "-relaxed.h5");
  const RelaxResult result = relax_or_save(input.state, options.tolerance, options.max_steps, method, file);
  save_equilibrium(input.state, file);
  auto report = to_json(result, input.state);
  report["state"] = file.string();
  std::string difference;
  if (against && result.converged) difference = compare_with(*against, *start, input.state, options, report);
  if (!input.state.breaks.empty()) report["bonds_broken"] = input.state.breaks.size();
  write_json(options.json, report);
  if (!input.state.breaks.empty())
    fmt::print("{} broke on the way\n", counted(std::ssize(input.state.breaks), "bond", "bonds"));
  fmt::print("{}: {}{} in {} ({}), {} of Newton\n{}\nstate: {}\n", input.state.settings.name,
             counted(result.explicit_steps, "explicit step", "explicit steps"),
             result.part_steps > 0 ? fmt::format(" and {} of a few balls", grouped(result.part_steps)) : "",
             duration_text(result.seconds), result.method.empty() ? "nothing to do" : result.method,
             counted(result.newton_iterations, "iteration", "iterations"), balance_text(result.end),
             file.string());
  fmt::print("{}\n", text_of(statuses_of(input.state)));
  if (!difference.empty()) fmt::print("{}\n", difference);
  if (interrupted() != 0) throw Interrupted{interrupted()};
  // After all is saved, and only where Newton had a chance to ask for them.
  if (!options.petsc.empty() && result.attempts > 0) petsc::require_options_used();
  if (!result.converged)
    throw SolverError(fmt::format("no equilibrium within {:g} was found{}; the nearest state is in {}",
                                  options.tolerance, why_not(result, options.tolerance), file.string()));
}

}  // namespace eigengrain::app
