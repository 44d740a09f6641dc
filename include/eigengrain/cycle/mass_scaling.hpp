#pragma once

#include "eigengrain/assembly/state.hpp"

#include <cstdint>

namespace eigengrain::cycle {

/// Renews the inertial masses of a state whose settings ask for mass scaling (PFC3D 1.7), from its listed
/// contacts: they are the true masses and tensors of inertia times a factor, such that the step wished for is
/// the safety factor s times one that is proven stable until the next list (docs/theory.md, "Mass scaling").
///
///   differential   c_i = (Δt/2s)² (1 + α) λ_max(M_i^-½ [Σ_c 2 K_c,ii] M_i^-½), M_i the true masses;
///                  1 instead of 2 for contacts with walls and fixed bodies; α the largest of any body
///   uniform        c = (Δt/(s Δt_b))², Δt_b the step that policy `bound` proves
///   selective      c_i >= 1 with as little added mass as weights of the bodies can prove (cycle/lift.hpp)
///
/// over all listed pairs as if they acted. A body without any has the factor of the contact that it may form
/// next; one that nothing would ever resist, the largest of any body. Cost: one 6×6 eigenvalue a body.
///
/// `selective` counts dashpots; a body without pairs has the factor of its first contact where that is more
/// than one, and one where nothing would ever resist it. Cost: some ten eigenpairs a body near its limit.
void scale_masses(assembly::State& state);

/// What inertial masses differ from the true ones by, of bodies that can move.
struct ScaledMasses {
  std::int64_t bodies = 0;   ///< that can move
  std::int64_t heavier = 0;  ///< with a factor above one
  double mass = 0;           ///< true mass of all, kg
  double added = 0;          ///< kg; negative where masses are less than the true ones
  double largest = 1;        ///< factor
};
ScaledMasses scaled_masses(const model::Bodies& bodies);

}  // namespace eigengrain::cycle
