#pragma once

#include "eigengrain/model/bodies.hpp"

#include "timestep/estimates/contact_factors.hpp"

/// Gershgorin's circles of the whole matrix: λ_max <= max_i Σ_j |A_ij| d_j/d_i, for any positive d.
namespace eigengrain::timestep {

/// Of M⁻¹K in the unknowns (u, Rθ), R the radius of the ball (of a clump that of the sphere which holds it):
/// without R the sum of a row would have no unit. Step in s. Depends on the frame.
double gershgorin_bound(const ContactFactors& factors, const model::Bodies& bodies);

/// Of M^-½ K M^-½ (d = 1), s. Depends on the frame.
double symmetric_gershgorin_bound(const ContactFactors& factors);

}  // namespace eigengrain::timestep
