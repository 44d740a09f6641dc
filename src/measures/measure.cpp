#include "eigengrain/measures/measure.hpp"

#include "eigengrain/assembly/acting.hpp"
#include "eigengrain/assembly/clump_members.hpp"

#include <Eigen/Eigenvalues>

#include <cmath>
#include <numbers>

namespace eigengrain::measures {
namespace {

/// Below this ratio of the moments of the centres they lie in a plane, to rounding.
constexpr double flat = 1e-12;

/// Takes the mean off before moments are formed, which would lose digits far from the origin.
void centre(std::vector<Vec3>& values) {
  Vec3 mean = Vec3::Zero();
  for (const Vec3& value : values) mean += value / static_cast<double>(values.size());
  for (Vec3& value : values) value -= mean;
}

}  // namespace

Mat3 mean_stress(const Window& window, const assembly::Model& model,
                 std::span<const ActingContact> contacts) {
  Mat3 sum = Mat3::Zero();
  for (const ActingContact& contact : contacts) {
    const double part = window.line(model::centre_of(model.bodies, contact.a), contact.branch);
    if (part > 0) sum -= part * contact.force * contact.branch.transpose();
  }
  return sum / window.volume();
}

std::vector<Mat3> body_stresses(const assembly::Model& model) {
  std::vector<Mat3> stress(model.bodies.position.size(), Mat3::Zero());
  const contact::Placement placement = model.placement();
  assembly::for_each_acting(model, placement, [&](const auto& group, std::size_t c, const auto& geometry) {
    using Kinematics = typename std::decay_t<decltype(group)>::KinematicsType;
    const contact::Pair& pair = group.pairs[c];
    const Vec3 force = contact::force_now(group.law, placement, pair, geometry, group.states[c]).force;
    const auto add = [&](std::int32_t row, const Vec3& lever, double sign) {
      const Vec3 whole = lever + assembly::lever_of(model.bodies, row);
      stress[model.bodies.clumps.owner(row)] += sign * force * whole.transpose();
    };
    // To the contact point, wherever the levers end.
    const Vec3 beyond = (contact::to_contact_point - geometry.cut) * geometry.overlap * geometry.normal;
    add(pair.a, geometry.lever_a - beyond, -1);
    if constexpr (Kinematics::second_is_body) add(pair.b, geometry.lever_b + beyond, 1);
  });
  const model::Clumps& clumps = model.bodies.clumps;
  for (std::size_t i = 0; i < stress.size(); ++i)
    if (clumps.of(static_cast<std::int32_t>(i)) == model::Clumps::none)
      stress[i] /= 4 * std::numbers::pi / 3 * std::pow(model.bodies.radius[i], 3);
  for (std::int32_t c = 0; c < clumps.size(); ++c) {
    const Mat3 mean = stress[clumps.holder(c)] / clumps.volume[c];
    for (const std::int32_t ball : clumps.members(c)) stress[ball] = mean;
  }
  return stress;
}

std::optional<Mat3> velocity_gradient(const Window& window, const model::Bodies& bodies) {
  std::vector<Vec3> position;
  std::vector<Vec3> velocity;
  for (std::int32_t i = 0; i < bodies.size(); ++i) {
    if (bodies.clumps.owner(i) != i) continue;
    const std::int32_t clump = bodies.clumps.of(i);
    window.for_each_inside(model::centre_of(bodies, i), [&](const Vec3& image, const Vec3& of_cell) {
      position.push_back(image);
      if (clump != model::Clumps::none)
        velocity.emplace_back(bodies.clumps.velocity[clump] + of_cell);
      else
        velocity.emplace_back(bodies.velocity.empty() ? of_cell : Vec3(bodies.velocity[i] + of_cell));
    });
  }
  centre(position);
  centre(velocity);
  Mat3 moments = Mat3::Zero();
  Mat3 mixed = Mat3::Zero();
  for (std::size_t i = 0; i < position.size(); ++i) {
    moments += position[i] * position[i].transpose();
    mixed += velocity[i] * position[i].transpose();
  }
  const Vec3 principal = Eigen::SelfAdjointEigenSolver<Mat3>(moments, Eigen::EigenvaluesOnly).eigenvalues();
  if (!(principal[0] > flat * principal[2])) return std::nullopt;
  // L moments = mixed
  return Mat3(moments.ldlt().solve(mixed.transpose()).transpose());
}

double porosity(const Window& window, const model::Bodies& bodies) {
  // What the balls of a clump share counts once: each counts with the part that is the clump's volume over
  // the sum of theirs, which is exact where the clump is wholly inside.
  std::vector<double> part(bodies.position.size(), 1.0);
  const model::Clumps& clumps = bodies.clumps;
  for (std::int32_t c = 0; c < clumps.size(); ++c) {
    double sum = 0;
    for (const std::int32_t ball : clumps.members(c))
      sum += 4 * std::numbers::pi / 3 * std::pow(bodies.radius[ball], 3);
    for (const std::int32_t ball : clumps.members(c)) part[ball] = clumps.volume[c] / sum;
  }
  double solid = 0;
  for (std::size_t i = 0; i < bodies.position.size(); ++i)
    solid += part[i] * window.ball(bodies.position[i], bodies.radius[i]);
  return 1 - solid / window.volume();
}

Fabric fabric(const Window& window, const assembly::Model& model, std::span<const ActingContact> contacts,
              const std::vector<bool>& rattlers) {
  Fabric result;
  std::vector<std::int32_t> seen(model.bodies.position.size(), 0);  // images inside
  for (std::size_t i = 0; i < seen.size(); ++i) {
    const auto row = static_cast<std::int32_t>(i);
    if (model.bodies.clumps.owner(row) != row) continue;
    window.for_each_inside(model::centre_of(model.bodies, row), [&](const Vec3&, const Vec3&) { ++seen[i]; });
    result.bodies += seen[i];
    if (rattlers[i]) result.rattlers += seen[i];
  }
  Mat3 tensor = Mat3::Zero();
  std::int64_t ends = 0;
  std::int64_t sliding = 0;
  std::int64_t held_ends = 0;
  for (const ActingContact& contact : contacts) {
    const bool at_wall = contact.b == ActingContact::wall;
    const std::int64_t times = seen[contact.a] + (at_wall ? 0 : seen[contact.b]);
    ends += times;
    if (contact.slides) sliding += times;
    if (!rattlers[contact.a] && (at_wall || !rattlers[contact.b])) held_ends += times;
    tensor += static_cast<double>(times) * contact.normal * contact.normal.transpose();
  }
  const auto mean = [](std::int64_t sum, std::int64_t count) {
    return count > 0 ? static_cast<double>(sum) / static_cast<double>(count) : nothing;
  };
  result.coordination = mean(ends, result.bodies);
  result.without_rattlers = mean(held_ends, result.bodies - result.rattlers);
  result.sliding = mean(sliding, ends);
  if (ends > 0) result.tensor = tensor / static_cast<double>(ends);
  return result;
}

std::optional<Mat3> Measure::strain_rate() const {
  if (!velocity_gradient) return std::nullopt;
  return Mat3(0.5 * (*velocity_gradient + velocity_gradient->transpose()));
}

std::vector<Measure> measure(const assembly::Model& model, std::span<const model::Region> regions) {
  std::vector<Measure> result;
  const std::vector<ActingContact> contacts = acting_contacts(model);
  const std::vector<bool> loose = rattlers(model, contacts, least_contacts(model));
  for (const model::Region& region : regions) {
    const Window window(region, model);
    result.push_back({.volume = window.volume(),
                      .stress = mean_stress(window, model, contacts),
                      .velocity_gradient = velocity_gradient(window, model.bodies),
                      .porosity = porosity(window, model.bodies),
                      .fabric = fabric(window, model, contacts, loose)});
  }
  return result;
}

}  // namespace eigengrain::measures
