#include "eigengrain/search/facet_tree.hpp"

#include <algorithm>
#include <array>
#include <numeric>

namespace eigengrain::search {
namespace {

constexpr std::int32_t leaf = 4;  // facets

Vec3 low_of(const model::Facet& f) {
  return f.corner[0].cwiseMin(f.corner[1]).cwiseMin(f.corner[2]);
}
Vec3 high_of(const model::Facet& f) {
  return f.corner[0].cwiseMax(f.corner[1]).cwiseMax(f.corner[2]);
}

}  // namespace

FacetTree::FacetTree(std::span<const model::Facet> facets, std::int32_t first)
    : first_(first), order_(facets.size()) {
  std::iota(order_.begin(), order_.end(), 0);
  nodes_.reserve(2 * facets.size() / leaf + 1);
  build(facets, 0, static_cast<std::int32_t>(facets.size()));
}

void FacetTree::build(std::span<const model::Facet> facets, std::int32_t begin, std::int32_t end) {
  const auto facet = [&](std::int32_t k) -> const model::Facet& {
    return facets[static_cast<std::size_t>(k)];
  };
  Box box{low_of(facet(order_[static_cast<std::size_t>(begin)])),
          high_of(facet(order_[static_cast<std::size_t>(begin)]))};
  for (std::int32_t k = begin; k < end; ++k) {
    const model::Facet& f = facet(order_[static_cast<std::size_t>(k)]);
    box.low = box.low.cwiseMin(low_of(f));
    box.high = box.high.cwiseMax(high_of(f));
  }
  const std::size_t node = nodes_.size();
  nodes_.push_back({box, begin, end, -1});
  if (end - begin <= leaf) return;
  int axis = 0;
  (box.high - box.low).maxCoeff(&axis);
  const std::int32_t middle = begin + (end - begin) / 2;
  const auto height = [&](std::int32_t k) { return low_of(facet(k))[axis] + high_of(facet(k))[axis]; };
  std::nth_element(order_.begin() + begin, order_.begin() + middle, order_.begin() + end,
                   [&](std::int32_t l, std::int32_t r) {
                     const double hl = height(l);
                     const double hr = height(r);
                     return hl != hr ? hl < hr : l < r;
                   });
  build(facets, begin, middle);
  nodes_[node].second = static_cast<std::int32_t>(nodes_.size());
  build(facets, middle, end);
}

void FacetTree::near(const Vec3& x, double reach, std::vector<std::int32_t>& found) const {
  // The depth is that of a balanced tree: 2^31 facets make 30 levels.
  std::array<std::int32_t, 64> waiting;
  std::size_t count = 0;
  waiting[count++] = 0;
  // Rounding must not lose a facet at the very reach.
  const double limit = reach * reach * (1 + 1e-12);
  while (count > 0) {
    const std::int32_t index = waiting[--count];
    const Node& node = nodes_[static_cast<std::size_t>(index)];
    const Vec3 apart = (node.box.low - x).cwiseMax(x - node.box.high).cwiseMax(0.0);
    if (apart.squaredNorm() > limit) continue;
    if (node.second < 0) {
      for (std::int32_t k = node.begin; k < node.end; ++k)
        found.push_back(first_ + order_[static_cast<std::size_t>(k)]);
    } else {
      waiting[count++] = node.second;
      waiting[count++] = index + 1;
    }
  }
}

}  // namespace eigengrain::search
