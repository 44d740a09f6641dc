#include "eigengrain/io/suggest.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <vector>

namespace eigengrain::io {
namespace {

constexpr int edit = 2;

char lower(char c) {
  return c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c;
}

int replacement(char a, char b) {
  if (a == b) return 0;
  return lower(a) == lower(b) ? 1 : edit;
}

}  // namespace

int spelling_distance(std::string_view a, std::string_view b) {
  // Three rows of the usual table: cost[i][j] turns the first i letters of a into the first j of b.
  std::vector<int> before(b.size() + 1), last(b.size() + 1), row(b.size() + 1);
  for (std::size_t j = 0; j <= b.size(); ++j) row[j] = edit * static_cast<int>(j);
  for (std::size_t i = 1; i <= a.size(); ++i) {
    before.swap(last);
    last.swap(row);
    row[0] = edit * static_cast<int>(i);
    for (std::size_t j = 1; j <= b.size(); ++j) {
      row[j] = std::min({last[j] + edit, row[j - 1] + edit, last[j - 1] + replacement(a[i - 1], b[j - 1])});
      const bool swapped = i > 1 && j > 1 && a[i - 1] == b[j - 2] && a[i - 2] == b[j - 1];
      if (swapped) row[j] = std::min(row[j], before[j - 2] + edit);
    }
  }
  return row.back();
}

std::string_view nearest_name(std::string_view word, std::span<const std::string> candidates) {
  // A third of the letters may be wrong, but never all of them. No name that we know is so long that
  // a word beyond the bound could be near it.
  constexpr std::size_t longest = 256;
  const int length = static_cast<int>(std::min(word.size(), longest));
  int best = std::min(edit * std::max(1, length / 3), edit * length - 1) + 1;
  std::string_view nearest;
  if (word.size() > longest) return nearest;
  for (const std::string& candidate : candidates) {
    const int distance = spelling_distance(word, candidate);
    if (distance >= best) continue;
    best = distance;
    nearest = candidate;
  }
  return nearest;
}

std::string did_you_mean(std::string_view word, std::span<const std::string> candidates) {
  const std::string_view nearest = nearest_name(word, candidates);
  return nearest.empty() ? std::string() : fmt::format("; did you mean \"{}\"?", nearest);
}

}  // namespace eigengrain::io
