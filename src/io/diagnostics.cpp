#include "diagnostics.hpp"

#include "eigengrain/base/text.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace eigengrain::io {

std::string text_of(const Place& place) {
  return place.line > 0 ? fmt::format("{}:{}", place.file, place.line) : place.file;
}

std::string text_of(const Vec3& position) {
  return fmt::format("({:.6g}, {:.6g}, {:.6g}) m", position[0], position[1], position[2]);
}

void Diagnostics::add(const Place& place, std::string message, std::string_view kind, std::int64_t most) {
  ++count_;
  if (!kind.empty()) {
    Kind& known = kinds_[{place.file, std::string(kind)}];
    if (known.count++ == most) {
      known.counting_entry = entries_.size();
      entries_.push_back({{place.file, 0, {}}, place.line, 0});
    }
    if (known.count > most) {
      ++entries_[known.counting_entry].left_out;
      return;
    }
  }
  entries_.push_back({{place.file, place.line, std::move(message)}, place.line, 0});
}

std::vector<Mistake> Diagnostics::mistakes() const {
  std::map<std::string, std::size_t> rank;
  for (const Entry& entry : entries_) rank.try_emplace(entry.mistake.file, rank.size());
  std::vector<Entry> sorted = entries_;
  std::stable_sort(sorted.begin(), sorted.end(), [&](const Entry& a, const Entry& b) {
    return std::pair(rank.at(a.mistake.file), a.sort_line) < std::pair(rank.at(b.mistake.file), b.sort_line);
  });
  std::vector<Mistake> result;
  result.reserve(sorted.size());
  for (Entry& entry : sorted) {
    if (entry.left_out > 0)
      entry.mistake.message = fmt::format("and {} more like it", grouped(entry.left_out));
    result.push_back(std::move(entry.mistake));
  }
  return result;
}

void Diagnostics::throw_if_any() const {
  if (any()) throw InputError(mistakes());
}

}  // namespace eigengrain::io
