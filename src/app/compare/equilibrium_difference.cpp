#include "equilibrium_difference.hpp"

#include "eigengrain/base/text.hpp"
#include "eigengrain/measures/acting_contacts.hpp"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <cmath>
#include <tuple>
#include <vector>

namespace eigengrain::app {
namespace {

using assembly::State;
using measures::ActingContact;

/// What makes a contact the same in two states. Images do not: a body may have been put back into the cell in
/// one of them.
auto sides_of(const ActingContact& c) {
  return std::tuple(c.a, c.b, c.ball_a, c.ball_b);
}

std::vector<ActingContact> sorted_contacts(const State& state) {
  std::vector<ActingContact> contacts = measures::acting_contacts(state.model);
  std::ranges::stable_sort(contacts, {}, sides_of);
  return contacts;
}

Mat3 moment_of_forces(const std::vector<ActingContact>& contacts) {
  Mat3 sum = Mat3::Zero();
  for (const ActingContact& c : contacts) sum += c.force * c.branch.transpose();
  return sum;
}

void compare_places(const State& first, const State& second, EquilibriumDifference& result) {
  const model::Bodies& bodies = first.model.bodies;
  double radii = 0;
  double squares = 0;
  for (std::size_t i = 0; i < bodies.position.size(); ++i) {
    const double squared =
        shortest(first.model.cell, bodies.position[i] - second.model.bodies.position[i]).squaredNorm();
    squares += squared;
    result.max_distance = std::max(result.max_distance, squared);
    radii += bodies.radius[i];
  }
  const auto count = static_cast<double>(bodies.position.size());
  result.mean_distance = std::sqrt(squares / count) / (radii / count);
  result.max_distance = std::sqrt(result.max_distance) / (radii / count);
}

}  // namespace

Vec3 shortest(const model::PeriodicCell& cell, const Vec3& difference) {
  if (!cell.any()) return difference;
  Vec3 middle = cell.origin;
  for (int k = 0; k < 3; ++k)
    if (cell.periodic[static_cast<std::size_t>(k)]) middle += 0.5 * cell.edges.col(k);
  return cell.wrapped(middle + difference) - middle;
}

EquilibriumDifference difference_of(const State& first, const State& second) {
  EquilibriumDifference result;
  compare_places(first, second, result);
  const std::vector<ActingContact> left = sorted_contacts(first);
  const std::vector<ActingContact> right = sorted_contacts(second);
  double squares = 0;
  double sum = 0;
  std::size_t count = 0;
  auto l = left.begin();
  auto r = right.begin();
  while (l != left.end() || r != right.end()) {
    ++count;
    if (r == right.end() || (l != left.end() && sides_of(*l) < sides_of(*r))) {
      squares += l->force.squaredNorm();
      sum += l++->force.norm();
      ++result.only_first;
    } else if (l == left.end() || sides_of(*r) < sides_of(*l)) {
      squares += r++->force.squaredNorm();
      ++result.only_second;
    } else {
      squares += (l->force - r++->force).squaredNorm();
      sum += l++->force.norm();
    }
  }
  if (sum > 0)
    result.forces =
        std::sqrt(squares / static_cast<double>(count)) / (sum / static_cast<double>(left.size()));
  const Mat3 whole = moment_of_forces(left);
  if (whole.norm() > 0) result.stress = (whole - moment_of_forces(right)).norm() / whole.norm();
  return result;
}

nlohmann::ordered_json to_json(const EquilibriumDifference& difference) {
  return {{"mean_distance", difference.mean_distance},
          {"max_distance", difference.max_distance},
          {"forces", difference.forces},
          {"stress", difference.stress},
          {"only_first", difference.only_first},
          {"only_second", difference.only_second}};
}

std::string text_of(const EquilibriumDifference& difference) {
  return fmt::format(
      "bodies are {:.1e} of a radius apart (at most {:.1e}), contact forces {:.1e} of their mean, stress "
      "{:.1e}; {} "
      "and {} contacts act in one of them alone",
      difference.mean_distance, difference.max_distance, difference.forces, difference.stress,
      grouped(difference.only_first), grouped(difference.only_second));
}

}  // namespace eigengrain::app
