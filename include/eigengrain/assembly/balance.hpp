#pragma once

#include "eigengrain/assembly/forces.hpp"
#include "eigengrain/assembly/model.hpp"
#include "eigengrain/assembly/state.hpp"

#include <cstdint>

namespace eigengrain::assembly {

/// How far a model is from equilibrium: resultants of contacts, gravity and applied loads on the free
/// components of bodies with at least one acting contact, over the mean force of the acting contacts. A clump
/// counts as one body; its moments are over the radius of the sphere that holds it.
struct Balance {
  double mean = 0;         ///< mean resultant force / mean contact force: the unbalanced ratio
  double max = 0;          ///< largest resultant force / mean contact force
  double moment_mean = 0;  ///< the same of resultant moment / radius
  double moment_max = 0;
  /// The mean ratio that the rounding of the positions alone makes: an ulp of x is k_n ulp of force. Less
  /// than some three times this cannot be asked for.
  double floor = 0;
  std::int64_t unsupported =
      0;  ///< bodies that gravity or a load moves, that are free to follow and that nothing touches
  std::int64_t bodies = 0;        ///< bodies with acting contacts that are free to move
  std::int64_t contacts = 0;      ///< acting
  double mean_contact_force = 0;  ///< N
};

/// of_balls  the sum of contact forces on the balls of the model as it stands. Without an acting contact the
///           ratios are 0. Cost: about one sum of forces.
Balance balance_of(const Model& model, const BodyForces& of_balls);

Balance balance_of(const State& state);

}  // namespace eigengrain::assembly
