#include "text_file.hpp"

#include "eigengrain/io/suggest.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <fstream>
#include <sstream>
#include <system_error>
#include <utility>
#include <vector>

namespace eigengrain::io {

namespace fs = std::filesystem;

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

bool has_ending(std::string_view name, std::string_view ending) {
  if (name.size() < ending.size()) return false;
  return std::equal(ending.begin(), ending.end(), name.end() - static_cast<std::ptrdiff_t>(ending.size()),
                    [](char e, char c) { return e == std::tolower(static_cast<unsigned char>(c)); });
}

Parsed<std::string> read_text_file(const fs::path& file) {
  std::error_code error;
  if (!fs::exists(file, error)) return {.problem = missing_file(file)};
  if (fs::is_directory(file, error))
    return {.problem = fmt::format("\"{}\" is a folder, not a file", file.string())};
  std::ifstream input(file, std::ios::binary);
  std::ostringstream text;
  text << input.rdbuf();
  if (!input || text.bad()) return {.problem = fmt::format("\"{}\" cannot be read", file.string())};
  return {.value = std::move(text).str()};
}

}  // namespace eigengrain::io
