#pragma once

#include "eigengrain/assembly/linear_system.hpp"
#include "eigengrain/timestep/comparison.hpp"

#include "../verbs.hpp"

#include <cstdint>
#include <string>
#include <vector>

/// What `compare timesteps` finds out of one scene.
namespace eigengrain::app {

/// The step that a policy of `run` would take in this scene.
struct PolicyStep {
  std::string name;
  double dt = 0;  ///< s
  bool safe = false;
};

struct ComparedScene {
  std::string name;  ///< of the file, and where that is not enough of its folder
  std::string file;
  std::string skipped{};  ///< why there is nothing to compare; empty: there is
  timestep::Comparison comparison{};
  double product_seconds = 0;  ///< of one product with M^-½ K M^-½
  std::vector<PolicyStep> policies{};
};

/// What an estimate costs, in products with K that take the same time.
inline double equivalent_products(const ComparedScene& scene, const timestep::Estimate& estimate) {
  return estimate.seconds / scene.product_seconds;
}

/// Scenes and states that the arguments name, a folder for all its *.yaml in their order. Throws InputError
/// for what is not there, with every mistake.
std::vector<std::string> files_of(const std::vector<std::string>& arguments);

/// All comparisons, in order, with a line for each on the error stream as it is done. Throws InputError with
/// the mistakes of all scenes before the first is computed. A scene whose solver fails is skipped with the
/// solver's words.
std::vector<ComparedScene> compare_scenes(const Options& options);

/// Asks short estimates again for their time: the least of some calls, as for a product.
void measure_again(const timestep::Question& question, timestep::Comparison& comparison);

/// Seconds of one product with M^-½ K M^-½: the least of some.
double seconds_of_product(const assembly::LinearSystem& system);

}  // namespace eigengrain::app
