#pragma once

#include "eigengrain/assembly/linear_system.hpp"
#include "eigengrain/assembly/state.hpp"

#include <cstdint>
#include <vector>

namespace eigengrain::cycle {

/// The step that is proven stable until the next list: of all listed pairs as if they acted, and of first
/// contacts, s.
double proven_step(const assembly::State& state, bool varies);

}  // namespace eigengrain::cycle
