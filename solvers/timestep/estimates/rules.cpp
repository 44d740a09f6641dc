#include "timestep/estimates/rules.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <vector>

namespace eigengrain::timestep {
namespace {

using assembly::LinearSystem;
using contact::ContactElement;
using contact::no_body;

constexpr double infinity = std::numeric_limits<double>::infinity();

/// [bodies] masses of those that can be displaced; infinite for others.
std::vector<double> movable_masses(const LinearSystem& system) {
  std::vector<double> mass(static_cast<std::size_t>(system.unknowns.bodies()), infinity);
  for (std::int32_t block = 0; block < system.unknowns.blocks(); ++block)
    if (!system.unknowns.is_rotation(block))
      mass[system.unknowns.body(block)] = system.mass[std::size_t{3} * block];
  return mass;
}

/// [bodies] Σ of what `of` gives for each contact of the body.
template <class Of>
std::vector<double> sum_over_contacts(const LinearSystem& system, const Of& of) {
  std::vector<double> sum(static_cast<std::size_t>(system.unknowns.bodies()), 0.0);
  for (const ContactElement& element : system.elements) {
    if (element.a == element.b) continue;  // its own image: no relative displacement along n
    sum[element.a] += of(element);
    if (element.b != no_body) sum[element.b] += of(element);
  }
  return sum;
}

double stiffest(const LinearSystem& system) {
  double k = 0;
  for (const ContactElement& element : system.elements) k = std::max(k, element.stiffness.normal);
  return k;
}

double lightest(const LinearSystem& system) {
  const std::vector<double> mass = movable_masses(system);
  return mass.empty() ? infinity : *std::min_element(mass.begin(), mass.end());
}

}  // namespace

double nodal(const LinearSystem& system) {
  const std::vector<double> mass = movable_masses(system);
  const std::vector<double> k = sum_over_contacts(system, [](const auto& e) { return e.stiffness.normal; });
  double square = infinity;
  for (std::size_t i = 0; i < mass.size(); ++i)
    if (k[i] > 0) square = std::min(square, 2 * mass[i] / k[i]);
  return std::sqrt(square);
}

double mass_over_stiffness(const LinearSystem& system) {
  return std::sqrt(lightest(system) / stiffest(system));
}

double mass_over_stiffness_and_coordination(const LinearSystem& system) {
  const std::vector<double> contacts = sum_over_contacts(system, [](const auto&) { return 1.0; });
  const double most = contacts.empty() ? 0.0 : *std::max_element(contacts.begin(), contacts.end());
  return mass_over_stiffness(system) / std::sqrt(most / 2);
}

double contact_duration(const LinearSystem& system) {
  return std::numbers::pi * mass_over_stiffness(system);
}

double reduced_contact_duration(const LinearSystem& system) {
  const std::vector<double> mass = movable_masses(system);
  double square = infinity;
  for (const ContactElement& e : system.elements) {
    if (e.a == e.b) continue;
    const double inverse = 1 / mass[e.a] + (e.b == no_body ? 0.0 : 1 / mass[e.b]);
    square = std::min(square, 1 / (inverse * e.stiffness.normal));
  }
  return std::numbers::pi * std::sqrt(square);
}

double yade_global_stiffness(const Question& question) {
  const LinearSystem& system = question.system;
  std::vector<Vec3> k(static_cast<std::size_t>(system.unknowns.bodies()), Vec3::Zero());
  std::vector<Vec3> rotational = k;
  assembly::for_each_element(question.model, assembly::Listed::acting,
                             [&](const auto& /*law*/, const ContactElement& e, const contact::Pair& pair) {
                               const Vec3 squares = e.normal.cwiseAbs2();
                               const Vec3 along = (e.stiffness.normal - e.stiffness.shear) * squares +
                                                  Vec3::Constant(e.stiffness.shear);
                               const Vec3 about = e.stiffness.shear * (Vec3::Ones() - squares);
                               const auto add = [&](std::int32_t body, std::int32_t ball) {
                                 const double r =
                                     question.model.bodies.radius[static_cast<std::size_t>(ball)];
                                 k[body] += along;
                                 rotational[body] += r * r * about;
                               };
                               add(e.a, pair.a);
                               if (e.b != no_body) add(e.b, pair.b);
                             });
  double square = infinity;
  for (std::int32_t block = 0; block < system.unknowns.blocks(); ++block) {
    const std::int32_t body = system.unknowns.body(block);
    const auto mass = Eigen::Map<const Vec3>(&system.mass[std::size_t{3} * block]);
    const Vec3& sum = system.unknowns.is_rotation(block) ? rotational[body] : k[body];
    for (int c = 0; c < 3; ++c)
      if (sum[c] > 0 && !system.unknowns.is_fixed(block, c)) square = std::min(square, mass[c] / sum[c]);
  }
  return 1.41044 * std::sqrt(square);
}

}  // namespace eigengrain::timestep
