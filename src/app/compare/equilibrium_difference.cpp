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

/// Sorted by the rows of their sides; several between the same two, as of clumps, by their order.
std::vector<ActingContact> sorted_contacts(const State& state) {
  std::vector<ActingContact> contacts = measures::acting_contacts(state.model);
  std::ranges::stable_sort(contacts, {}, [](const ActingContact& c) { return std::tuple(c.a, c.b); });
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
    const double squared = (bodies.position[i] - second.model.bodies.position[i]).squaredNorm();
    squares += squared;
    result.max_distance = std::max(result.max_distance, squared);
    radii += bodies.radius[i];
  }
  const auto count = static_cast<double>(bodies.position.size());
  result.mean_distance = std::sqrt(squares / count) / (radii / count);
  result.max_distance = std::sqrt(result.max_distance) / (radii / count);
}

}  // namespace

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
    const auto of = [](const ActingContact& c) { return std::tuple(c.a, c.b); };
    if (r == right.end() || (l != left.end() && of(*l) < of(*r))) {
      squares += l->force.squaredNorm();
      sum += l++->force.norm();
      ++result.only_first;
    } else if (l == left.end() || of(*r) < of(*l)) {
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
