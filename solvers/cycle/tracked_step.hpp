#pragma once

#include "eigengrain/assembly/state.hpp"

#include <cstdint>
#include <optional>

namespace eigengrain::cycle {

/// How often a proof is made anew while nothing asks for it, in steps.
inline constexpr std::int64_t steps_between_proofs = 500;

/// Proves a step of a state as large as the contacts allow that act now, or that can while no body leaves its
/// room (assembly::StepGuard). Where the state has a guard, what it knows is begun with: its step, and the
/// weights that proved it. None where a proof of this kind does not hold: while radii change or the cell
/// deforms, and with surfaces; then proven_step() is what does. Where nothing can touch yet its step is
/// proven_step(), too.
///
/// Stiffnesses are those at the deepest that a contact can come to within the rooms, and count for more by
/// what the angle can add by which the contact can turn within them (docs/theory.md, "Tracking").
std::optional<assembly::StepGuard> track_step(const assembly::State& state);

}  // namespace eigengrain::cycle
