#include "eigengrain/model/surroundings.hpp"

#include <cmath>

namespace eigengrain::model {

Vec3 PeriodicCell::wrapped(const Vec3& x) const {
  Vec3 result = x;
  for (int k = 0; k < 3; ++k) {
    if (!periodic[k]) continue;
    const double upper = origin[k] + lengths[k];
    result[k] = x[k] - lengths[k] * std::floor((x[k] - origin[k]) / lengths[k]);
    // Rounding may leave the copy a hair outside of the half-open interval.
    if (result[k] >= upper) result[k] = origin[k];
    if (result[k] < origin[k]) result[k] = origin[k];
  }
  return result;
}

}  // namespace eigengrain::model
