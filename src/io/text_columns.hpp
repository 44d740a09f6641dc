#pragma once

#include "eigengrain/io/packing_file.hpp"

#include "diagnostics.hpp"

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

/// Texts of rows of numbers, as packing files of all formats are.
namespace eigengrain::io {

/// The lines of a text, one after the other, counted from 1.
class Lines {
 public:
  /// first: the number of the first line, where the text is the rest of a file.
  explicit Lines(std::string_view text, std::int32_t first = 1) : rest_(text), number_(first - 1) {}

  /// The next line without its end; nothing behind the last one.
  std::optional<std::string_view> next();
  /// Of the line that next returned last.
  std::int32_t number() const { return number_; }

 private:
  std::string_view rest_;
  std::int32_t number_;
};

/// The words of a line, up to a # if there is one.
std::vector<std::string_view> words_of(std::string_view line);

/// Balls as they are read out of the rows of one file, and its mistakes.
class PackingRows {
 public:
  PackingRows(const std::string& name, Diagnostics& diagnostics) : name_(name), diagnostics_(diagnostics) {}

  /// kind: mistakes of one kind are listed up to a limit.
  void report(std::int32_t line, std::string_view kind, std::string message);
  /// The word as a number; reported as that column's mistake if it is none.
  std::optional<double> number(std::string_view word, std::string_view column, std::int32_t line);
  /// The word as a whole number; reported in the same way.
  std::optional<std::int64_t> integer(std::string_view word, std::string_view column, std::int32_t line);
  /// Adds a ball, or reports that its radius is not positive.
  void add(const Vec3& position, double radius, std::int32_t line);
  /// The same for a ball whose number in the file is not that of its row.
  void add(std::int64_t id, const Vec3& position, double radius, std::int32_t line);

  /// The balls; where they have ids, in the order of those. An id that stands twice is reported.
  Packing result();

 private:
  void sort_by_id();

  const std::string& name_;
  Diagnostics& diagnostics_;
  Packing packing_;
  std::vector<std::int64_t> ids_;  ///< of each ball, or none at all
};

}  // namespace eigengrain::io
