#pragma once

#include "eigengrain/assembly/forces.hpp"
#include "eigengrain/assembly/model.hpp"
#include "eigengrain/contact/element.hpp"

#include <cstdint>

namespace eigengrain::assembly {

/// A consistent tangent between the bodies that have unknowns.
struct ClumpTangent {
  std::int32_t a = 0;
  std::int32_t b = 0;
  Mat12 k;
};

/// The consistent tangent of a contact of the balls a and b (contact::no_body at a wall), brought to the
/// unknowns of the clumps that they belong to (docs/theory.md):
///
///   Tᵀ k T,  T = [1  -[r]×Q; 0  Q],   and  -Qᵀ[f]×[r]×Q  on θθ,
///
/// r from the clump's centre to the ball's, Q the clump's axes, f what acts on the ball: as the clump turns
/// the ball moves, and with it the arm of its force.
///
/// force  of the contact on b
ClumpTangent clump_tangent(const model::Bodies& bodies, const Trial& trial, std::int32_t a, std::int32_t b,
                           const Mat12& k, const Vec3& force);

}  // namespace eigengrain::assembly
