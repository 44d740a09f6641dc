#pragma once

#include "compared_scene.hpp"
#include "cost_by_size.hpp"

#include <nlohmann/json_fwd.hpp>

#include <string>
#include <vector>

/// The three forms of what `compare timesteps` found: text, JSON and a page.
namespace eigengrain::app {

struct TimestepsReport {
  std::vector<ComparedScene> scenes;
  std::vector<CostOfSize> sizes;  ///< empty: not asked for
};

/// To the terminal: of one scene every estimate, of several each estimate across them.
void print(const TimestepsReport& report);

nlohmann::ordered_json to_json(const TimestepsReport& report);

/// One HTML file.
std::string page_of(const TimestepsReport& report);

}  // namespace eigengrain::app
