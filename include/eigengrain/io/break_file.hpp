#pragma once

#include "eigengrain/assembly/bond_break.hpp"

#include <cstdint>
#include <cstdio>
#include <filesystem>
#include <memory>
#include <optional>
#include <span>
#include <string_view>
#include <vector>

namespace eigengrain::io {

/// The table of the bonds that broke, in the order in which they did: CSV with one line of names and units,
/// numbers with all their digits. Lines are handed to the system at once, so that a run that is killed has
/// lost none.
class BreakFile {
 public:
  /// Opens FOLDER/<name>; a file that is there is replaced, or with `continue_from` taken over up to that
  /// step: later lines, and one that was cut off, go. Throws InputError where the file is no such table, or
  /// cannot be written.
  BreakFile(const std::filesystem::path& folder, std::string_view name,
            std::optional<std::int64_t> continue_from = {});

  void add(std::span<const assembly::BondBreak> breaks);
  /// All lines of the table, those taken over included (rules are not in it).
  std::span<const assembly::BondBreak> all() const { return all_; }
  /// Waits until the lines are on the disk.
  void sync();

 private:
  struct Close {
    // NOLINTNEXTLINE(cppcoreguidelines-owning-memory): the unique_ptr is the owner
    void operator()(std::FILE* file) const { std::fclose(file); }
  };

  void take_over(std::int64_t step);

  std::filesystem::path file_name_;
  std::vector<assembly::BondBreak> all_;
  std::unique_ptr<std::FILE, Close> file_;
};

}  // namespace eigengrain::io
