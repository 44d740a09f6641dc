#include "eigengrain/io/series.hpp"

#include "eigengrain/base/assert.hpp"
#include "eigengrain/base/error.hpp"

#include "atomic_file.hpp"
#include "series_frame.hpp"
#include "text_file.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <system_error>
#include <utility>

namespace eigengrain::io {
namespace {

constexpr std::string_view list_head =
    "<?xml version=\"1.0\"?>\n"
    "<VTKFile type=\"Collection\" version=\"1.0\" byte_order=\"LittleEndian\">\n"
    "<Collection>\n";
constexpr std::string_view list_tail = "</Collection>\n</VTKFile>\n";

/// The text as the value of an XML attribute.
std::string in_attribute(std::string_view text) {
  std::string result;
  for (const char c : text) {
    switch (c) {
      case '&':
        result += "&amp;";
        break;
      case '<':
        result += "&lt;";
        break;
      case '"':
        result += "&quot;";
        break;
      default:
        result += c;
    }
  }
  return result;
}

/// Reads the number that the text begins with and removes it; 0 if there is none.
template <class T>
T take_number(std::string_view& text) {
  T number = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number);
  if (error == std::errc()) text.remove_prefix(static_cast<std::size_t>(end - text.data()));
  return number;
}

void take(std::string_view& text, std::string_view expected) {
  if (text.starts_with(expected)) text.remove_prefix(expected.size());
}

}  // namespace

Series::Series(std::filesystem::path folder, std::string stem, Of what, bool stress)
    : folder_(std::move(folder)), stem_(std::move(stem)), what_(what), stress_(stress) {}

std::vector<std::int64_t> Series::steps() const {
  std::vector<std::int64_t> steps;
  for (const Frame& frame : frames_) steps.push_back(frame.step);
  return steps;
}

std::string Series::frame_name(std::int64_t step) const {
  return fmt::format("{0}_series/{0}_{1:010}.vtu", stem_, step);
}

std::string Series::list_line(const Frame& frame) const {
  return fmt::format("<DataSet timestep=\"{}\" part=\"0\" file=\"{}\"/>\n", frame.time,
                     in_attribute(frame_name(frame.step)));
}

std::string Series::list_text() const {
  std::string text(list_head);
  for (const Frame& frame : frames_) text += list_line(frame);
  return text + std::string(list_tail);
}

void Series::add(const assembly::State& state, std::span<const assembly::BondBreak> breaks) {
  const bool there = std::any_of(frames_.begin(), frames_.end(),
                                 [&](const Frame& frame) { return frame.step == state.step; });
  if (there) return;
  EIGENGRAIN_ASSERT(frames_.empty() || frames_.back().step < state.step, state.step);
  const std::filesystem::path file = frame_file(state.step);
  make_folder(file.parent_path());
  switch (what_) {
    case Of::balls:
      write_frame(file, state, stress_);
      break;
    case Of::surfaces:
      write_surface_frame(file, state.model);
      break;
    case Of::solids:
      write_solid_frame(file, state);
      break;
    case Of::breaks:
      write_break_frame(file, breaks);
  }
  frames_.push_back({state.step, state.time});
  write_list();
}

void Series::write_list() const {
  AtomicFile list(list_file());
  list.write(list_text());
  list.commit();
}

void Series::continue_from(std::int64_t step) {
  std::error_code error;
  if (!std::filesystem::exists(list_file(), error)) return;  // the run before wrote no frame
  const auto [text, problem] = read_text_file(list_file());
  if (!text) throw InputError(problem);
  std::vector<Frame> frames = read_list(*text);
  const auto after =
      std::find_if(frames.begin(), frames.end(), [&](const Frame& f) { return f.step > step; });
  frames.erase(after, frames.end());
  for (const Frame& frame : frames)
    if (!std::filesystem::exists(frame_file(frame.step), error))
      throw InputError(
          {{list_file().string(), 0,
            fmt::format("names the frame of step {}, and there is no \"{}\"; put the file back, or "
                        "move {}.pvd and {}_series away to begin a new series",
                        frame.step, frame_file(frame.step).string(), stem_, stem_)}});
  frames_ = std::move(frames);
  // At once, so that the list never names frames that the run that goes on would make differently.
  write_list();
}

/// Each line is read and then written again: whatever is not the same to the letter was not written here.
std::vector<Series::Frame> Series::read_list(std::string_view text) const {
  int line = 1;
  const auto refuse = [&](std::string_view what) {
    throw InputError(
        {{list_file().string(), line,
          fmt::format("{}, so this is not the list of frames of an earlier run; move it and {}_series "
                      "away to begin a new series, or restore it",
                      what, stem_)}});
  };
  const auto shown = [](std::string_view all) {
    return fmt::format("\"{}\"", all.substr(0, std::min<std::size_t>(all.find('\n'), 120)));
  };
  std::string_view rest = text;
  if (!rest.starts_with(list_head)) refuse(fmt::format("begins with {}", shown(rest)));
  rest.remove_prefix(list_head.size());
  line += static_cast<int>(std::count(list_head.begin(), list_head.end(), '\n'));

  std::vector<Frame> frames;
  const std::string before_step = in_attribute(fmt::format("{0}_series/{0}_", stem_));
  for (; rest != list_tail; ++line) {
    Frame frame;
    std::string_view fields = rest;
    take(fields, "<DataSet timestep=\"");
    frame.time = take_number<double>(fields);
    take(fields, "\" part=\"0\" file=\"");
    take(fields, before_step);
    frame.step = take_number<std::int64_t>(fields);
    const std::string expected = list_line(frame);
    if (!rest.starts_with(expected))
      refuse(rest.empty() ? std::string("ends in the middle")
                          : fmt::format("{} is no frame of \"{}\"", shown(rest), stem_));
    if (!frames.empty() && frame.step <= frames.back().step)
      refuse(fmt::format("step {} stands behind step {}", frame.step, frames.back().step));
    rest.remove_prefix(expected.size());
    frames.push_back(frame);
  }
  return frames;
}

}  // namespace eigengrain::io
