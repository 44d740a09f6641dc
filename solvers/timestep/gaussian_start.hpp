#pragma once

#include "eigengrain/assembly/linear_system.hpp"

#include <cstdint>
#include <span>
#include <vector>

namespace eigengrain::timestep {

/// A random start vector: Gaussian numbers at free components, zeros at others [unknowns.size()].
///
/// scale  the diagonal of M^-½, zero at components that are not free
std::vector<double> gaussian_start(std::span<const double> scale, std::uint64_t seed);
inline std::vector<double> gaussian_start(const assembly::LinearSystem& system, std::uint64_t seed) {
  return gaussian_start(system.inverse_sqrt_mass(), seed);
}

}  // namespace eigengrain::timestep
