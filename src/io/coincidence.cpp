#include "coincidence.hpp"

#include <algorithm>

namespace eigengrain::io {
namespace {

constexpr double same_place = 1e-9;  ///< of the sum of the radii

/// Along this unit vector hardly any two points of a lattice have the same height, unlike along an axis.
const Vec3 generic_direction = Vec3(0.5257311, 0.7071904, 0.4728103).normalized();

struct Swept {
  double height = 0;
  std::int32_t ball = 0;
  Vec3 centre;
};

/// Centres in the cell, those a hair below the upper end moved to its lower end: what is near through the
/// cell is then near.
Vec3 folded(const Vec3& x, const model::PeriodicCell& cell, double margin) {
  Vec3 result = cell.wrapped(x);
  for (int k = 0; k < 3; ++k)
    if (cell.periodic[k] && result[k] > cell.origin[k] + cell.edges(k, k) - margin)
      result[k] -= cell.edges(k, k);
  return result;
}

std::vector<Swept> sorted_by_height(std::span<const Vec3> centres, const model::PeriodicCell& cell,
                                    double margin) {
  std::vector<Swept> swept(centres.size());
  for (std::size_t i = 0; i < centres.size(); ++i) {
    const Vec3 x = folded(centres[i], cell, margin);
    swept[i] = {generic_direction.dot(x), static_cast<std::int32_t>(i), x};
  }
  std::sort(swept.begin(), swept.end(), [](const Swept& a, const Swept& b) {
    return std::pair(a.height, a.ball) < std::pair(b.height, b.ball);
  });
  return swept;
}

}  // namespace

std::vector<std::pair<std::int32_t, std::int32_t>> coincident_balls(std::span<const Vec3> centres,
                                                                    std::span<const double> radii,
                                                                    const model::PeriodicCell& cell) {
  std::vector<std::pair<std::int32_t, std::int32_t>> pairs;
  if (centres.empty()) return pairs;
  const double window = 2 * same_place * *std::max_element(radii.begin(), radii.end());
  const std::vector<Swept> swept = sorted_by_height(centres, cell, window);
  std::vector<bool> paired(swept.size());
  for (std::size_t i = 0; i < swept.size(); ++i) {
    if (paired[i]) continue;
    const auto a = static_cast<std::size_t>(swept[i].ball);
    for (std::size_t j = i + 1; j < swept.size() && swept[j].height - swept[i].height <= window; ++j) {
      const auto b = static_cast<std::size_t>(swept[j].ball);
      if ((swept[j].centre - swept[i].centre).norm() > same_place * (radii[a] + radii[b])) continue;
      paired[j] = true;
      pairs.emplace_back(std::minmax(swept[i].ball, swept[j].ball));
    }
  }
  std::sort(pairs.begin(), pairs.end());
  return pairs;
}

}  // namespace eigengrain::io
