#pragma once

#include "eigengrain/timestep/comparison.hpp"

#include "compared_scene.hpp"

#include <string>
#include <vector>

/// Estimates seen across scenes.
namespace eigengrain::app {

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

}  // namespace eigengrain::app
