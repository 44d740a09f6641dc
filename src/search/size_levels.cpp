#include "size_levels.hpp"

#include "eigengrain/base/adjacency.hpp"
#include "eigengrain/base/parallel.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace eigengrain::search {
namespace {

/// Sizes smaller than the largest by more than 2^-40 share a class; it would be correct with any number.
constexpr std::int32_t most_classes = 40;

/// Class c holds the sizes in (largest / 2^(c+1), largest / 2^c].
std::vector<std::int32_t> size_classes(std::span<const double> radii, double reach) {
  std::vector<std::int32_t> classes(radii.size());
  const double largest = *std::max_element(radii.begin(), radii.end()) + 0.5 * reach;
  for_each_index(static_cast<std::int64_t>(radii.size()), [&](std::int64_t i) {
    const auto body = static_cast<std::size_t>(i);
    const double ratio = largest / (radii[body] + 0.5 * reach);
    // Most bodies are of the largest class in most packings, and need no logarithm.
    classes[body] = ratio < 2 ? 0 : std::min(std::ilogb(ratio), most_classes - 1);
  });
  return classes;
}

double largest_size(std::span<const std::int32_t> members, std::span<const double> radii, double reach) {
  double largest = 0;
  for (const std::int32_t body : members) largest = std::max(largest, radii[body]);
  return largest + 0.5 * reach;
}

}  // namespace

SizeLevels::SizeLevels(const WrappedBodies& bodies, std::span<const double> radii, double reach)
    : own_(size_classes(radii, reach)) {
  const Adjacency classes = group_by_row(most_classes, own_);
  std::vector<std::int32_t> level_of_class(most_classes, -1);
  for (std::int32_t c = 0; c < most_classes; ++c) {
    const std::span<const std::int32_t> members = classes.links(c);
    if (members.empty()) continue;
    level_of_class[c] = static_cast<std::int32_t>(levels_.size());
    const double largest = largest_size(members, radii, reach);
    // A hair more than the greatest distance of a pair, so that a body's box spans three cells and not four.
    const double edge = 2 * largest * (1 + 0x1p-20) + 2 * bodies.slack();
    levels_.push_back({largest, CellGrid(bodies, members, edge)});
  }
  for (std::int32_t& level : own_) level = level_of_class[level];
}

}  // namespace eigengrain::search
