#pragma once

#include "eigengrain/base/error.hpp"
#include "eigengrain/base/vec.hpp"

#include <cstdint>
#include <map>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace eigengrain::io {

/// Where something stands in what the user wrote.
struct Place {
  std::string file;
  int line = 0;  ///< 1-based; 0 where a line means nothing
};

/// "scene.yaml:12"
std::string text_of(const Place& place);
/// "(1, 0.5, -2) m"
std::string text_of(const Vec3& position);

/// Collects the mistakes found in an input, so that a user sees all of them at once. A kind of mistake that
/// a big file repeats is listed a number of times for that file, and then only counted.
class Diagnostics {
 public:
  static constexpr std::int64_t limit = 20;

  /// kind: any text that mistakes of one sort share; empty: never left out.
  /// most: how many of that kind are listed.
  void add(const Place& place, std::string message, std::string_view kind = {}, std::int64_t most = limit);

  bool any() const { return !entries_.empty(); }
  /// Mistakes added so far, those only counted included.
  std::int64_t count() const { return count_; }
  /// File after file, in the order in which they first appear, and by line within a file.
  std::vector<Mistake> mistakes() const;
  /// Throws an InputError if there is any mistake.
  void throw_if_any() const;

 private:
  struct Entry {
    Mistake mistake;
    int sort_line = 0;
    std::int64_t left_out = 0;  ///< of the entry that only counts
  };
  struct Kind {
    std::int64_t count = 0;
    std::size_t counting_entry = 0;
  };

  std::vector<Entry> entries_;
  std::map<std::pair<std::string, std::string>, Kind> kinds_;  ///< by file and kind
  std::int64_t count_ = 0;
};

}  // namespace eigengrain::io
