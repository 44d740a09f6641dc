#pragma once

#include "eigengrain/base/vec.hpp"

#include <cmath>
#include <cstdint>

namespace eigengrain::cycle {

/// Local damping of one component (PFC3D eq. 1.47): f less α|f| sign(v).
inline double damped(double f, double v, double damping) {
  if (v > 0) return f - damping * std::abs(f);
  if (v < 0) return f + damping * std::abs(f);
  return f;
}

/// Changes the free components of a velocity by the damped force of its body.
inline void kick(Vec3& velocity, const Vec3& force, double inertia, double duration, double damping,
                 std::uint8_t fixed) {
  for (int k = 0; k < 3; ++k) {
    if (((fixed >> k) & 1) != 0) continue;
    velocity[k] += duration * damped(force[k], velocity[k], damping) / inertia;
  }
}

}  // namespace eigengrain::cycle
