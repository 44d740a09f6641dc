#include "relaxing.hpp"

#include "eigengrain/base/error.hpp"
#include "eigengrain/io/break_file.hpp"
#include "eigengrain/io/state_file.hpp"
#include "eigengrain/petsc/session.hpp"

#include "interrupt.hpp"
#include "text.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <optional>
#include <string>

namespace eigengrain::app {
namespace {

using relaxation::RelaxResult;

/// ": 2 groups of bodies fall, ..." where some do.
std::string text_of_floating(const RelaxResult& result) {
  if (result.floating.empty()) return "";
  const relaxation::Floating& largest = result.floating.front();
  return fmt::format(
      ": {} that neither a wall nor a held body touches {} under its loads, the largest of {} "
      "(with ball {})",
      counted(std::ssize(result.floating), "group of bodies", "groups of bodies"),
      result.floating.size() == 1 ? "moves" : "move", counted(largest.bodies, "body", "bodies"),
      largest.first);
}

std::string text_of_servo(const RelaxResult& result, double tolerance) {
  if (result.missing_force <= tolerance) return "";
  return fmt::format(": a servo wall misses {:.2g} of its force", result.missing_force);
}

}  // namespace

relaxation::RelaxResult relax_with_reports(assembly::State& state, double tolerance, std::int64_t max_steps,
                                           relaxation::Method method) {
  petsc::start();  // before the clock
  note_interrupts();
  relaxation::RelaxOptions wanted;
  wanted.tolerance = tolerance;
  wanted.max_steps = max_steps;
  wanted.method = method;
  wanted.report = [](const std::string& line) { fmt::print(stderr, "{}\n", line); };
  wanted.interrupted = [] { return interrupted() != 0; };
  const relaxation::RelaxResult result = relaxation::relax(state, wanted);
  for (assembly::BondBreak& found : state.breaks) {  // relaxation has steps, but no time
    found.step = state.step;
    found.time = state.time;
  }
  return result;
}

RelaxResult relax_or_save(assembly::State& state, double tolerance, std::int64_t max_steps,
                          relaxation::Method method, const std::filesystem::path& file) {
  try {
    return relax_with_reports(state, tolerance, max_steps, method);
  } catch (const SolverError& error) {
    save_equilibrium(state, file);
    throw SolverError(fmt::format("{}; the last good state is in {}", error.what(), file.string()));
  }
}

void save_equilibrium(const assembly::State& state, const std::filesystem::path& file) {
  io::write_state(state, file);
  if (state.breaks.empty()) return;
  // Where a run from the state goes on with the table.
  io::BreakFile(file.parent_path(), file.stem().string() + "-breaks.csv", std::nullopt).add(state.breaks);
}

std::string why_not(const RelaxResult& result, double tolerance) {
  return text_of_floating(result) + text_of_servo(result, tolerance) +
         (tolerance < 1.5 * result.end.floor
              ? fmt::format(
                    " (the rounding of positions alone makes {:.1e}: ask for no less than twice that)",
                    result.end.floor)
              : "");
}

double mean_of(const RelaxResult& result) {
  return std::max(result.end.mean, result.end.moment_mean);
}

}  // namespace eigengrain::app
