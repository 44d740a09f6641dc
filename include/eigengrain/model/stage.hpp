#pragma once

#include "eigengrain/base/vec.hpp"
#include "eigengrain/model/bodies.hpp"
#include "eigengrain/model/selection.hpp"

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

/// A test told as a sequence: plain data, as the scene says it.
namespace eigengrain::model {

/// The force of the bodies on a wall, as a condition.
struct WallForceGoal {
  std::string wall{};   ///< name
  double at_least = 0;  ///< magnitude, N
};

/// When a run ends: at the first of `steps`, `time` and the moment in which all the conditions that are given
/// hold together. Steps and time count from the start of the scene, or of the stage.
struct RunChoice {
  std::optional<std::int64_t> steps{};
  std::optional<double> time{};        ///< s
  std::optional<double> unbalanced{};  ///< the mean ratio is below this, and nothing falls
  std::optional<double> kinetic{};     ///< the kinetic energy is below this, J
  std::optional<WallForceGoal> wall_force{};

  bool has_condition() const { return unbalanced || kinetic || wall_force; }
  bool any() const { return steps || time || has_condition(); }
};

struct RelaxChoice {
  double tolerance = 1e-10;          ///< mean unbalanced ratio
  std::int64_t max_steps = 1000000;  ///< explicit ones
};

/// What is done to some balls at once, between two moments. A clump changes as a whole if any of its balls is
/// meant.
struct BodyChange {
  Selection of{};
  FixedComponents fix{};            ///< in addition to those that are fixed
  FixedComponents free{};           ///< no longer fixed
  std::optional<Vec3> velocity{};   ///< m/s
  std::optional<Vec3> spin{};       ///< rad/s
  std::optional<Vec3> force{};      ///< applied from now on, N
  std::optional<Vec3> moment{};     ///< applied from now on, N m
  std::optional<double> damping{};  ///< α of their own
  std::optional<double> growth{};   ///< factor of the radius at constant density; not of clumps
  double over = 0;                  ///< the time that the radius takes for it; 0: at once, s
};

/// Contacts that act now, and the entry of `contacts` whose law they take while they go on acting.
struct ContactChoice {
  std::string take{};                 ///< the name of an entry
  Selection of{};                     ///< both balls; at a wall, the ball
  std::optional<std::string> wall{};  ///< only contacts with this wall
};

/// A stage first changes what it says, then runs or relaxes, then saves.
struct Stage {
  std::string name{};
  std::int64_t repeat = 1;              ///< how often all of it is done
  std::vector<std::string> settings{};  ///< key=value, as of the command line; they stay
  std::vector<GroupChoice> groups{};
  bool adds_balls = false;
  std::vector<BodyChange> bodies{};
  std::vector<ContactChoice> contacts{};
  RunChoice run{};
  std::optional<RelaxChoice> relax{};
  std::string save{};  ///< name of a state file in the folder of results; empty: none
};

/// How far the stages of a scene have come.
struct StageProgress {
  std::int64_t stage = 0;       ///< in hand; their number when all are done
  std::int64_t repetition = 0;  ///< of this stage, from 0
  bool begun = false;           ///< its changes have been made
  std::int64_t first_step = 0;  ///< at which its run began
  double first_time = 0;        ///< s
};

}  // namespace eigengrain::model
