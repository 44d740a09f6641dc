#include "eigengrain/io/history.hpp"

#include "eigengrain/base/assert.hpp"
#include "eigengrain/base/error.hpp"

#include "atomic_file.hpp"
#include "text_file.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <iterator>
#include <system_error>
#include <utility>

namespace eigengrain::io {
namespace {

namespace fs = std::filesystem;

constexpr std::array<char, 3> axes{'x', 'y', 'z'};

/// A field as CSV wants it (RFC 4180): in quotes where it holds what separates fields or lines.
std::string csv_field(const std::string& text) {
  if (text.find_first_of(",\"\r\n") == std::string::npos) return text;
  std::string quoted = "\"";
  for (const char c : text) {
    if (c == '"') quoted += '"';
    quoted += c;
  }
  return quoted + '"';
}

void add_vector(std::vector<std::string>& names, const std::string& prefix, std::string_view unit) {
  for (const char axis : axes) names.push_back(fmt::format("{}{} [{}]", prefix, axis, unit));
}

/// Components of a symmetric tensor in the order of its columns.
struct Component {
  const char* name;
  int row;
  int column;
};
constexpr std::array<Component, 6> components{
    {{"xx", 0, 0}, {"yy", 1, 1}, {"zz", 2, 2}, {"xy", 0, 1}, {"xz", 0, 2}, {"yz", 1, 2}}};

void add_tensor(std::vector<std::string>& names, const std::string& prefix, std::string_view unit) {
  for (const Component& c : components)
    names.push_back(fmt::format("{} {}{}", prefix, c.name, unit.empty() ? "" : fmt::format(" [{}]", unit)));
}

void add_region(std::vector<std::string>& names, const std::string& region) {
  for (const char* what : {"porosity", "coordination", "coordination without rattlers", "sliding"})
    names.push_back(fmt::format("{} {}", region, what));
  add_tensor(names, region + " stress", "Pa");
  add_tensor(names, region + " strain rate", "1/s");
  add_tensor(names, region + " fabric", "");
}

/// "gravity_work" -> "gravity work [J]"; what `energies` has too, of another moment, is told apart.
void add_ledger(std::vector<std::string>& names) {
  for (const auto& [name, value] : measures::entries_of({})) {
    const bool has_double = name == "kinetic" || name == "gravitational";
    std::string text = (has_double ? "ledger " : "") + name + " [J]";
    std::replace(text.begin(), text.end(), '_', ' ');
    names.push_back(std::move(text));
  }
}

std::vector<std::string> column_names(const model::History& history, std::span<const std::string> walls) {
  std::vector<std::string> names{"step", "time [s]"};
  if (history.energies)
    for (const char* name : {"kinetic [J]", "elastic [J]", "gravitational [J]"}) names.emplace_back(name);
  if (history.unbalanced)
    for (const char* name : {"unbalanced mean", "unbalanced max"}) names.emplace_back(name);
  if (history.walls)
    for (const std::string& wall : walls) add_vector(names, wall + " force ", "N");
  if (history.wall_moments)
    for (const std::string& wall : walls) add_vector(names, wall + " moment ", "N m");
  if (history.wall_positions)
    for (const std::string& wall : walls) add_vector(names, wall + " centre ", "m");
  if (history.ledger) add_ledger(names);
  for (const model::Region& region : history.measures) add_region(names, region.name);
  for (const std::int64_t ball : history.balls) {
    const std::string prefix = fmt::format("ball {} ", ball);
    add_vector(names, prefix, "m");
    add_vector(names, prefix + "v", "m/s");
    add_vector(names, prefix + "w", "rad/s");
  }
  return names;
}

/// Enough digits for the very number.
void put(std::string& line, double value) {
  fmt::format_to(std::back_inserter(line), ",{:.17g}", value);
}

void put(std::string& line, const Vec3& value) {
  for (int k = 0; k < 3; ++k) put(line, value[k]);
}

/// The symmetric part.
void put(std::string& line, const Mat3& value) {
  for (const Component& c : components) put(line, 0.5 * (value(c.row, c.column) + value(c.column, c.row)));
}

void put(std::string& line, const measures::Ledger& ledger) {
  for (const measures::LedgerEntry& entry : measures::entries_of(ledger)) put(line, entry.value);
}

void put(std::string& line, const measures::Measure& m) {
  for (const double value : {m.porosity, m.fabric.coordination, m.fabric.without_rattlers, m.fabric.sliding})
    put(line, value);
  put(line, m.stress);
  put(line, m.strain_rate().value_or(Mat3::Constant(measures::nothing)));
  put(line, m.fabric.tensor);
}

/// The step that a line begins with.
std::optional<std::int64_t> step_of(std::string_view line) {
  std::int64_t step = 0;
  const auto [end, error] = std::from_chars(line.data(), line.data() + line.size(), step);
  const bool whole = error == std::errc() && end != line.data() + line.size() && *end == ',';
  return whole ? std::optional(step) : std::nullopt;
}

std::size_t count_columns(std::string_view line) {
  return static_cast<std::size_t>(std::count(line.begin(), line.end(), ',')) + 1;
}

/// What of a table stays at a restart.
struct Kept {
  std::size_t bytes = 0;
  std::optional<std::int64_t> last_step;
};

/// The lines behind the header up to that of `step`. A line is whole once its end is there.
Kept kept_lines(std::string_view text, std::size_t header_size, std::size_t columns, std::int64_t step,
                const std::string& file) {
  Kept kept{.bytes = header_size, .last_step = {}};
  for (int number = 2;; ++number) {
    const std::size_t end = text.find('\n', kept.bytes);
    if (end == std::string_view::npos) return kept;
    const std::string_view line = text.substr(kept.bytes, end - kept.bytes);
    const auto line_step = step_of(line);
    const bool in_order = line_step && (!kept.last_step || *line_step > *kept.last_step);
    if (!in_order || count_columns(line) != columns)
      throw InputError(
          {{file, number,
            fmt::format("\"{}\" is no line of this table: a step above that of the line before and {} values "
                        "are wanted; restore the file, or move it away to begin a new table",
                        line.substr(0, 60), columns - 1)}});
    if (*line_step > step) return kept;
    kept = {end + 1, line_step};
  }
}

}  // namespace

HistoryFile::HistoryFile(const fs::path& folder, const model::History& history,
                         std::span<const std::string> walls, std::optional<std::int64_t> continue_from)
    : history_(history),
      file_name_(folder / history.file),
      header_(header(walls)),
      columns_(column_names(history, walls).size()),
      walls_(walls.size()),
      rows_(history.balls.size()) {
  make_folder(folder);
  std::error_code error;
  if (continue_from && fs::exists(file_name_, error)) {
    take_over(*continue_from);
  } else {
    AtomicFile empty(file_name_);
    empty.write(header_);
    empty.commit();
  }
  // NOLINTNEXTLINE(cppcoreguidelines-owning-memory): the unique_ptr is the owner
  file_.reset(std::fopen(file_name_.c_str(), "abe"));
  if (!file_) throw_cannot_write(file_name_);
}

std::string HistoryFile::header(std::span<const std::string> walls) const {
  std::string text;
  for (const std::string& name : column_names(history_, walls))
    text += (text.empty() ? "" : ",") + csv_field(name);
  return text + '\n';
}

void HistoryFile::take_over(std::int64_t step) {
  const auto [text, problem] = read_text_file(file_name_);
  if (!text) throw InputError(problem);
  if (!text->starts_with(header_)) {
    const std::string_view found =
        std::string_view(*text).substr(0, std::min(text->find('\n'), text->size()));
    throw InputError(
        {{file_name_.string(), 1,
          fmt::format("the columns are \"{}\", and this run would write \"{}\"; move the file away, or give "
                      "the table another name under histories",
                      found, std::string_view(header_).substr(0, header_.size() - 1))}});
  }
  const Kept kept = kept_lines(*text, header_.size(), columns_, step, file_name_.string());
  last_step_ = kept.last_step;
  if (kept.bytes == text->size()) return;
  AtomicFile shorter(file_name_);
  shorter.write(std::string_view(*text).substr(0, kept.bytes));
  shorter.commit();
}

void HistoryFile::add(const assembly::State& state, const HistoryValues& values) {
  if (!due(state.step) || (last_step_ && state.step <= *last_step_)) return;
  write(line(state, values));
  last_step_ = state.step;
}

std::string HistoryFile::line(const assembly::State& state, const HistoryValues& values) {
  std::string text = fmt::format("{}", state.step);
  put(text, state.time);
  if (history_.energies)
    for (const double energy :
         {values.energies.kinetic, values.energies.elastic, values.energies.gravitational})
      put(text, energy);
  if (history_.unbalanced)
    for (const double ratio : {values.unbalanced.mean, values.unbalanced.max}) put(text, ratio);
  const auto put_walls = [&](const std::vector<Vec3>& of_walls) {
    EIGENGRAIN_ASSERT(of_walls.size() == walls_, of_walls.size(), walls_);
    for (const Vec3& value : of_walls) put(text, value);
  };
  if (history_.walls) put_walls(values.wall_forces);
  if (history_.wall_moments) put_walls(values.wall_moments);
  if (history_.wall_positions) put_walls(values.wall_positions);
  if (history_.ledger) put(text, values.ledger);
  EIGENGRAIN_ASSERT(values.regions.size() == history_.measures.size(), values.regions.size());
  for (const measures::Measure& measure : values.regions) put(text, measure);
  const model::Bodies& bodies = state.model.bodies;
  for (std::size_t k = 0; k < rows_.size(); ++k) {
    const std::size_t row = rows_[k] = row_of(history_.balls[k], rows_[k], bodies);
    put(text, bodies.position[row]);
    put(text, bodies.velocity.empty() ? Vec3(Vec3::Zero()) : bodies.velocity[row]);
    put(text, bodies.spin.empty() ? Vec3(Vec3::Zero()) : bodies.spin[row]);
  }
  return text + '\n';
}

/// Bodies keep their row most of the time; only where they have been sorted anew are all looked through.
std::size_t HistoryFile::row_of(std::int64_t identity, std::size_t hint, const model::Bodies& bodies) const {
  if (hint < bodies.identity.size() && bodies.identity[hint] == identity) return hint;
  const auto found = std::find(bodies.identity.begin(), bodies.identity.end(), identity);
  if (found == bodies.identity.end())
    throw InputError(
        {{file_name_.string(), 0,
          fmt::format("there is no ball {}; name balls of the scene under histories", identity)}});
  return static_cast<std::size_t>(found - bodies.identity.begin());
}

void HistoryFile::write(std::string_view text) {
  if (std::fwrite(text.data(), 1, text.size(), file_.get()) != text.size() || std::fflush(file_.get()) != 0)
    throw_cannot_write(file_name_);
}

void HistoryFile::sync() {
  if (::fsync(::fileno(file_.get())) != 0) throw_cannot_write(file_name_);
}

}  // namespace eigengrain::io
