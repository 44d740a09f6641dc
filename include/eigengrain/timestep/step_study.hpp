#pragma once

#include "eigengrain/assembly/state.hpp"

#include <cstdint>
#include <limits>
#include <optional>
#include <string>
#include <vector>

/// What a larger timestep costs in accuracy: the same scene for the same physical time with steps that are
/// fractions of the critical one, against a run with a far smaller step.
namespace eigengrain::timestep {

inline constexpr double not_there = std::numeric_limits<double>::quiet_NaN();

struct StepStudyOptions {
  std::vector<double> fractions{0.05, 0.1, 0.2, 0.3, 0.4, 0.5, 0.6, 0.7, 0.8, 0.9, 1.0};  ///< of `limit`
  double limit = 0;           ///< the largest stable step, s
  double time = 0;            ///< how far to run, s
  std::int64_t samples = 64;  ///< equal parts of `time` at whose ends runs are compared, at most
};

/// About how many steps of the cycle a study takes: each fraction runs twice, once for its time alone; the
/// smallest four more times, with 1, 1/2 and 1/4 of its step.
double steps_of(const StepStudyOptions& options);

/// What is left to compare where trajectories have parted; what does not exist is NaN.
struct Statistics {
  double kinetic = not_there;        ///< mean over the samples of ½ v₋·M v₊, J
  double elastic = not_there;        ///< mean over the samples, J
  double contact_force = not_there;  ///< mean of the acting contacts at the end, N
  double contacts = not_there;       ///< acting ones at the end
  double height = not_there;         ///< of the centre of mass against gravity at the end, m
};

/// One run, and how far it is from the reference; NaN where the scene has no such thing, or the run no end.
struct StepRun {
  double dt = 0;        ///< s
  double fraction = 0;  ///< dt/limit; at most what was asked for, as a whole number of steps fills a sample
  std::int64_t steps = 0;
  double seconds = 0;                   ///< of the cycle alone, without samples and ledger
  double trajectory = not_there;        ///< √(mean over samples and balls |x - x_ref|²), m
  double final_state = not_there;       ///< √(mean over balls |x - x_ref|²) at the end, m
  double energy = not_there;            ///< largest imbalance of the energy ledger at a sample, J
  double restitution = not_there;       ///< √(mean (e - e_ref)²) over the impacts that both runs have
  double mean_restitution = not_there;  ///< of these impacts
  Statistics statistics;
  std::string trouble;  ///< how the run blew up; empty: it did not
  /// Observed orders ln(error ratio)/ln(dt ratio) against the run with about half the step; none where one of
  /// the two errors is not well above that of the reference.
  std::optional<double> trajectory_order{};
  std::optional<double> energy_order{};
  std::optional<double> restitution_order{};
};

struct StepReference {
  double dt = 0;               ///< the smallest step, a quarter of that of the first run, s
  double order = not_there;    ///< observed from runs with dt, 2 dt and 4 dt
  int extrapolated_order = 0;  ///< of Richardson's extrapolation to dt = 0; 0: the order is not clean, and
                               ///< the run with dt itself is the reference
  double uncertainty = 0;      ///< of the trajectory, in its norm, m
  Statistics statistics;       ///< of the run with dt
  double mean_restitution = not_there;
};

/// How far a run departs from one that starts with all balls shifted at random by 1e-10 of the mean radius.
struct Sensitivity {
  double growth = 1;     ///< largest distance at a sample over that of the start
  Statistics departure;  ///< |difference| of the two runs
  /// The shift has become more than a hundredth of a radius: trajectories say nothing of the step any more.
  bool chaotic() const { return growth > 1e8; }
};

struct StepStudy {
  double limit = 0;  ///< s
  double time = 0;   ///< s
  std::int64_t samples = 0;
  double mean_radius = 0;    ///< m
  double energy = 0;         ///< largest kinetic + elastic energy at a sample of the reference, J
  std::int64_t impacts = 0;  ///< of the reference: contacts of two sides alone, from touching to parting
  StepReference reference;
  Sensitivity sensitivity;
  std::vector<StepRun> runs;  ///< smallest step first
};

/// Runs of the state with local fixed steps. Energies are those of the ledger, which a periodic cell that
/// deforms does not have; restitution is measured in scenes of at most 100 balls that fly freely between
/// impacts (no clumps, meshes, moving walls, loads, or local damping beside gravity).
///
/// Cost: steps_of(options), most of it for fractions below a fifth of the limit.
/// Throws InputError where masses are scaled, fractions, limit or time are of no use, or the reference itself
/// blows up.
StepStudy study_steps(const assembly::State& start, const StepStudyOptions& options);

}  // namespace eigengrain::timestep
