#include "eigengrain/io/break_file.hpp"

#include "eigengrain/base/error.hpp"

#include "atomic_file.hpp"
#include "text_file.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <charconv>
#include <optional>
#include <string>
#include <system_error>

namespace eigengrain::io {
namespace {

constexpr std::string_view header =
    "step,time [s],ball a,ball b,x [m],y [m],z [m],normal x,normal y,normal z,mode,entry of contacts\n";

std::string line_of(const assembly::BondBreak& found) {
  const Vec3& x = found.place;
  const Vec3& n = found.normal;
  return fmt::format("{},{:.17g},{},{},{:.17g},{:.17g},{:.17g},{:.17g},{:.17g},{:.17g},{},{}\n", found.step,
                     found.time, found.first, found.second, x.x(), x.y(), x.z(), n.x(), n.y(), n.z(),
                     found.mode == contact::BreakMode::tension ? "tension" : "shear", found.entry);
}

/// Takes a number, and the comma behind it, off the text; whether there was one.
template <class T>
bool take(std::string_view& text, T& number) {
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number);
  if (error != std::errc()) return false;
  text.remove_prefix(static_cast<std::size_t>(end - text.data()));
  if (text.starts_with(',')) text.remove_prefix(1);
  return true;
}

/// The break that a line says; none if it is no such line.
std::optional<assembly::BondBreak> break_of(std::string_view line) {
  assembly::BondBreak found;
  Vec3& x = found.place;
  Vec3& n = found.normal;
  bool whole =
      take(line, found.step) && take(line, found.time) && take(line, found.first) && take(line, found.second);
  for (double* number : {&x[0], &x[1], &x[2], &n[0], &n[1], &n[2]}) whole = whole && take(line, *number);
  const std::string_view mode = line.substr(0, line.find(','));
  found.mode = mode == "shear" ? contact::BreakMode::shear : contact::BreakMode::tension;
  whole = whole && (mode == "shear" || mode == "tension") && mode.size() < line.size();
  if (!whole) return std::nullopt;
  line.remove_prefix(mode.size() + 1);
  return take(line, found.entry) && line.empty() ? std::optional(found) : std::nullopt;
}

}  // namespace

BreakFile::BreakFile(const std::filesystem::path& folder, std::string_view name,
                     std::optional<std::int64_t> continue_from)
    : file_name_(folder / name) {
  make_folder(folder);
  std::error_code error;
  if (continue_from && std::filesystem::exists(file_name_, error)) {
    take_over(*continue_from);
  } else {
    AtomicFile empty(file_name_);
    empty.write(header);
    empty.commit();
  }
  // NOLINTNEXTLINE(cppcoreguidelines-owning-memory): the unique_ptr is the owner
  file_.reset(std::fopen(file_name_.c_str(), "abe"));
  if (!file_) throw_cannot_write(file_name_);
}

void BreakFile::take_over(std::int64_t step) {
  const auto [text, problem] = read_text_file(file_name_);
  if (!text) throw InputError(problem);
  if (!text->starts_with(header))
    throw InputError({{file_name_.string(), 1,
                       fmt::format("no table of broken bonds, which begins with \"{}\"; move the file away",
                                   header.substr(0, header.size() - 1))}});
  std::size_t kept = header.size();
  for (int number = 2;; ++number) {
    const std::size_t end = text->find('\n', kept);  // a line is whole once its end is there
    if (end == std::string::npos) break;
    const std::string_view line = std::string_view(*text).substr(kept, end - kept);
    const auto found = break_of(line);
    if (!found)
      throw InputError(
          {{file_name_.string(), number,
            fmt::format("\"{}\" is no line of a table of broken bonds; restore the file, or move it "
                        "away to begin a new table",
                        line.substr(0, 60))}});
    if (found->step > step) break;
    all_.push_back(*found);
    kept = end + 1;
  }
  if (kept == text->size()) return;
  AtomicFile shorter(file_name_);
  shorter.write(std::string_view(*text).substr(0, kept));
  shorter.commit();
}

void BreakFile::add(std::span<const assembly::BondBreak> breaks) {
  std::string text;
  for (const assembly::BondBreak& found : breaks) text += line_of(found);
  if (text.empty()) return;
  if (std::fwrite(text.data(), 1, text.size(), file_.get()) != text.size() || std::fflush(file_.get()) != 0)
    throw_cannot_write(file_name_);
  all_.insert(all_.end(), breaks.begin(), breaks.end());
}

void BreakFile::sync() {
  if (::fsync(::fileno(file_.get())) != 0) throw_cannot_write(file_name_);
}

}  // namespace eigengrain::io
