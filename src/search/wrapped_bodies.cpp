#include "wrapped_bodies.hpp"

#include "eigengrain/base/assert.hpp"
#include "eigengrain/base/error.hpp"
#include "eigengrain/base/parallel.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace eigengrain::search {
namespace {

/// Farther out, in cell lengths, a centre has lost a third of its digits, and differences of image indices
/// would not fit into 32 bits.
constexpr double farthest_home = 536870912.0;  // 2^29

void require_near(double coordinate, double origin, double length, int axis) {
  const double cells = (coordinate - origin) / length;
  if (std::abs(cells) < farthest_home) return;
  throw InputError(fmt::format(
      "a centre at {} = {:g} m lies {:g} cell lengths outside of the periodic cell (length {:g} m); "
      "wrap the centres into the cell",
      "xyz"[axis], coordinate, cells, length));
}

/// The clamp is there for a centre that is not a number: it touches nothing, but must not become an index.
double home_along(double x, double origin, double length) {
  const double cells = std::floor((x - origin) / length);
  return std::max(std::min(farthest_home, cells), -farthest_home);
}

}  // namespace

Box bounding_box(std::span<const Vec3> centres) {
  Box box{.lower = centres.front(), .upper = centres.front()};
  for (const Vec3& x : centres) {
    box.lower = box.lower.cwiseMin(x);
    box.upper = box.upper.cwiseMax(x);
  }
  return box;
}

WrappedBodies::WrappedBodies(std::span<const Vec3> centres, const model::PeriodicCell& cell)
    : given_(centres), cell_(cell) {
  if (centres.empty() || !cell.any()) return;
  const Box box = bounding_box(centres);
  for (int k = 0; k < 3; ++k) {
    if (!cell.periodic[k]) continue;
    const double length = cell.lengths[k];
    EIGENGRAIN_ASSERT(length > 0 && std::isfinite(length), k, length);
    require_near(box.lower[k], cell.origin[k], length, k);
    require_near(box.upper[k], cell.origin[k], length, k);
    lengths_[k] = length;
    // Every step of the way from a centre to its copy and its cell rounds a number no greater than this.
    const double greatest =
        std::max(std::abs(box.lower[k]), std::abs(box.upper[k])) + std::abs(cell.origin[k]) + length;
    slack_ = std::max(slack_, 0x1p-48 * greatest);
  }
  wrap();
}

void WrappedBodies::wrap() {
  copies_.assign(given_.begin(), given_.end());
  homes_.resize(given_.size());
  for_each_index(static_cast<std::int64_t>(given_.size()), [&](std::int64_t i) {
    const auto body = static_cast<std::size_t>(i);
    for (int k = 0; k < 3; ++k) {
      if (!cell_.periodic[k]) continue;
      const double home = home_along(given_[body][k], cell_.origin[k], lengths_[k]);
      homes_[body][k] = static_cast<std::int32_t>(home);
      copies_[body][k] -= home * lengths_[k];
    }
  });
}

}  // namespace eigengrain::search
