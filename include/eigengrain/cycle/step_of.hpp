#pragma once

#include <cmath>
#include <limits>

namespace eigengrain::cycle {

/// 2/√λ, s: infinite where nothing resists, and 0, which proves nothing, of what is not a number (an overflow
/// in the scene).
inline double step_of(double lambda) {
  if (std::isnan(lambda)) return 0.0;
  return lambda > 0 ? 2.0 / std::sqrt(lambda) : std::numeric_limits<double>::infinity();
}

/// The larger of both; not a number if b is not one.
inline double larger(double a, double b) {
  return std::isnan(b) || b > a ? b : a;
}

}  // namespace eigengrain::cycle
