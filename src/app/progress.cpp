#include "progress.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <cmath>

namespace eigengrain::app {
namespace {

constexpr double seconds_between_changes = 0.5;
constexpr double seconds_between_lines = 10;

}  // namespace

std::string duration_text(double seconds) {
  if (seconds < 60) return fmt::format("{:.1f} s", seconds);
  const auto whole = static_cast<std::int64_t>(std::llround(seconds));
  if (whole < 3600) return fmt::format("{} min {} s", whole / 60, whole % 60);
  return fmt::format("{} h {} min", whole / 3600, whole % 3600 / 60);
}

Progress::Progress() : terminal_(isatty(STDERR_FILENO) != 0) {}

Progress::~Progress() {
  finish();
}

void Progress::show(double fraction, const std::string& text) {
  const double now = watch_.seconds();
  if (first_fraction_ < 0) first_fraction_ = fraction;
  if (now - last_ < (terminal_ ? seconds_between_changes : seconds_between_lines)) return;
  last_ = now;
  std::string line = text;
  if (fraction > first_fraction_)
    line = fmt::format("{:3.0f}%  {}, {} left", 100 * fraction, text,
                       duration_text(now * (1 - fraction) / (fraction - first_fraction_)));
  if (terminal_)
    fmt::print(stderr, "\r\033[K{}", line);
  else
    fmt::print(stderr, "{}\n", line);
  std::fflush(stderr);
  open_ = terminal_;
}

void Progress::finish() {
  if (open_) fmt::print(stderr, "\r\033[K");
  open_ = false;
}

}  // namespace eigengrain::app
