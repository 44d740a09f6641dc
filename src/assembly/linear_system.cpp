#include "eigengrain/assembly/linear_system.hpp"

#include "dashpots.hpp"

#include <cmath>
#include <type_traits>

namespace eigengrain::assembly {
namespace {

std::vector<double> mass_diagonal(const model::Bodies& bodies, const Unknowns& unknowns) {
  std::vector<double> diagonal;
  diagonal.reserve(static_cast<std::size_t>(unknowns.size()));
  for (std::int32_t block = 0; block < unknowns.blocks(); ++block) {
    const std::int32_t body = unknowns.body(block);
    const auto row = static_cast<std::size_t>(body);
    if (unknowns.is_rotation(block) && unknowns.axes(body) != nullptr) {
      const double factor = model::mass_factor_of(bodies, static_cast<std::size_t>(row));
      const Vec3 inertia = factor * bodies.clumps.inertia[bodies.clumps.of(body)];
      diagonal.insert(diagonal.end(), inertia.begin(), inertia.end());
      continue;
    }
    diagonal.insert(diagonal.end(), Unknowns::block_size,
                    unknowns.is_rotation(block) ? model::inertial_moment(bodies, row)
                                                : model::inertial_mass(bodies, row));
  }
  return diagonal;
}

std::vector<contact::ContactDamping> contact_damping(const Model& model, Listed which) {
  std::vector<contact::ContactDamping> damping;
  if (!has_dashpots(model)) return damping;
  for_each_element(model, which, [&](const auto& law, const contact::ContactElement& element) {
    damping.push_back(dashpots_of(law, element, model.bodies.mass));
  });
  return damping;
}

}  // namespace

bool has_dashpots(const Model& model) {
  bool found = false;
  model.contacts.for_each_group([&](const auto& group) {
    if constexpr (contact::asks_rate<typename std::decay_t<decltype(group)>::LawType>)
      found = found || group.law.damping().normal > 0 || group.law.damping().shear > 0;
  });
  return found;
}

LinearSystem with_viscosity(const LinearSystem& system, double mu) {
  LinearSystem result = system;
  for (std::size_t e = 0; e < result.damping.size(); ++e) {
    result.elements[e].stiffness.normal += mu * result.damping[e].normal;
    result.elements[e].stiffness.shear += mu * result.damping[e].shear;
  }
  for (std::size_t k = 0; k < result.nodal.viscous.size(); ++k)
    result.nodal.k.values[k] += mu * result.nodal.viscous[k];
  for (std::size_t i = 0; i < result.nodal.viscous_bound.size(); ++i)
    result.nodal.bound[i] += mu * result.nodal.viscous_bound[i];
  return result;
}

std::vector<contact::ContactElement> viscous_elements(const LinearSystem& system) {
  std::vector<contact::ContactElement> elements = system.elements;
  for (std::size_t e = 0; e < elements.size(); ++e)
    elements[e].stiffness =
        system.damping.empty()
            ? contact::ContactStiffness{}
            : contact::ContactStiffness{.normal = system.damping[e].normal, .shear = system.damping[e].shear};
  return elements;
}

LinearSystem viscous_part(const LinearSystem& system) {
  LinearSystem result = system;
  result.elements = viscous_elements(system);
  if (!result.nodal.empty()) {
    result.nodal.k.values = system.nodal.viscous;
    result.nodal.k.values.resize(system.nodal.k.values.size(), 0.0);
    result.nodal.bound = system.nodal.viscous_bound;
    result.nodal.bound.resize(system.nodal.bound.size(), Mat6::Zero());
  }
  return result;
}

LinearSystem::LinearSystem(const Model& model, Listed which)
    : elements(contact_elements(model, which)),
      damping(contact_damping(model, which)),
      unknowns(model.bodies, elements, touched_by_nodal(model, which)),
      nodal(nodal_stiffness(model, which, unknowns)),
      mass(mass_diagonal(model.bodies, unknowns)) {}

std::vector<double> LinearSystem::inverse_sqrt_mass() const {
  std::vector<double> scale(mass.size(), 0.0);
  for (const std::int32_t number : unknowns.free_components()) scale[number] = 1.0 / std::sqrt(mass[number]);
  return scale;
}

std::vector<Vec6> LinearSystem::inverse_sqrt_mass_of_bodies() const {
  const std::vector<double> scale = inverse_sqrt_mass();
  std::vector<Vec6> result(static_cast<std::size_t>(unknowns.bodies()), Vec6::Zero());
  for (std::int32_t block = 0; block < unknowns.blocks(); ++block)
    result[unknowns.body(block)].segment<3>(unknowns.is_rotation(block) ? 3 : 0) =
        Eigen::Map<const Vec3>(&scale[std::size_t{3} * block]);
  return result;
}

}  // namespace eigengrain::assembly
