#include "staged_run.hpp"

#include "eigengrain/assembly/add_balls.hpp"
#include "eigengrain/assembly/balance.hpp"
#include "eigengrain/assembly/change_bodies.hpp"
#include "eigengrain/assembly/choose_contacts.hpp"
#include "eigengrain/assembly/selection.hpp"
#include "eigengrain/base/error.hpp"
#include "eigengrain/io/scene_reader.hpp"
#include "eigengrain/io/state_file.hpp"

#include "explicit_run.hpp"
#include "interrupt.hpp"
#include "state_report.hpp"
#include "text.hpp"
#ifdef EIGENGRAIN_PETSC
#include "relaxing.hpp"
#endif

#include <fmt/format.h>

#include <utility>

namespace eigengrain::app {
namespace {

using assembly::State;

/// "tilted.h5" -> "tilted-3.h5", where a stage repeats.
std::string save_name(const model::Stage& stage, std::int64_t repetition) {
  if (stage.repeat == 1) return stage.save;
  const std::filesystem::path name = stage.save;
  return fmt::format("{}-{}{}", name.stem().string(), repetition + 1, name.extension().string());
}

/// Stages that ask for what this program has not.
void require_possible(const model::Scene& settings) {
#ifndef EIGENGRAIN_PETSC
  for (std::size_t k = 0; k < settings.stages.size(); ++k)
    if (settings.stages[k].relax)
      throw InputError(fmt::format(
          "stages[{}]: this program was built without PETSc and cannot relax; build it with, or take run",
          k));
#else
  static_cast<void>(settings);
#endif
}

}  // namespace

StagedRun::StagedRun(Input input)
    : input_(std::move(input)), state_file_(input_.folder / (input_.stem + ".h5")) {
  require_possible(state().settings);
}

void StagedRun::go() {
  note_interrupts();
  while (in_hand() && interrupted() == 0) {
    if (!state().progress.begun) begin();
    if (stage().run.any())
      run();
    else if (stage().relax)
      relax();
    if (interrupted() != 0) return;
    finish();
  }
}

bool StagedRun::in_hand() const {
  const std::int64_t at = state().progress.stage;
  return at >= 0 && at < std::ssize(state().settings.stages);
}

const model::Stage& StagedRun::stage() const {
  return state().settings.stages[static_cast<std::size_t>(state().progress.stage)];
}

std::string StagedRun::title() const {
  std::string text =
      fmt::format("stage {} of {}", state().progress.stage + 1, state().settings.stages.size());
  if (!stage().name.empty()) text += fmt::format(" ({})", stage().name);
  if (stage().repeat > 1) text += fmt::format(", {} of {}", state().progress.repetition + 1, stage().repeat);
  return text;
}

/// All that the stage changes before it runs.
void StagedRun::begin() {
  const model::Stage stage = this->stage();  // settings may be replaced
  State& state = input_.state;
  const std::int64_t index = state.progress.stage;
  const bool kept_ledger = state.ledger.has_value();
  if (!stage.settings.empty()) {
    // As it would be by hand: saved, and read with other settings.
    io::write_state(state, state_file_);
    state = io::read_state(state_file_, stage.settings);
    adapt_to(stage.settings, state);
  }
  if (stage.adds_balls) {
    const assembly::Added added =
        assembly::add_balls(state, io::read_added_balls(state.settings, index, state.progress.repetition));
    fmt::print(
        "{}: {} more{}\n", title(), counted(added.balls, "ball", "balls"),
        added.left_out > 0 ? fmt::format(", {} left out where others are", grouped(added.left_out)) : "");
  }
  assembly::make_groups(state.model.bodies, stage.groups, state.groups,
                        fmt::format("stages[{}].groups", index));
  for (std::size_t k = 0; k < stage.bodies.size(); ++k)
    assembly::change_bodies(state, stage.bodies[k], fmt::format("stages[{}].bodies[{}]", index, k));
  for (std::size_t k = 0; k < stage.contacts.size(); ++k) {
    const std::int64_t chosen =
        assembly::choose_contacts(state, stage.contacts[k], fmt::format("stages[{}].contacts[{}]", index, k));
    fmt::print("{}: {} by {}\n", title(), counted(chosen, "contact", "contacts"), stage.contacts[k].take);
  }
  if (kept_ledger && !state.ledger)
    fmt::print("{}: the scene has another energy now: the ledger begins anew\n", title());
  if (!stage.run.any() && !stage.relax && !state.breaks.empty()) {  // else these write them
    work_.broken += std::ssize(state.breaks);
    RunOutputs(input_).write_breaks(std::exchange(state.breaks, {}));
  }
  state.progress.begun = true;
  state.progress.first_step = state.step;
  state.progress.first_time = state.time;
}

void StagedRun::run() {
  ExplicitRun run(std::move(input_));
  run.go();
  const CycleWork work = run.work();
  work_ += work;
  const cycle::Goal goal = run.goal();
  input_ = run.take_input();
  const assembly::Balance balance = assembly::balance_of(state());
  nlohmann::ordered_json entry{{"stage", state().progress.stage},
                               {"name", stage().name},
                               {"does", "run"},
                               {"steps", work.steps},
                               {"time", state().time},
                               {"met", goal.reached(state()) && !goal.missed()}};
  add_balance(entry, balance);
  report_.push_back(std::move(entry));
  fmt::print("{}: {} in {}, t = {:.6g} s{}\n  {}\n", title(), counted(work.steps, "step", "steps"),
             duration_text(work.seconds), state().time,
             goal.missed() && interrupted() == 0 ? "; " + goal.text_of_missed() : "", balance_text(balance));
}

void StagedRun::relax() {
#ifdef EIGENGRAIN_PETSC
  RunOutputs outputs(input_);
  const relaxation::RelaxResult result =
      relax_with_reports(input_.state, stage().relax->tolerance, stage().relax->max_steps);
  work_.broken += std::ssize(input_.state.breaks);
  outputs.write_breaks(std::exchange(input_.state.breaks, {}));
  outputs.save(state());
  nlohmann::ordered_json entry{{"stage", state().progress.stage},
                               {"name", stage().name},
                               {"does", "relax"},
                               {"converged", result.converged},
                               {"method", result.method},
                               {"steps", result.explicit_steps},
                               {"time", state().time},
                               {"iterations", result.newton_iterations}};
  add_balance(entry, result.end);
  report_.push_back(std::move(entry));
  fmt::print("{}: {}, {} of Newton, {}\n  {}\n", title(),
             counted(result.explicit_steps, "explicit step", "explicit steps"),
             counted(result.newton_iterations, "iteration", "iterations"), duration_text(result.seconds),
             balance_text(result.end));
  if (!result.converged && interrupted() == 0)
    throw SolverError(fmt::format("{}: no equilibrium within {:g} was found; the nearest state is in {}",
                                  title(), stage().relax->tolerance, state_file_.string()));
#endif
}

void StagedRun::finish() {
  const std::string name = stage().save.empty() ? "" : save_name(stage(), state().progress.repetition);
  const std::int64_t repeat = stage().repeat;
  model::StageProgress& progress = input_.state.progress;
  progress.begun = false;
  if (++progress.repetition >= repeat) {
    ++progress.stage;
    progress.repetition = 0;
  }
  if (!name.empty()) io::write_state(state(), input_.folder / name);
  io::write_state(state(), state_file_);
}

}  // namespace eigengrain::app
