#pragma once

#include "eigengrain/assembly/state.hpp"

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace eigengrain::cycle {

/// A run that has gone wrong: what was seen, and on which bodies.
struct Trouble {
  std::string what;                  ///< "not a number", "overlap", "speed" or "energy", with its value
  std::vector<std::int64_t> bodies;  ///< identities, the worst first, at most five
};

/// Looks at a state now and then for the signs of a blow-up, early enough for an earlier state to be good:
///   - a position, velocity or force that is not finite;
///   - an overlap of more than half of the smaller radius (of the radius, at a wall);
///   - a ball that moves by more than a tenth of its radius in a step, where a periodic cell deforms beside
///     its flow and with what that takes neighbours past each other: it may pass others unseen;
///   - energy out of nothing: kinetic and elastic energy beyond a hundred times what there was and the
///     most that gravity has released since. Below the limit of the undamped cycle a mode stays within 22.4
///     times its amplitude at 0.999 of the limit (500 times its energy); at ordinary steps within a few
///     times. Not where energy comes in unseen: gravity along a periodic axis, a cell that deforms, applied
///     loads, radii that change, masses that are scaled, bodies and walls that are moved with a given
///     velocity.
class Watch {
 public:
  explicit Watch(const assembly::State& state);
  std::optional<Trouble> look(const assembly::State& state);

 private:
  bool closed_ = true;        ///< all that brings energy in is seen
  double available_ = 0;      ///< kinetic and elastic energy at the start, J
  double gravitational_ = 0;  ///< at the start, J
  double released_ = 0;       ///< by gravity, the most that was seen, J
};

}  // namespace eigengrain::cycle
