#pragma once

#include "eigengrain/assembly/state.hpp"
#include "eigengrain/measures/ledger.hpp"
#include "eigengrain/measures/measure.hpp"

#include <cstdint>
#include <cstdio>
#include <filesystem>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace eigengrain::io {

/// What a line of a table says beside the balls. Only what the table has columns for needs to be filled.
struct HistoryValues {
  struct Energies {
    double kinetic = 0;        ///< J
    double elastic = 0;        ///< J
    double gravitational = 0;  ///< J
  };
  struct Unbalanced {
    double mean = 0;
    double max = 0;
  };

  Energies energies{};
  Unbalanced unbalanced{};
  std::vector<Vec3> wall_forces{};     ///< [walls] N
  std::vector<Vec3> wall_moments{};    ///< [walls] about their centres, N m
  std::vector<Vec3> wall_positions{};  ///< [walls] their centres, m
  measures::Ledger ledger{};
  std::vector<measures::Measure> regions{};  ///< [regions of the history]
};

/// A table that a run writes (docs/scene-schema.md, `histories`): CSV with one line of names and units,
/// numbers with all their digits. Each line is handed to the system at once, so that a run that is killed has
/// lost none.
class HistoryFile {
 public:
  /// walls: their names. Opens FOLDER/<history.file>; a file that is there is replaced, or with
  /// `continue_from` taken over up to the line of that step: what stands behind, and a line that was cut off,
  /// goes. Throws InputError where the file is not the table of this history, or cannot be written.
  HistoryFile(const std::filesystem::path& folder, const model::History& history,
              std::span<const std::string> walls, std::optional<std::int64_t> continue_from = {});

  /// Whether the table wants a line of this step: the values of others need not be computed.
  bool due(std::int64_t step) const { return step % history_.every == 0; }
  const model::History& history() const { return history_; }

  /// Adds a line; nothing if the step is not due, or has its line.
  void add(const assembly::State& state, const HistoryValues& values);

  /// Waits until the lines are on the disk. Before a checkpoint, so that no lines before it are missing even
  /// where the whole machine went down after it.
  void sync();

 private:
  struct Close {
    // NOLINTNEXTLINE(cppcoreguidelines-owning-memory): the unique_ptr is the owner
    void operator()(std::FILE* file) const { std::fclose(file); }
  };

  void take_over(std::int64_t step);
  std::string header(std::span<const std::string> walls) const;
  std::string line(const assembly::State& state, const HistoryValues& values);
  std::size_t row_of(std::int64_t identity, std::size_t hint, const model::Bodies& bodies) const;
  void write(std::string_view text);

  model::History history_;
  std::filesystem::path file_name_;
  std::string header_;
  std::size_t columns_ = 0;
  std::size_t walls_ = 0;
  std::vector<std::size_t> rows_;          ///< [balls of the history] where they were last found
  std::optional<std::int64_t> last_step_;  ///< of the last line
  std::unique_ptr<std::FILE, Close> file_;
};

}  // namespace eigengrain::io
