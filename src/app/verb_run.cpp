#include "eigengrain/assembly/balance.hpp"
#include "eigengrain/assembly/bonds.hpp"
#include "eigengrain/cycle/mass_scaling.hpp"

#include "explicit_run.hpp"
#include "interrupt.hpp"
#include "staged_run.hpp"
#include "state_report.hpp"
#include "text.hpp"
#include "verbs.hpp"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <utility>

namespace eigengrain::app {
namespace {

using assembly::State;

nlohmann::ordered_json masses_of(const State& state) {
  const cycle::ScaledMasses masses = cycle::scaled_masses(state.model.bodies);
  return {{"form", model::name_of(state.settings.mass_scaling->form)},
          {"bodies", masses.bodies},
          {"heavier", masses.heavier},
          {"largest_factor", masses.largest},
          {"mass", masses.mass},
          {"added", masses.added},
          {"added_part", masses.mass > 0 ? masses.added / masses.mass : 0.0}};
}

void print_masses(const nlohmann::ordered_json& masses) {
  fmt::print("\nmasses: {} of {} bodies are heavier, by {:.3g} times at most; {:+.3g}% of mass in all",
             grouped(masses["heavier"]), grouped(masses["bodies"]), masses["largest_factor"].get<double>(),
             100 * masses["added_part"].get<double>());
}

nlohmann::ordered_json to_json(const CycleWork& work, const State& state, double rate) {
  nlohmann::ordered_json report{
      {"steps", work.steps},
      {"step", state.step},
      {"time", state.time},
      {"dt", state.dt},
      {"seconds", work.seconds},
      {"particle_steps_per_second", rate},
      {"lists", state.list.rebuilds},
      {"policy", {{"asked", work.steps_chosen}, {"seconds", work.choosing_seconds}}}};
  add_balance(report, assembly::balance_of(state));
  add_energies(report, state);
  if (state.ledger) add_ledger(report, state);
  if (state.settings.mass_scaling) report["mass_scaling"] = masses_of(state);
  const std::int64_t bonds = assembly::count_bonds(state.model);
  if (bonds > 0 || work.broken > 0) report["bonds"] = {{"intact", bonds}, {"broken", work.broken}};
  return report;
}

/// What run and its stages end with.
void conclude(const CycleWork& work, const State& state, const std::filesystem::path& state_file,
              const nlohmann::ordered_json* stages, const Options& options) {
  const double rate = work.seconds > 0 ? static_cast<double>(work.steps) *
                                             static_cast<double>(state.model.bodies.size()) / work.seconds
                                       : 0.0;
  nlohmann::ordered_json report = to_json(work, state, rate);
  if (stages != nullptr) report["stages"] = *stages;
  report["state"] = state_file.string();
  write_json(options.json, report);

  fmt::print("{}: {} in {}, t = {:.6g} s", state.settings.name, counted(work.steps, "step", "steps"),
             duration_text(work.seconds), state.time);
  if (rate > 0) fmt::print(", {:.3g} million ball steps a second", 1e-6 * rate);
  if (report.contains("mass_scaling")) print_masses(report["mass_scaling"]);
  if (state.settings.timestep.policy == model::TimestepPolicy::tracked && work.seconds > 0)
    fmt::print("\nstep proven anew {}, in {:.1f}% of the time", counted(work.steps_chosen, "time", "times"),
               100 * work.choosing_seconds / work.seconds);
  if (report.contains("bonds"))
    fmt::print("\nbonds: {} intact, {} broken", grouped(report["bonds"]["intact"]), grouped(work.broken));
  fmt::print("\n{}\nstate: {}\n", balance_text(assembly::balance_of(state)), state_file.string());
  if (interrupted() != 0) {
    fmt::print(stderr, "interrupted; continue with: eigengrain run {}\n", state_file.string());
    throw Interrupted{interrupted()};
  }
}

void run_once(Input input, const Options& options) {
  ExplicitRun run(std::move(input));
  run.go();
  conclude(run.work(), run.state(), run.outputs().state_file(), nullptr, options);
  if (run.goal().missed()) fmt::print("{} in that time\n", run.goal().text_of_missed());
  if (run.work().steps == 0 && !run.goal().missed())
    fmt::print("nothing to do: what the scene runs to is reached; --set run.steps={} would go on\n",
               run.state().step + 10000);
}

void run_stages(Input input, const Options& options) {
  StagedRun run(std::move(input));
  if (run.done())
    fmt::print("all stages are done; --set \"stages=[]\" --set run.steps={} would go on\n",
               run.state().step + 10000);
  run.go();
  conclude(run.work(), run.state(), run.state_file(), &run.report(), options);
}

}  // namespace

void run(const Options& options) {
  Input input = read_input(options);
  print_notes(input.state.settings);
  if (input.state.settings.stages.empty())
    run_once(std::move(input), options);
  else
    run_stages(std::move(input), options);
}

}  // namespace eigengrain::app
