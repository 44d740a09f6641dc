#pragma once

#include "eigengrain/model/bodies.hpp"

#include <cstdint>

namespace eigengrain::assembly {

/// R of a ball, or of the clump that it is in, m, which turns a moment into a force and θ into u = R θ.
inline double size_of(const model::Bodies& bodies, std::int32_t row) {
  const std::int32_t clump = bodies.clumps.of(row);
  return clump == model::Clumps::none ? bodies.radius[static_cast<std::size_t>(row)]
                                      : bodies.clumps.radius[static_cast<std::size_t>(clump)];
}

}  // namespace eigengrain::assembly
