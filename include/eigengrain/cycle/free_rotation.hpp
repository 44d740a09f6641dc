#pragma once

#include "eigengrain/base/vec.hpp"

namespace eigengrain::cycle {

/// How a body turned in a step.
struct FreeRotation {
  Quat orientation;  ///< at its end, from the principal axes to space, unit
  Quat turn;         ///< from the old orientation to the new one, in space: its vector part keeps its digits
  Vec3 theta;        ///< the same as a rotation vector, rad
};

/// Rotation of a free rigid body for a time dt, with a constant angular momentum L (in space).
///
/// The energy Σ π_k²/2I_k, π = Qᵀ L, is split as
///
///   |π|²/2I_b + ½(1/I_c - 1/I_b) π_c²  +  ½(1/I_a - 1/I_b) π_a²
///
/// into a symmetric top, which turns exactly (about L in space, and about c in the body; both commute), and a
/// rotation about a, half of it before and half of it after. a and b are the axes whose 1/I are nearest to
/// each other, so a symmetric top is exact and the error is that of the difference of 1/I_a and 1/I_b. It is
/// symplectic, symmetric in time and of second order; L does not change at all, and the energy is bounded
/// (Touma and Wisdom, Astron. J. 107:1189, 1994; Dullweber, Leimkuhler and McLachlan, J. Chem. Phys.
/// 107:5840, 1997, split into three axes instead; compared in Fassò, J. Comput. Phys. 189:527, 2003).
///
/// inertia  principal moments, kg m²
FreeRotation rotate_freely(const Quat& orientation, const Vec3& angular_momentum, const Vec3& inertia,
                           double dt);

/// The rotation vector of a unit quaternion, of length at most π, rad.
Vec3 rotation_vector(const Quat& turn);

}  // namespace eigengrain::cycle
