#pragma once

#include "eigengrain/base/vec.hpp"
#include "eigengrain/contact/geometry.hpp"
#include "eigengrain/contact/law.hpp"

namespace eigengrain::contact {

/// The exact derivative of what a contact does to its ends, -∂(F_a, M_a, F_b, M_b)/∂(u_a, θ_a, u_b, θ_b)
/// [12×12], at the committed state: what Newton's method needs. Unsymmetric in general.
///
/// Beyond BᵀD_tB (D_t the law's tangent) it holds what K leaves out (docs/theory.md): force and moment turn
/// with the contact frame, dF = Ω × F with Ω = n × dn + (½(θ_a + θ_b)·n) n, and the contact point moves, dR_a
/// = ½nnᵀΔ + (R_a·n) dn, dR_b = -½nnᵀΔ + (R_b·n) dn, where Δ = u_b - u_a and dn = C Δ. This holds for every
/// law whose force is frame-indifferent.
///
/// curvature  C: (1 - nnᵀ)/d between balls and at a corner, zero on a face, across the edge only on an edge,
///            1/m
/// force      of the contact now; tangent: of its law
Mat12 consistent_tangent(const ContactGeometry& geometry, const Mat3& curvature, const ContactForce& force,
                         const ContactTangent& tangent);

}  // namespace eigengrain::contact
