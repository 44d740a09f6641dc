#include "gaussian_start.hpp"

#include <random>

namespace eigengrain::timestep {

std::vector<double> gaussian_start(std::span<const double> scale, std::uint64_t seed) {
  std::vector<double> start(scale.size(), 0.0);
  std::mt19937_64 random(seed);
  std::normal_distribution<double> gaussian;
  for (std::size_t k = 0; k < scale.size(); ++k)
    if (scale[k] > 0) start[k] = gaussian(random);
  return start;
}

}  // namespace eigengrain::timestep
