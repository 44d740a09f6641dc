#pragma once

#include "eigengrain/base/vec.hpp"
#include "eigengrain/model/surface.hpp"

#include <cstdint>
#include <span>
#include <vector>

namespace eigengrain::search {

/// A tree of boxes around the triangles of one surface. Building costs O(n log n), a query O(log n + found)
/// for triangles that do not overlap much.
class FacetTree {
 public:
  /// facets  of one surface; not empty. `first` is the index of the first of them.
  FacetTree(std::span<const model::Facet> facets, std::int32_t first);

  /// Appends the indices of all facets whose boxes are no more than `reach` from x, in no order of meaning.
  /// All facets that near are among them.
  void near(const Vec3& x, double reach, std::vector<std::int32_t>& found) const;

 private:
  struct Box {
    Vec3 low;
    Vec3 high;
  };
  /// A leaf holds facets [begin, end) of order_; others have their second child at `second`, and their first
  /// right behind themselves.
  struct Node {
    Box box;
    std::int32_t begin = 0;
    std::int32_t end = 0;
    std::int32_t second = -1;
  };

  void build(std::span<const model::Facet> facets, std::int32_t begin, std::int32_t end);

  std::int32_t first_;
  std::vector<std::int32_t> order_;
  std::vector<Node> nodes_;
};

}  // namespace eigengrain::search
