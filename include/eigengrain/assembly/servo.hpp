#pragma once

#include "eigengrain/assembly/model.hpp"

#include <vector>

namespace eigengrain::assembly {

/// The speeds of servo walls for a step of dt (s), along their directions [wall_motions]; 0 for the others,
/// m/s.
///
///   v = α (F_wanted - F) / (Σ k Δt),  |v| <= v_max
///
/// F is the force of the wall on the bodies along its direction, k the stiffness of each acting contact along
/// it: a step then changes the force by α of what is missing if the bodies stand still, as in the numerical
/// servo-mechanism of PFC (gain G = α A/(k_n N_c Δt) on the stress). Without a contact, or with one of no
/// stiffness, the wall moves with v_max. Depends on the model as it stands alone, so that a restart needs
/// nothing more. Cost O(contacts with walls).
std::vector<double> servo_speeds(const Model& model, double dt);

}  // namespace eigengrain::assembly
