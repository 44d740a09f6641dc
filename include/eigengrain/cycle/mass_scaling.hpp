#pragma once

#include "eigengrain/assembly/state.hpp"

namespace eigengrain::cycle {

/// Renews the inertial masses of a state whose settings ask for mass scaling (PFC3D 1.7), from its listed
/// contacts: they are the true masses and tensors of inertia times a factor, such that the step wished for is
/// the safety factor s times one that is proven stable until the next list (docs/theory.md, "Mass scaling").
///
///   differential   c_i = (Δt/2s)² (1 + α) λ_max(M_i^-½ [Σ_c 2 K_c,ii] M_i^-½), M_i the true masses;
///                  1 instead of 2 for contacts with walls and fixed bodies; α the largest of any body
///   uniform        c = (Δt/(s Δt_b))², Δt_b the step that policy `bound` proves
///
/// over all listed pairs as if they acted. A body without any has the factor of the contact that it may form
/// next; one that nothing would ever resist, the largest of any body. Cost: one 6×6 eigenvalue a body.
void scale_masses(assembly::State& state);

}  // namespace eigengrain::cycle
