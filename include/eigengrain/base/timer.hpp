#pragma once

#include <chrono>

namespace eigengrain {

/// Wall-clock seconds since construction. For reports only: no decision may depend on a clock.
class Stopwatch {
 public:
  double seconds() const { return std::chrono::duration<double>(Clock::now() - start_).count(); }

 private:
  using Clock = std::chrono::steady_clock;
  Clock::time_point start_ = Clock::now();
};

}  // namespace eigengrain
