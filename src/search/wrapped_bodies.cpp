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

void require_near(double cells, double coordinate, double length, int axis) {
  if (std::abs(cells) < farthest_home) return;
  throw InputError(fmt::format(
      "a centre at {} = {:g} m lies {:g} cell lengths outside of the periodic cell (length {:g} m); "
      "wrap the centres into the cell",
      "xyz"[axis], coordinate, cells, length));
}

/// The cell of a place. The clamp is there for a centre that is not a number: it touches nothing, but must
/// not become an index.
double clamped_home(double place) {
  const double cells = std::floor(place);
  return std::max(std::min(farthest_home, cells), -farthest_home);
}

/// Every step of the way from a centre to its copy and its cell rounds a number no greater than `greatest`.
double slack_for(double greatest) {
  return 0x1p-48 * greatest;
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
    if (!cell.periodic[static_cast<std::size_t>(k)]) continue;
    repeating_.edges.col(k) = cell.edges.col(k);
    lengths_[k] = cell.edges.col(k).norm();
    EIGENGRAIN_ASSERT(lengths_[k] > 0 && std::isfinite(lengths_[k]), k, lengths_[k]);
  }
  copies_.assign(given_.begin(), given_.end());
  homes_.resize(given_.size());
  if (cell.orthogonal())
    wrap_into_box(box);
  else
    wrap_into_slanted(box);
}

void WrappedBodies::wrap_into_box(const Box& box) {
  for (int k = 0; k < 3; ++k) {
    if (!cell_.periodic[static_cast<std::size_t>(k)]) continue;
    for (const double x : {box.lower[k], box.upper[k]})
      require_near((x - cell_.origin[k]) / lengths_[k], x, lengths_[k], k);
    slack_ = std::max(slack_, slack_for(std::max(std::abs(box.lower[k]), std::abs(box.upper[k])) +
                                        std::abs(cell_.origin[k]) + lengths_[k]));
  }
  for_each_index(static_cast<std::int64_t>(given_.size()), [&](std::int64_t i) {
    const auto body = static_cast<std::size_t>(i);
    for (int k = 0; k < 3; ++k) {
      if (!cell_.periodic[static_cast<std::size_t>(k)]) continue;
      const double home = clamped_home((given_[body][k] - cell_.origin[k]) / lengths_[k]);
      homes_[body][static_cast<std::size_t>(k)] = static_cast<std::int32_t>(home);
      copies_[body][k] -= home * lengths_[k];
    }
  });
}

void WrappedBodies::wrap_into_slanted(const Box& box) {
  const Mat3 inverse = cell_.inverse();
  const Vec3 farthest = (box.lower - cell_.origin).cwiseAbs().cwiseMax((box.upper - cell_.origin).cwiseAbs());
  const Vec3 most_cells = inverse.cwiseAbs() * farthest;  // of any centre, along each edge
  for (int k = 0; k < 3; ++k) {
    if (!cell_.periodic[static_cast<std::size_t>(k)]) continue;
    stretch_[k] = lengths_[k] * inverse.row(k).norm();
    require_near(most_cells[k], box.upper[k], lengths_[k], k);
    // Of places, of the parts of shifts, and of centres.
    slack_ = std::max(slack_, slack_for(3 * lengths_[k] * (most_cells[k] + 1) + std::abs(cell_.origin[k])));
    slack_ = std::max(slack_, slack_for(farthest[k] + std::abs(cell_.origin[k])));
  }
  slack_ *= 3;  // for the three parts of a shift
  places_.resize(given_.size());
  for_each_index(static_cast<std::int64_t>(given_.size()), [&](std::int64_t i) {
    const auto body = static_cast<std::size_t>(i);
    const Vec3 cells = inverse * (given_[body] - cell_.origin);
    places_[body] = given_[body];
    for (int k = 0; k < 3; ++k) {
      if (!cell_.periodic[static_cast<std::size_t>(k)]) continue;
      const double home = clamped_home(cells[k]);
      homes_[body][static_cast<std::size_t>(k)] = static_cast<std::int32_t>(home);
      copies_[body] -= home * cell_.edges.col(k);
      places_[body][k] = cell_.origin[k] + (cells[k] - home) * lengths_[k];
    }
  });
}

}  // namespace eigengrain::search
