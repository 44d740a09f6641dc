#pragma once

#include "eigengrain/timestep/comparison.hpp"

#include "compared_scene.hpp"

#include <string>
#include <vector>

/// Estimates seen across scenes.
namespace eigengrain::app {

/// What an estimate may be called in a scene.
enum class Verdict { proven, probable, safe_here, unsafe };
Verdict verdict_on(const timestep::Estimate& estimate);
const char* text_of(Verdict verdict);

/// One estimate in all scenes that have it.
struct Standing {
  std::string name;
  std::string source;
  timestep::Claim claim = timestep::Claim::none;
  int scenes = 0;
  int unsafe = 0;
  double smallest = 0;  ///< ratio to the truth
  double median = 0;
  double largest = 0;
  std::string largest_in;      ///< name of the scene
  double median_products = 0;  ///< cost, in products with K that take the same time
};

/// In the order in which estimates are first met. Scenes that were skipped do not count.
std::vector<Standing> standings_of(const std::vector<ComparedScene>& scenes);

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

double median_of(std::vector<double> values);

}  // namespace eigengrain::app
