#pragma once

#include "compared_scene.hpp"

#include <string>
#include <vector>

/// What estimates and policies make of the length of a run.
namespace eigengrain::app {

/// Steps that a run of the same time takes, over those that it takes with 0.8 of PFC3D's estimate.
struct RunLength {
  std::string scene;
  double relative_steps = 0;
  bool safe = false;  ///< whether the step stays below the limit of the cycle
};
struct RunLengths {
  std::string name;
  bool policy = false;  ///< of `run`, as against an estimate
  std::vector<RunLength> lengths;
  double median() const;
  bool always_safe() const;
};

/// Rules are used as codes use them: 0.8 of what they say, whatever the damping. Estimates that are proven,
/// or safe but for a stated probability, are used as they can be: 0.98 of what they say, times what damping
/// leaves of the true step. Policies take their own safety. Those that are safe in every
/// scene first, and of these the shortest run first, by the median.
std::vector<RunLengths> run_lengths(const std::vector<ComparedScene>& scenes);

}  // namespace eigengrain::app
