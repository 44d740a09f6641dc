#include "eigengrain/assembly/mass.hpp"

#include <cmath>

namespace eigengrain::assembly {

std::vector<double> mass_diagonal(const model::Bodies& bodies, const Unknowns& unknowns) {
  std::vector<double> diagonal;
  diagonal.reserve(static_cast<std::size_t>(unknowns.size()));
  for (std::int32_t block = 0; block < unknowns.blocks(); ++block) {
    const auto body = static_cast<std::size_t>(unknowns.body(block));
    diagonal.insert(diagonal.end(), Unknowns::block_size,
                    unknowns.is_rotation(block) ? bodies.inertia[body] : bodies.mass[body]);
  }
  return diagonal;
}

std::vector<double> inverse_sqrt_mass(const model::Bodies& bodies, const Unknowns& unknowns) {
  std::vector<double> scale = mass_diagonal(bodies, unknowns);
  for (std::int32_t block = 0; block < unknowns.blocks(); ++block)
    for (int k = 0; k < Unknowns::block_size; ++k) {
      double& s = scale[Unknowns::block_size * static_cast<std::size_t>(block) + static_cast<std::size_t>(k)];
      s = ((unknowns.mask(block) >> k) & 1) != 0 ? 0.0 : 1.0 / std::sqrt(s);
    }
  return scale;
}

}  // namespace eigengrain::assembly
