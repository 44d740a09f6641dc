#include "run_outputs.hpp"

#include "eigengrain/assembly/balance.hpp"
#include "eigengrain/assembly/energies.hpp"
#include "eigengrain/assembly/forces.hpp"
#include "eigengrain/assembly/surroundings.hpp"
#include "eigengrain/io/state_file.hpp"
#include "eigengrain/measures/ledger.hpp"
#include "eigengrain/measures/measure.hpp"

#include <algorithm>
#include <limits>
#include <span>

namespace eigengrain::app {
namespace {

using assembly::State;

/// The first multiple of `every` after the step.
std::int64_t next_multiple(std::int64_t step, std::int64_t every) {
  return every > 0 ? (step / every + 1) * every : std::numeric_limits<std::int64_t>::max();
}

io::HistoryValues values_for(const model::History& history, const State& state) {
  io::HistoryValues values;
  if (history.energies) {
    const assembly::Energies e = assembly::energies_of(state);
    values.energies = {e.kinetic, e.elastic, e.gravitational};
  }
  if (history.unbalanced) {
    const assembly::Balance b = assembly::balance_of(state);
    values.unbalanced = {b.mean, b.max};
  }
  if (history.walls || history.wall_moments)
    for (const assembly::WallLoad& load : assembly::wall_loads(state.model)) {
      values.wall_forces.push_back(load.force);
      values.wall_moments.push_back(load.moment);
    }
  if (history.wall_positions) values.wall_positions = assembly::wall_centres(state.model);
  if (history.ledger) values.ledger = measures::ledger_of(state);
  if (!history.measures.empty()) values.regions = measures::measure(state.model, history.measures);
  return values;
}

}  // namespace

RunOutputs::RunOutputs(Input& input)
    : choice_(input.state.settings.outputs), state_file_(input.folder / (input.stem + ".h5")) {
  const std::int64_t step = input.state.step;
  // What lies there otherwise is of an older run.
  const auto ours = [&](const std::string& name) {
    return !input.opened.insert(name).second || input.continued;
  };
  const auto& rules = input.state.settings.contacts;
  const bool bonds =
      std::any_of(rules.begin(), rules.end(), [](const auto& rule) { return rule.bond.has_value(); });
  if (choice_.series_every > 0) {
    series_.emplace_back(input.folder, input.stem, io::Series::Of::balls, choice_.series_stress);
    if (!input.state.model.solids.empty())
      series_.emplace_back(input.folder, input.stem + "_solids", io::Series::Of::solids);
    if (!input.state.settings.surfaces.empty())
      series_.emplace_back(input.folder, input.stem + "_walls", io::Series::Of::surfaces);
    if (bonds) series_.emplace_back(input.folder, input.stem + "_breaks", io::Series::Of::breaks);
    for (io::Series& series : series_)
      if (ours(series.list_file().filename().string()) && std::filesystem::exists(series.list_file()))
        series.continue_from(step);
  }
  if (bonds)
    breaks_.emplace(input.folder, input.stem + "-breaks.csv",
                    ours(input.stem + "-breaks.csv") ? std::optional(step) : std::nullopt);
  for (model::History history : input.state.settings.histories) {
    // A state with a name of its own, as relax makes it, is another run: its tables stand beside the scene's.
    if (input.stem != std::filesystem::path(input.state.settings.name).stem())
      history.file = input.stem + "-" + history.file;
    const bool there = ours(history.file) && std::filesystem::exists(input.folder / history.file);
    histories_.emplace_back(input.folder, history, assembly::wall_names(input.state.model),
                            there ? std::optional(step) : std::nullopt);
  }
}

std::int64_t RunOutputs::next(std::int64_t step) const {
  std::int64_t next =
      std::min(next_multiple(step, choice_.checkpoint_every), next_multiple(step, choice_.series_every));
  for (const io::HistoryFile& history : histories_)
    next = std::min(next, next_multiple(step, history.history().every));
  return next;
}

void RunOutputs::write_due(const State& state) {
  if (choice_.series_every > 0 && state.step % choice_.series_every == 0)
    for (io::Series& series : series_)
      series.add(state, breaks_ ? breaks_->all() : std::span<const assembly::BondBreak>());
  for (io::HistoryFile& history : histories_)
    if (history.due(state.step)) history.add(state, values_for(history.history(), state));
}

void RunOutputs::write_breaks(std::span<const assembly::BondBreak> breaks) {
  if (breaks_) breaks_->add(breaks);
}

bool RunOutputs::checkpoint_due(std::int64_t step) const {
  return choice_.checkpoint_every > 0 && step % choice_.checkpoint_every == 0;
}

void RunOutputs::save(const State& state) {
  for (io::HistoryFile& history : histories_) history.sync();
  if (breaks_) breaks_->sync();
  io::write_state(state, state_file_);
  saved_step_ = state.step;
}

}  // namespace eigengrain::app
