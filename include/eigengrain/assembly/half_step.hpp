#pragma once

#include "eigengrain/model/bodies.hpp"

#include <cstdint>

namespace eigengrain::assembly {

/// The velocity half a step before the one given, of a body that a force accelerates: what leapfrog keeps for
/// a velocity of the moment. Fixed components stay. The same of a spin, a moment and a moment of inertia.
inline Vec3 half_a_step_before(const Vec3& velocity, const Vec3& force, double inertia, double dt,
                               std::uint8_t fixed) {
  return velocity - 0.5 * dt / inertia * model::free_part(force, fixed);
}

}  // namespace eigengrain::assembly
