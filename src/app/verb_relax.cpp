#include "eigengrain/base/error.hpp"
#include "eigengrain/io/break_file.hpp"
#include "eigengrain/io/state_file.hpp"
#include "eigengrain/petsc/session.hpp"
#include "eigengrain/relaxation/relax.hpp"

#include "input.hpp"
#include "interrupt.hpp"
#include "progress.hpp"
#include "relaxing.hpp"
#include "state_report.hpp"
#include "text.hpp"
#include "verbs.hpp"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <filesystem>

namespace eigengrain::app {
namespace {

using assembly::State;
using relaxation::RelaxResult;

nlohmann::ordered_json to_json(const RelaxResult& result, const State& state) {
  nlohmann::ordered_json report{{"converged", result.converged},
                                {"method", result.method},
                                {"steps", result.explicit_steps},
                                {"part_steps", result.part_steps},
                                {"iterations", result.newton_iterations},
                                {"linear_iterations", result.linear_iterations},
                                {"attempts", result.attempts},
                                {"time", state.time},
                                {"seconds", result.seconds},
                                {"explicit_seconds", result.explicit_seconds},
                                {"start", {{"mean", result.start.mean}, {"max", result.start.max}}}};
  add_balance(report, result.end);
  add_energies(report, state);
  return report;
}

}  // namespace

void relax(const Options& options) {
  if (!options.petsc.empty()) petsc::set_options(options.petsc);
  Input input = read_input(options);
  print_notes(input.state.settings);
  const RelaxResult result = relax_with_reports(input.state, options.tolerance, options.max_steps);
  const std::filesystem::path file = input.folder / (input.stem + "-relaxed.h5");
  io::write_state(input.state, file);
  auto report = to_json(result, input.state);
  report["state"] = file.string();
  if (!input.state.breaks.empty()) report["bonds_broken"] = input.state.breaks.size();
  write_json(options.json, report);
  if (!input.state.breaks.empty()) {
    // Where a run from the relaxed state goes on with the table.
    io::BreakFile(input.folder, input.stem + "-relaxed-breaks.csv", std::nullopt).add(input.state.breaks);
    fmt::print("{} broke on the way\n", counted(std::ssize(input.state.breaks), "bond", "bonds"));
  }
  fmt::print("{}: {}{} in {} ({}), {} of Newton\n{}\nstate: {}\n", input.state.settings.name,
             counted(result.explicit_steps, "explicit step", "explicit steps"),
             result.part_steps > 0 ? fmt::format(" and {} of a few balls", grouped(result.part_steps)) : "",
             duration_text(result.seconds), result.method.empty() ? "nothing to do" : result.method,
             counted(result.newton_iterations, "iteration", "iterations"), balance_text(result.end),
             file.string());
  if (interrupted() != 0) throw Interrupted{interrupted()};
  // After all is saved, and only where Newton had a chance to ask for them.
  if (!options.petsc.empty() && result.attempts > 0) petsc::require_options_used();
  if (!result.converged)
    throw SolverError(fmt::format(
        "no equilibrium within {:g} was found{}; the nearest state is in {}", options.tolerance,
        options.tolerance < 1.5 * result.end.floor
            ? fmt::format(" (the rounding of positions alone makes {:.1e}: ask for no less than twice that)",
                          result.end.floor)
            : "",
        file.string()));
}

}  // namespace eigengrain::app
