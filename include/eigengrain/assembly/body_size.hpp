#pragma once

#include "eigengrain/model/bodies.hpp"

#include <cmath>
#include <cstdint>

namespace eigengrain::assembly {

/// R of a ball, or of the clump that it is in, m, which turns a moment into a force and θ into u = R θ. Of a
/// node, which never turns, what only must not be zero: that of a ball of its moment of inertia.
inline double size_of(const model::Bodies& bodies, std::int32_t row) {
  const std::int32_t clump = bodies.clumps.of(row);
  if (clump != model::Clumps::none) return bodies.clumps.radius[static_cast<std::size_t>(clump)];
  const auto i = static_cast<std::size_t>(row);
  return bodies.radius[i] > 0 ? bodies.radius[i] : std::sqrt(2.5 * bodies.inertia[i] / bodies.mass[i]);
}

}  // namespace eigengrain::assembly
