#include "eigengrain/assembly/linear_system.hpp"

#include <cmath>

namespace eigengrain::assembly {
namespace {

std::vector<double> mass_diagonal(const model::Bodies& bodies, const Unknowns& unknowns) {
  std::vector<double> diagonal;
  diagonal.reserve(static_cast<std::size_t>(unknowns.size()));
  for (std::int32_t block = 0; block < unknowns.blocks(); ++block) {
    const std::int32_t body = unknowns.body(block);
    diagonal.insert(diagonal.end(), Unknowns::block_size,
                    unknowns.is_rotation(block) ? bodies.inertia[body] : bodies.mass[body]);
  }
  return diagonal;
}

}  // namespace

LinearSystem::LinearSystem(const Model& model, Listed which)
    : elements(contact_elements(model, which)),
      unknowns(model.bodies, elements),
      mass(mass_diagonal(model.bodies, unknowns)) {}

std::vector<double> LinearSystem::inverse_sqrt_mass() const {
  std::vector<double> scale(mass.size(), 0.0);
  for (const std::int32_t number : unknowns.free_components()) scale[number] = 1.0 / std::sqrt(mass[number]);
  return scale;
}

}  // namespace eigengrain::assembly
