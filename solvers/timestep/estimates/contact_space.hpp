#pragma once

#include "timestep/estimates/contact_factors.hpp"

/// Bounds by the contact-space matrix G = D^½ B M⁻¹ Bᵀ D^½, which has the nonzero eigenvalues of M⁻¹K. Its
/// blocks G_cc' = Σ_i P_ci P_c'iᵀ couple contacts that share a body.
namespace eigengrain::timestep {

/// Gershgorin's circles of blocks: λ_max <= max_c Σ_c' |G_cc'| w_c'/w_c with spectral norms, for any w > 0.
/// w = 1, then `sweeps` times w_c <- Σ_c' |G_cc'| w_c' (Collatz-Wielandt), which can only improve it. Step
/// in s; does not depend on the frame. Cost: one 3×3 norm (6×6 where contacts carry moments) for each two
/// contacts of a body; memory 12 bytes each.
double contact_space_bound(const ContactFactors& factors, int sweeps);

}  // namespace eigengrain::timestep
