#pragma once

#include "eigengrain/assembly/state.hpp"

#include <cstdint>

/// What is done to a state between two equilibria of a loading path: small steps that the contacts remember,
/// with nothing in motion before or after.
namespace eigengrain::relaxation {

/// Moves a wall without turning it; bodies stay. Throws InputError where the scene does not let the wall
/// move.
///
/// displacement  m
void displace_wall(assembly::State& state, std::int32_t wall, const Vec3& displacement);

/// Strains the periodic cell, H <- (1 + E) H, and takes all bodies along, without turning them: x <- x + E (x
/// - o).
///
/// strain  E, small; in parts where it is not
void strain_cell(assembly::State& state, const Mat3& strain);

}  // namespace eigengrain::relaxation
