#include "eigengrain/timestep/limiting_modes.hpp"

#include "eigengrain/assembly/linear_system.hpp"
#include "eigengrain/assembly/product.hpp"
#include "eigengrain/assembly/stiffness.hpp"
#include "eigengrain/base/timer.hpp"
#include "eigengrain/cycle/lift.hpp"
#include "eigengrain/petsc/session.hpp"

#include "krylov.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <set>
#include <utility>

namespace eigengrain::timestep {
namespace {

using assembly::LinearSystem;
using assembly::Unknowns;
using contact::ContactElement;
using contact::no_body;

/// u and θ (along the axes of space) of all bodies.
void spread_over_bodies(const LinearSystem& system, std::span<const double> x, LimitingMode& mode) {
  const auto bodies = static_cast<std::size_t>(system.unknowns.bodies());
  mode.displacement.assign(bodies, Vec3::Zero());
  mode.rotation.assign(bodies, Vec3::Zero());
  mode.energy.assign(bodies, 0.0);
  for (std::int32_t block = 0; block < system.unknowns.blocks(); ++block) {
    const std::int32_t body = system.unknowns.body(block);
    const std::size_t first = std::size_t{Unknowns::block_size} * static_cast<std::size_t>(block);
    const Vec3 value = Eigen::Map<const Vec3>(&x[first]);
    const double energy = value.cwiseAbs2().dot(Eigen::Map<const Vec3>(&system.mass[first]));
    mode.energy[body] += energy;
    if (system.unknowns.is_rotation(block)) {
      const Mat3* axes = system.unknowns.axes(body);
      mode.rotation[body] = axes == nullptr ? value : Vec3(*axes * value);
    } else {
      mode.displacement[body] = value;
      mode.translation += energy;
    }
  }
}

/// (δ, φ)·D (δ, φ) of a contact.
double elastic_energy(const ContactElement& e, const LimitingMode& mode) {
  Vec3 slip = -mode.displacement[e.a] - mode.rotation[e.a].cross(e.lever_a);
  Vec3 turn = -mode.rotation[e.a];
  if (e.b != no_body) {
    slip += mode.displacement[e.b] + mode.rotation[e.b].cross(e.lever_b);
    turn += mode.rotation[e.b];
  }
  const double along = slip.dot(e.normal);
  const double about = turn.dot(e.normal);
  return e.stiffness.normal * along * along + e.stiffness.shear * (slip.squaredNorm() - along * along) +
         e.stiffness.twist * about * about + e.stiffness.bending * (turn.squaredNorm() - about * about);
}

/// Indices of the largest parts, which together have 0.9 of the whole.
std::vector<std::int32_t> carriers(std::span<const double> part) {
  std::vector<std::int32_t> order(part.size());
  std::iota(order.begin(), order.end(), 0);
  std::ranges::stable_sort(order, [&](std::int32_t i, std::int32_t j) { return part[i] > part[j]; });
  const double whole = std::accumulate(part.begin(), part.end(), 0.0);
  double sum = 0;
  std::size_t count = 0;
  while (count < order.size() && sum < carried_part * whole) sum += part[order[count++]];
  order.resize(count);
  return order;
}

/// The sides of every contact, in the order of the elements.
std::vector<CarryingContact> sides_of_contacts(const assembly::Model& model) {
  std::vector<CarryingContact> result;
  assembly::for_each_element(
      model, assembly::Listed::acting,
      [&](const auto& /*law*/, const ContactElement& element, const contact::Pair& pair) {
        CarryingContact sides{.index = static_cast<std::int32_t>(result.size()),
                              .a = pair.a,
                              .b = pair.b,
                              .stiffness = element.stiffness};
        if (element.b == no_body) {
          sides.b = no_body;
          sides.wall = pair.side == 0 ? pair.b
                                      : static_cast<std::int32_t>(model.walls.size()) +
                                            model.facets.facet[static_cast<std::size_t>(pair.b)].surface;
        }
        result.push_back(sides);
      });
  return result;
}

LimitingMode describe(const LinearSystem& system, std::span<const CarryingContact> contacts,
                      std::span<const double> x) {
  LimitingMode mode;
  spread_over_bodies(system, x, mode);
  double squares = 0;
  for (const double e : mode.energy) squares += e * e;
  mode.participation = 1 / squares;
  for (const std::int32_t row : carriers(mode.energy)) mode.bodies.push_back({row, mode.energy[row]});
  std::vector<double> elastic;
  elastic.reserve(contacts.size());
  for (const ContactElement& element : system.elements) elastic.push_back(elastic_energy(element, mode));
  const double whole = std::accumulate(elastic.begin(), elastic.end(), 0.0);
  for (const std::int32_t index : carriers(elastic)) {
    mode.contacts.push_back(contacts[index]);
    mode.contacts.back().share = elastic[index] / whole;
  }
  return mode;
}

double critical_step(const LinearSystem& system, const TruthOptions& options) {
  const std::vector<double> scale = system.inverse_sqrt_mass();
  assembly::StiffnessProduct product(system.unknowns, system.parts(), scale);
  const double lambda = largest_eigenpairs(product, scale, 1, options).front().value;
  return lambda > 0 ? 2 / std::sqrt(lambda) : std::numeric_limits<double>::infinity();
}

/// The step with other masses, and with other stiffnesses, of all that carries.
void try_changes(const LinearSystem& system, const TruthOptions& options, LimitingModes& result) {
  std::set<std::int32_t> bodies;
  std::set<std::int32_t> contacts;
  for (const LimitingMode& mode : result.modes) {
    for (const CarryingBody& body : mode.bodies) bodies.insert(body.row);
    for (const CarryingContact& contact : mode.contacts) contacts.insert(contact.index);
  }
  result.carrying_bodies = static_cast<std::int32_t>(bodies.size());
  result.carrying_contacts = static_cast<std::int32_t>(contacts.size());
  std::vector<double> factor(static_cast<std::size_t>(system.unknowns.bodies()), 1.0);
  for (const std::int32_t row : bodies) factor[row] = 2;
  result.dt_heavier = critical_step(cycle::lifted(system, factor), options);
  LinearSystem softer = system;
  for (const std::int32_t index : contacts)
    softer.elements[index].stiffness = 0.5 * softer.elements[index].stiffness;
  result.dt_softer = critical_step(softer, options);
}

}  // namespace

LimitingModes limiting_modes(const assembly::Model& model, int count, const TruthOptions& options) {
  LimitingModes result;
  result.dt_heavier = result.dt_softer = std::numeric_limits<double>::infinity();
  const LinearSystem system(model);
  const std::vector<double> scale = system.inverse_sqrt_mass();
  if (scale.empty()) return result;
  petsc::start();
  const Stopwatch watch;
  const std::vector<CarryingContact> contacts = sides_of_contacts(model);
  assembly::StiffnessProduct product(system.unknowns, system.parts(), scale);
  for (const Eigenpair& pair : largest_eigenpairs(product, scale, count, options)) {
    if (!(pair.value > 0)) break;
    LimitingMode mode = describe(system, contacts, mode_of(pair.vector.get(), scale));
    mode.lambda = pair.value;
    mode.dt = 2 / std::sqrt(pair.value);
    mode.residual = pair.residual;
    result.modes.push_back(std::move(mode));
  }
  if (!result.modes.empty()) try_changes(system, options, result);
  result.seconds = watch.seconds();
  return result;
}

}  // namespace eigengrain::timestep
