#pragma once

#include "eigengrain/assembly/state.hpp"

#include <cstdint>
#include <map>
#include <utility>
#include <vector>

namespace eigengrain::timestep {

/// Whether impacts can be told from flights in a scene (study_steps says which scenes).
bool has_clear_impacts(const assembly::State& state);

/// Coefficients of restitution of the impacts of a run, e = speed of parting/speed of approach along the
/// normal. Speeds are those at the very moment of touching: between impacts bodies fly freely, and the
/// parabola of a flight is known exactly from the steps on it. So e has the error of the impact alone, and
/// none of where in a step it began.
class Impacts {
 public:
  /// To be called after every step.
  void look(const assembly::State& state);
  /// Of impacts that are over and in which neither side touched anything else, in the order of their ends.
  const std::vector<double>& restitution() const { return restitution_; }

 private:
  /// Identities of two balls, or of a ball and -1 - wall.
  using Sides = std::pair<std::int64_t, std::int64_t>;
  struct Impact {
    double approach_squared = 0;  ///< m²/s²
    bool alone = true;
  };

  std::map<Sides, Impact> going_on_;
  std::vector<double> restitution_;
};

}  // namespace eigengrain::timestep
