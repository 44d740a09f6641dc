#pragma once

#include "eigengrain/assembly/state.hpp"
#include "eigengrain/timestep/step_study.hpp"

#include <cstdint>
#include <string>
#include <vector>

/// One run of a step study, recorded.
namespace eigengrain::timestep {

struct CoursePlan {
  double dt = 0;  ///< s
  std::int64_t steps_per_sample = 0;
  std::int64_t samples = 0;

  std::int64_t steps() const { return steps_per_sample * samples; }
};

/// Where all balls were at the samples, and all else that runs are compared by.
struct Course {
  std::vector<std::vector<Vec3>> places;  ///< [samples][balls, by identity] centres, m
  double imbalance = not_there;           ///< largest size of the ledger's balance error, J
  double energy = 0;                      ///< largest kinetic + elastic energy, J
  Statistics statistics;
  std::vector<double> restitution;  ///< of the impacts, in their order
  std::string trouble;              ///< how it blew up; `places` then ends before
};

/// Runs a copy of the state. with_ledger: whether to keep the energy ledger; with_impacts: whether to look
/// for impacts after every step.
Course record(const assembly::State& start, const CoursePlan& plan, bool with_ledger, bool with_impacts);

/// Seconds that the cycle takes for the same run without looking at it.
double seconds_of(const assembly::State& start, const CoursePlan& plan);

/// Square root of the mean of |x - y|² over samples from `first` on, and balls, m. In a periodic cell the
/// difference is that of the nearest images.
double distance(const Course& x, const Course& y, const model::PeriodicCell& cell, std::size_t first = 0);

/// Richardson: fine + (fine - coarse)/(2^order - 1), the coarse run with twice the step.
Course extrapolated(const Course& fine, const Course& coarse, int order, const model::PeriodicCell& cell);

}  // namespace eigengrain::timestep
