#include "eigengrain/io/packing_file.hpp"

#include "eigengrain/io/suggest.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <fstream>
#include <limits>
#include <system_error>

namespace eigengrain::io {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t columns = 4;
constexpr std::array<std::string_view, columns> column_names{"x", "y", "z", "r"};

constexpr bool is_blank(char c) {
  return c == ' ' || c == '\t' || c == '\r' || c == '\v' || c == '\f';
}

/// The next word of a line, which it is removed from; empty at the end.
std::string_view take_word(std::string_view& line) {
  std::size_t begin = 0;
  while (begin < line.size() && is_blank(line[begin])) ++begin;
  std::size_t end = begin;
  while (end < line.size() && !is_blank(line[end])) ++end;
  const std::string_view word = line.substr(begin, end - begin);
  line.remove_prefix(end);
  return word;
}

/// What is wrong with a word that should be a number; empty if nothing is.
std::string number_problem(std::string_view word, double& value) {
  std::string_view digits = word;
  if (digits.size() > 1 && digits[0] == '+' && digits[1] != '-') digits.remove_prefix(1);
  const auto [end, error] = std::from_chars(digits.data(), digits.data() + digits.size(), value);
  if (error == std::errc::result_out_of_range) return "is too large or too small for a number";
  if (error == std::errc() && end == digits.data() + digits.size())
    return std::isfinite(value) ? std::string() : "is not a finite number";
  if (word.find(',') != std::string_view::npos)
    return "is not a number; separate columns by blanks, not commas";
  return "is not a number; a packing file holds plain numbers in m";
}

/// Reads the rows of one file.
class PackingParser {
 public:
  PackingParser(const std::string& name, Diagnostics& diagnostics) : name_(name), diagnostics_(diagnostics) {}

  void take_line(std::string_view line, std::int32_t number) {
    line = line.substr(0, line.find('#'));
    std::array<double, columns> values{};
    std::size_t count = 0;
    for (std::string_view word = take_word(line); !word.empty(); word = take_word(line), ++count) {
      if (count >= columns) continue;
      const std::string problem = number_problem(word, values[count]);
      if (problem.empty()) continue;
      return report(number, "number", fmt::format("{} = \"{}\" {}", column_names[count], word, problem));
    }
    if (count == 0) return;
    if (count != columns)
      return report(number, "columns", fmt::format("{} columns; four are wanted: x y z r, in m", count));
    if (values[3] <= 0)
      return report(number, "radius", fmt::format("radius {} m is not positive", values[3]));
    packing_.position.emplace_back(values[0], values[1], values[2]);
    packing_.radius.push_back(values[3]);
    packing_.line.push_back(number);
  }

  Packing result() { return std::move(packing_); }

 private:
  void report(std::int32_t line, std::string_view kind, std::string message) {
    diagnostics_.add({name_, line}, std::move(message), kind);
  }

  const std::string& name_;
  Diagnostics& diagnostics_;
  Packing packing_;
};

std::string missing_file(const fs::path& file) {
  std::string text = fmt::format("there is no file \"{}\"", file.string());
  const fs::path folder = file.has_parent_path() ? file.parent_path() : fs::path(".");
  std::error_code error;
  if (!fs::is_directory(folder, error)) return text + fmt::format(" (nor a folder \"{}\")", folder.string());
  std::vector<std::string> names;
  for (fs::directory_iterator entry(folder, error), end; !error && entry != end; entry.increment(error))
    if (entry->is_regular_file(error)) names.push_back(entry->path().filename().string());
  std::sort(names.begin(), names.end());  // a folder lists its files in any order
  return text + did_you_mean(file.filename().string(), names);
}

}  // namespace

FileText read_text_file(const fs::path& file) {
  std::error_code error;
  if (!fs::exists(file, error)) return {{}, missing_file(file)};
  if (fs::is_directory(file, error))
    return {{}, fmt::format("\"{}\" is a folder, not a file", file.string())};
  std::ifstream input(file, std::ios::binary);
  FileText result;
  const std::uintmax_t size = fs::file_size(file, error);
  if (!error) result.text.reserve(size);
  std::array<char, 1U << 16U> block;
  while (input.read(block.data(), block.size()) || input.gcount() > 0)
    result.text.append(block.data(), static_cast<std::size_t>(input.gcount()));
  if (!input.eof()) result.problem = fmt::format("\"{}\" cannot be read", file.string());
  return result;
}

Packing parse_packing(std::string_view text, const std::string& name, Diagnostics& diagnostics) {
  PackingParser parser(name, diagnostics);
  for (std::int32_t line = 1; !text.empty(); ++line) {
    const std::size_t end = std::min(text.find('\n'), text.size());
    parser.take_line(text.substr(0, end), line);
    text.remove_prefix(std::min(end + 1, text.size()));
    if (line == std::numeric_limits<std::int32_t>::max()) {
      diagnostics.add({name, 0}, fmt::format("more than {} lines", line));
      break;
    }
  }
  return parser.result();
}

Packing read_packing_file(const fs::path& file, const Place& asked_at, Diagnostics& diagnostics) {
  const FileText content = read_text_file(file);
  if (!content.problem.empty()) {
    diagnostics.add(asked_at, content.problem);
    return {};
  }
  const std::int64_t mistakes_before = diagnostics.count();
  Packing packing = parse_packing(content.text, file.string(), diagnostics);
  if (packing.radius.empty() && diagnostics.count() == mistakes_before)
    diagnostics.add(asked_at, fmt::format("\"{}\" holds no balls; a line is x y z r, in m", file.string()));
  return packing;
}

}  // namespace eigengrain::io
