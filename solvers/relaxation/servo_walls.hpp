#pragma once

#include "eigengrain/assembly/state.hpp"

#include <functional>

/// Walls that are driven to a force, in an equilibrium.
namespace eigengrain::relaxation {

bool has_servo_walls(const assembly::Model& model);

/// The largest part of its wanted force that a servo wall misses; 0 without such walls.
double missing_force(const assembly::Model& model);

/// Moves the servo walls of a state in equilibrium towards their forces, and the bodies with them: Newton's
/// step of the places w of the walls along their directions, with the bodies in equilibrium,
///
///     S w = missing forces        S = C - Gᵀ K⁻¹ G        u = K⁻¹ G w
///
/// G the forces on bodies per way of a wall, by differences, C their sums for each wall. Where walls or
/// bodies would leave what is listed up to `reach` (m), they go a part of the way. The list must be of that
/// reach.
void drive_servo_walls(assembly::State& state, double reach, const std::function<bool()>& interrupted);

}  // namespace eigengrain::relaxation
