#pragma once

#include "eigengrain/relaxation/relax.hpp"

#include "../verbs.hpp"
#include "equilibrium_difference.hpp"

#include <nlohmann/json_fwd.hpp>

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

/// What `compare relaxation` finds out of scenes, and its three forms: text, JSON and a page.
namespace eigengrain::app {

/// The ratio that is coarse enough for a start of something else.
inline constexpr double coarse = 1e-3;

/// How far the bodies of a run were from where it ended.
struct Distance {
  relaxation::Moment at;
  double distance = 0;  ///< root mean square, over the mean radius
};

/// One method on one scene.
struct MethodRun {
  std::string name;
  std::string failure{};  ///< of a method that could not; empty: it ran
  relaxation::RelaxResult result{};
  std::vector<Distance> distances{};
  /// From where the explicit method ended, where both found an equilibrium.
  std::optional<EquilibriumDifference> from_explicit{};

  /// The first moment from which on the ratio stays at or below this.
  std::optional<relaxation::Moment> reaches(double ratio) const;
  /// The first from which on it stays at that of the end, as it was in motion or is at rest; none where no
  /// equilibrium was found.
  std::optional<relaxation::Moment> reaches_end() const;
};

struct RelaxedScene {
  std::string name;
  std::string file;
  std::string skipped{};  ///< why there is nothing to compare; empty: there is
  std::int64_t bodies = 0;
  std::int64_t contacts = 0;  ///< that act at the start
  std::vector<MethodRun> runs{};
};

struct RelaxationReport {
  double tolerance = 0;
  std::vector<RelaxedScene> scenes;
};

/// All methods on all scenes, with a line for each on the error stream. A scene with a mistake is left out
/// where there are others, and says why; throws InputError where it is the only one.
RelaxationReport compare_relaxations(const Options& options);

void print(const RelaxationReport& report);
nlohmann::ordered_json to_json(const RelaxationReport& report);
/// One HTML file.
std::string page_of(const RelaxationReport& report);

}  // namespace eigengrain::app
