#include "eigengrain/io/break_file.hpp"

#include "eigengrain/base/error.hpp"

#include "atomic_file.hpp"
#include "text_file.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <charconv>
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

/// Bytes of the lines up to a step. A line is whole once its end is there.
std::size_t size_up_to(std::string_view text, std::int64_t step, const std::string& file) {
  std::size_t kept = header.size();
  for (int number = 2;; ++number) {
    const std::size_t end = text.find('\n', kept);
    if (end == std::string_view::npos) return kept;
    const std::string_view line = text.substr(kept, end - kept);
    std::int64_t line_step = 0;
    const auto [rest, error] = std::from_chars(line.data(), line.data() + line.size(), line_step);
    if (error != std::errc() ||
        std::count(line.begin(), line.end(), ',') != std::count(header.begin(), header.end(), ','))
      throw InputError(
          {{file, number,
            fmt::format("\"{}\" is no line of a table of broken bonds; restore the file, or move it "
                        "away to begin a new table",
                        line.substr(0, 60))}});
    if (line_step > step) return kept;
    kept = end + 1;
  }
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

void BreakFile::take_over(std::int64_t step) const {
  const auto [text, problem] = read_text_file(file_name_);
  if (!text) throw InputError(problem);
  if (!text->starts_with(header))
    throw InputError({{file_name_.string(), 1,
                       fmt::format("no table of broken bonds, which begins with \"{}\"; move the file away",
                                   header.substr(0, header.size() - 1))}});
  const std::size_t kept = size_up_to(*text, step, file_name_.string());
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
}

void BreakFile::sync() {
  if (::fsync(::fileno(file_.get())) != 0) throw_cannot_write(file_name_);
}

}  // namespace eigengrain::io
