#pragma once

#include "eigengrain/assembly/linear_system.hpp"
#include "eigengrain/assembly/state.hpp"

#include <cstdint>
#include <vector>

namespace eigengrain::cycle {

/// Whether stiffnesses follow the overlap, so that a step has to be asked for while nothing opens or closes.
bool stiffness_varies(const model::Scene& settings);

/// Bodies (rows; holders of clumps) that are judged by the contact that they may form next: those without
/// listed pairs, or where stiffness varies without acting contacts, as a near pair is listed with that of a
/// typical overlap.
///
/// listed  the system of all listed pairs
std::vector<std::int32_t> bodies_apart(const assembly::State& state, const assembly::LinearSystem& listed,
                                       bool varies);

/// The step that is proven stable until the next list: of all listed pairs as if they acted, and of first
/// contacts, s.
double proven_step(const assembly::State& state, bool varies);

}  // namespace eigengrain::cycle
