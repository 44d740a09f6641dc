#include "eigengrain/assembly/balance.hpp"

#include "eigengrain/assembly/acting.hpp"
#include "eigengrain/assembly/body_size.hpp"
#include "eigengrain/assembly/clump_members.hpp"
#include "eigengrain/assembly/loads.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <span>

namespace eigengrain::assembly {
namespace {

/// What the acting contacts of a body add up to.
struct Touch {
  std::int32_t contacts = 0;
  double rounding = 0;  ///< variance of the force that rounded positions make, N²
};

/// Sums over the acting contacts.
struct Survey {
  std::vector<Touch> touch;  ///< [bodies]
  std::int64_t contacts = 0;
  double force = 0;  ///< sum of magnitudes, N
};

/// Variance of a coordinate's rounding along n, m²: an ulp is spread evenly over [-½, ½].
double rounding_along(const Vec3& n, const Vec3& x) {
  const auto ulp = [](double c) {
    return c == 0 ? 0.0 : std::scalbn(std::numeric_limits<double>::epsilon(), std::ilogb(c));
  };
  return n.cwiseProduct(Vec3(x.unaryExpr(ulp))).squaredNorm() / 12;
}

/// Elements of deformable bodies as far as balance goes: what an element does to a node is a contact force.
void add_elements(const Model& model, Survey& result) {
  std::array<Vec3, fem::most_nodes> x;
  std::array<Vec3, fem::most_nodes> force;
  for (const auto& solid : model.solids) {
    const auto n = static_cast<std::size_t>(solid->elements.nodes());
    const double modulus = solid->deformable.solid.lame() + 2 * solid->deformable.solid.shear();
    for (std::int32_t e = 0; e < solid->elements.size(); ++e) {
      solid->gather(e, model.bodies.position, x);
      solid->elements.forces(solid->deformable.solid, e, std::span(x).first(n), std::span(force).first(n));
      const std::span<const double> gradient = solid->elements.gradients(e, 0);
      double weight = 0;
      for (int q = 0; q < solid->elements.points(); ++q) weight += solid->elements.weight(e, q);
      for (std::size_t i = 0; i < n; ++i) {
        Touch& touch =
            result.touch[static_cast<std::size_t>(solid->rows[n * static_cast<std::size_t>(e) + i])];
        result.force += force[i].norm();
        ++touch.contacts;
        for (std::size_t j = 0; j < n; ++j) {
          const Vec3 of_i = Eigen::Map<const Vec3>(&gradient[3 * i]);
          const Vec3 of_j = Eigen::Map<const Vec3>(&gradient[3 * j]);
          touch.rounding += std::pow(weight * modulus * of_i.norm(), 2) * rounding_along(of_j, x[j]);
        }
      }
    }
    result.contacts += std::ssize(solid->rows);
  }
}

Survey survey(const Model& model) {
  Survey result{std::vector<Touch>(static_cast<std::size_t>(model.bodies.size())), 0, 0.0};
  const contact::Placement placement = model.placement();
  for_each_acting(model, placement, [&](const auto& group, std::size_t c, const auto& geometry) {
    using Group = std::decay_t<decltype(group)>;
    using Kinematics = typename Group::KinematicsType;
    const contact::Pair& pair = group.pairs[c];
    result.force += contact::spring_force(group.law, placement, pair, geometry, group.states[c]).force.norm();
    ++result.contacts;
    const double k = group.law.stiffness(contact::at_rest(geometry), group.states[c]).normal;
    double rounding = rounding_along(geometry.normal, model.bodies.position[pair.a]);
    if constexpr (Kinematics::second_is_body)
      rounding += rounding_along(geometry.normal, model.bodies.position[pair.b]);
    const auto add = [&](std::int32_t body) {
      ++result.touch[body].contacts;
      result.touch[body].rounding += k * k * rounding;
    };
    const model::Clumps& clumps = model.bodies.clumps;
    const std::int32_t first = clumps.owner(pair.a);
    add(first);
    if constexpr (Kinematics::second_is_body)
      if (const std::int32_t second = clumps.owner(pair.b); second != first) add(second);
  });
  add_elements(model, result);
  return result;
}

}  // namespace

Balance balance_of(const Model& model, const BodyForces& of_balls) {
  const model::Bodies& bodies = model.bodies;
  BodyForces gathered;
  if (!bodies.clumps.empty()) {
    gathered = of_balls;
    gather_members(bodies, {}, gathered);
  }
  const BodyForces& contacts = bodies.clumps.empty() ? of_balls : gathered;
  const Survey found = survey(model);
  Balance result{.contacts = found.contacts};
  double floor = 0;
  for (std::size_t i = 0; i < found.touch.size(); ++i) {
    const auto row = static_cast<std::int32_t>(i);
    const model::FixedComponents fixed = bodies.fixed[i];
    if (fixed.all() || bodies.clumps.owner(row) != row) continue;
    const Vec3 load = load_on(model, i);
    const Vec3 load_moment = moment_on(model, i);
    if (found.touch[i].contacts == 0) {
      if (!model::free_part(load, fixed.translation()).isZero(0) ||
          !model::free_part(load_moment, fixed.rotation()).isZero(0))
        ++result.unsupported;
      continue;
    }
    ++result.bodies;
    const double force = model::free_part(contacts.force[i] + load, fixed.translation()).norm();
    result.mean += force;
    result.max = std::max(result.max, force);
    floor += std::sqrt(found.touch[i].rounding);
    if (contacts.moment.empty()) continue;
    const double moment =
        model::free_part(contacts.moment[i] + load_moment, fixed.rotation()).norm() / size_of(bodies, row);
    result.moment_mean += moment;
    result.moment_max = std::max(result.moment_max, moment);
  }
  const auto count = static_cast<double>(result.bodies);
  if (found.contacts > 0) result.mean_contact_force = found.force / static_cast<double>(found.contacts);
  // Bonds act before they bear anything: where nothing does yet, what is unbalanced is all there is.
  if (found.contacts > 0 && found.force == 0 && result.bodies > 0)
    result.mean_contact_force = std::max(result.mean, result.moment_mean) / count;
  if (result.mean_contact_force == 0 || result.bodies == 0) {
    result.mean = result.max = result.moment_mean = result.moment_max = 0;
    return result;
  }
  result.mean /= count * result.mean_contact_force;
  result.moment_mean /= count * result.mean_contact_force;
  result.max /= result.mean_contact_force;
  result.moment_max /= result.mean_contact_force;
  result.floor = floor / (count * result.mean_contact_force);
  return result;
}

Balance balance_of(const State& state) {
  return balance_of(state.model, {state.force, state.moment});
}

}  // namespace eigengrain::assembly
