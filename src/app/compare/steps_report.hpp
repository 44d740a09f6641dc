#pragma once

#include "eigengrain/timestep/step_study.hpp"

#include <nlohmann/json_fwd.hpp>

#include <string>

/// The three forms of what `compare steps` found: text, JSON and a page.
namespace eigengrain::app {

struct StepsReport {
  std::string name;   ///< of the scene
  std::string limit;  ///< which limit the fractions are of
  timestep::StepStudy study;
};

void print(const StepsReport& report);
nlohmann::ordered_json to_json(const StepsReport& report);
/// One HTML file.
std::string page_of(const StepsReport& report);

}  // namespace eigengrain::app
