#pragma once

#include "eigengrain/base/parallel.hpp"

#include <benchmark/benchmark.h>
#include <time.h>

#include <algorithm>
#include <cstdint>
#include <random>
#include <vector>

/// Time and ratios on machines that do other things too.
namespace eigengrain::bench {

/// The number of threads of the library while this lives, and a clock for it.
class Threads {
 public:
  explicit Threads(std::int64_t count = 1) : before_(threads()), processor_time_(count == 1) {
    set_threads(static_cast<int>(count));
  }
  ~Threads() { set_threads(before_); }
  Threads(const Threads&) = delete;
  Threads& operator=(const Threads&) = delete;

  /// Seconds: processor time of one thread, in which the other work of the machine does not count; wall-clock
  /// time of several.
  double now() const {
    timespec t{};
    clock_gettime(processor_time_ ? CLOCK_THREAD_CPUTIME_ID : CLOCK_MONOTONIC, &t);
    return static_cast<double>(t.tv_sec) + 1e-9 * static_cast<double>(t.tv_nsec);
  }
  template <class Call>
  double seconds(const Call& call) const {
    const double start = now();
    call();
    return now() - start;
  }

 private:
  int before_;
  bool processor_time_;
};

/// The loop of a benchmark on the clock of `threads`; its family must use manual time.
template <class Call>
void time_each(benchmark::State& state, const Threads& threads, const Call& call) {
  for ([[maybe_unused]] auto _ : state) state.SetIterationTime(threads.seconds(call));
}

/// Counters of what one turn handles: seconds for each, or how many of them a second.
inline benchmark::Counter seconds_for_each(double count) {
  return {count, benchmark::Counter::kIsIterationInvariantRate | benchmark::Counter::kInvert};
}
inline benchmark::Counter each_second(double count) {
  return {count, benchmark::Counter::kIsIterationInvariantRate};
}

inline double median(std::vector<double> values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

/// Seconds a call takes, from so many calls that they last some milliseconds; one call before them brings
/// its data back into the caches that another candidate has filled.
template <class Call>
double seconds_a_call(const Threads& threads, const Call& call) {
  call();
  const double start = threads.now();
  double now = start;
  int calls = 0;
  do {
    call();
    ++calls;
    now = threads.now();
  } while (now - start < 0.005);
  return (now - start) / calls;
}

/// Medians of two candidates that were measured by turns, and of the ratios of neighbours in time.
class SideBySide {
 public:
  void add(double first, double second) {
    first_.push_back(first);
    second_.push_back(second);
    ratio_.push_back(second / first);
  }
  double first() const { return median(first_); }
  double second() const { return median(second_); }
  double second_over_first() const { return median(ratio_); }

 private:
  std::vector<double> first_;
  std::vector<double> second_;
  std::vector<double> ratio_;
};

inline std::vector<double> random_numbers(std::int64_t n) {
  std::mt19937_64 random(1);
  std::normal_distribution<double> gaussian;
  std::vector<double> result(static_cast<std::size_t>(n));
  for (double& x : result) x = gaussian(random);
  return result;
}

}  // namespace eigengrain::bench
