#pragma once

#include <cmath>

namespace eigengrain::assembly {

/// The force of local damping on one component: -α|F| sign(v) (PFC3D eq. 1.47), F the resultant with gravity,
/// N or N m.
inline double local_damping_force(double force, double velocity, double alpha) {
  if (velocity > 0) return -alpha * std::abs(force);
  if (velocity < 0) return alpha * std::abs(force);
  return 0.0;
}

}  // namespace eigengrain::assembly
