#pragma once

#include "eigengrain/assembly/state.hpp"
#include "eigengrain/relaxation/relax.hpp"

#include <vector>

/// What no equilibrium can be found with.
namespace eigengrain::relaxation {

/// Throws InputError where a number of the state is none, with the body that it is of.
void require_numbers(const assembly::State& state);

/// Groups of bodies that touch each other and that their loads move: nothing that is held touches any of
/// them. The largest first. A body that is fixed in the direction of the load holds its group.
std::vector<Floating> floating_groups(const assembly::State& state);

/// Throws SolverError where loads move a scene that nothing ever holds: it has no walls, and no body is fixed
/// in the direction of their sum.
void require_support(const assembly::State& state);

}  // namespace eigengrain::relaxation
