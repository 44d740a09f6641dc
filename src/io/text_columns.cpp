#include "text_columns.hpp"

#include "quantity.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstddef>
#include <numeric>

namespace eigengrain::io {
namespace {

constexpr bool is_blank(char c) {
  return c == ' ' || c == '\t' || c == '\r' || c == '\v' || c == '\f';
}

Parsed<double> read_column(std::string_view word) {
  constexpr std::string_view hint = "columns are plain numbers in m, separated by blanks";
  const auto [number, problem] = read_leading_number(word, hint);
  if (!number) return {.problem = problem};
  if (!number->rest.empty()) return {.problem = fmt::format("is not a number; {}", hint)};
  return {.value = number->value};
}

}  // namespace

std::optional<std::string_view> Lines::next() {
  if (rest_.empty()) return std::nullopt;
  const std::size_t end = std::min(rest_.find('\n'), rest_.size());
  const std::string_view line = rest_.substr(0, end);
  rest_.remove_prefix(std::min(end + 1, rest_.size()));
  ++number_;
  return line;
}

std::vector<std::string_view> words_of(std::string_view line) {
  line = line.substr(0, line.find('#'));
  std::vector<std::string_view> words;
  std::size_t at = 0;
  while (true) {
    while (at < line.size() && is_blank(line[at])) ++at;
    const std::size_t begin = at;
    while (at < line.size() && !is_blank(line[at])) ++at;
    if (begin == at) return words;
    words.push_back(line.substr(begin, at - begin));
  }
}

void PackingRows::report(std::int32_t line, std::string_view kind, std::string message) {
  diagnostics_.add({name_, line}, std::move(message), kind);
}

std::optional<double> PackingRows::number(std::string_view word, std::string_view column, std::int32_t line) {
  auto [value, problem] = read_column(word);
  if (!value) report(line, "number", fmt::format("{} = \"{}\" {}", column, word, problem));
  return value;
}

std::optional<std::int64_t> PackingRows::integer(std::string_view word, std::string_view column,
                                                 std::int32_t line) {
  auto [value, problem] = read_integer(word);
  if (!value) report(line, "integer", fmt::format("{}: {}", column, problem));
  return value;
}

void PackingRows::add(const Vec3& position, double radius, std::int32_t line) {
  if (radius <= 0) return report(line, "radius", fmt::format("radius {} m is not positive", radius));
  packing_.position.push_back(position);
  packing_.radius.push_back(radius);
  packing_.line.push_back(line);
}

void PackingRows::add(std::int64_t id, const Vec3& position, double radius, std::int32_t line) {
  add(position, radius, line);
  if (ids_.size() < packing_.radius.size()) ids_.push_back(id);
}

Packing PackingRows::result() {
  if (!ids_.empty()) sort_by_id();
  return std::move(packing_);
}

void PackingRows::sort_by_id() {
  std::vector<std::size_t> order(ids_.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::stable_sort(order.begin(), order.end(),
                   [&](std::size_t a, std::size_t b) { return ids_[a] < ids_[b]; });
  Packing sorted;
  for (std::size_t k = 0; k < order.size(); ++k) {
    const std::size_t row = order[k];
    sorted.position.push_back(packing_.position[row]);
    sorted.radius.push_back(packing_.radius[row]);
    sorted.line.push_back(packing_.line[row]);
    if (k > 0 && ids_[row] == ids_[order[k - 1]])
      report(packing_.line[row], "twice",
             fmt::format("id {} stands twice, first on line {}", ids_[row], packing_.line[order[k - 1]]));
  }
  packing_ = std::move(sorted);
}

}  // namespace eigengrain::io
