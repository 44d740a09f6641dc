#pragma once

#include "eigengrain/base/timer.hpp"

#include <cstdint>
#include <string>

namespace eigengrain::app {

/// How far long work has come, on the error stream: one line that changes on a terminal, else a plain line
/// now and then.
class Progress {
 public:
  Progress();
  ~Progress();
  Progress(const Progress&) = delete;
  Progress& operator=(const Progress&) = delete;

  /// fraction  done, in [0, 1]; negative where nobody can know
  void show(double fraction, const std::string& text);
  /// Ends the changing line, before something else is printed.
  void finish();

 private:
  bool terminal_;
  bool open_ = false;  ///< a changing line stands on the terminal
  Stopwatch watch_;
  double last_ = 0;             ///< seconds at the last line
  double first_fraction_ = -1;  ///< of this call: a continued run does not begin at 0
};

/// "3.2 s", "4 min 10 s", "2 h 5 min".
std::string duration_text(double seconds);

}  // namespace eigengrain::app
