#pragma once

#include "eigengrain/io/break_file.hpp"
#include "eigengrain/io/history.hpp"
#include "eigengrain/io/series.hpp"

#include "input.hpp"

#include <cstdint>
#include <deque>
#include <filesystem>
#include <optional>
#include <span>

namespace eigengrain::app {

/// All that a run writes: its state (FOLDER/STEM.h5), frames for ParaView, and histories.
class RunOutputs {
 public:
  /// Takes over what an earlier part of the run has written, and notes in the input what it opens.
  explicit RunOutputs(Input& input);

  /// The first step after this one at which something is due.
  std::int64_t next(std::int64_t step) const;
  /// Frames and lines that are due at the state's step.
  void write_due(const assembly::State& state);
  /// Bonds that broke, as the cycle hands them out.
  void write_breaks(std::span<const assembly::BondBreak> breaks);
  bool checkpoint_due(std::int64_t step) const;
  /// Saves the state, after all that was written before it.
  void save(const assembly::State& state);

  const std::filesystem::path& state_file() const { return state_file_; }
  /// The step of the state that was saved last.
  std::int64_t saved_step() const { return saved_step_; }

 private:
  model::OutputChoice choice_;
  std::filesystem::path state_file_;
  std::int64_t saved_step_ = 0;
  std::deque<io::Series> series_;  ///< balls; and surfaces, if there are any
  std::deque<io::HistoryFile> histories_;
  std::optional<io::BreakFile> breaks_;  ///< where the scene has bonds
};

}  // namespace eigengrain::app
