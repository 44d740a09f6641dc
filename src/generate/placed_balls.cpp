#include "placed_balls.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>

namespace eigengrain::generate {
namespace {

std::int64_t floor_divided(std::int64_t a, std::int64_t b) {
  return a / b - static_cast<std::int64_t>(a % b < 0);
}

}  // namespace

void PlacedBalls::begin_class(double largest, std::int64_t expected) {
  Class size;
  size.largest = largest;
  // No more cells than a few for each ball, however few those are in a large region.
  const double edge =
      std::max(2 * largest, std::cbrt(region_.volume() / (4.0 * static_cast<double>(expected))));
  std::int64_t count = 1;
  for (int k = 0; k < 3; ++k) {
    size.cells[k] = std::max<std::int64_t>(1, static_cast<std::int64_t>(region_.edges()[k] / edge));
    count *= size.cells[k];
  }
  size.first.assign(static_cast<std::size_t>(count), -1);
  size.entries.reserve(static_cast<std::size_t>(expected));
  classes_.push_back(std::move(size));
}

bool PlacedBalls::fits(const Vec3& centre, double radius) const {
  return std::all_of(classes_.begin(), classes_.end(),
                     [&](const Class& size) { return fits_in(size, centre, radius); });
}

void PlacedBalls::add(const Vec3& centre, double radius) {
  Class& size = classes_.back();
  std::array<std::int64_t, 3> cell{};
  for (int k = 0; k < 3; ++k)
    cell[k] = std::clamp<std::int64_t>(cell_of(size, centre[k], k), 0, size.cells[k] - 1);
  std::int32_t& first = size.first[cell[0] + size.cells[0] * (cell[1] + size.cells[1] * cell[2])];
  const auto index = static_cast<std::int32_t>(size.entries.size());
  size.entries.push_back({.centre = centre, .radius = radius, .next = first});
  first = index;
}

std::int64_t PlacedBalls::cell_of(const Class& size, double x, int axis) const {
  const double fraction = (x - region_.lower[axis]) / region_.edges()[axis];
  return static_cast<std::int64_t>(std::floor(fraction * static_cast<double>(size.cells[axis])));
}

PlacedBalls::Cells PlacedBalls::cells_near(const Class& size, double x, double range, int axis) const {
  // A little more than the range, so that rounding loses nobody.
  const double slack = 1e-9 * range;
  const Cells cells{cell_of(size, x - range - slack, axis), cell_of(size, x + range + slack, axis)};
  if (region_.periodic[axis]) return cells;
  return {std::max<std::int64_t>(cells.first, 0), std::min(cells.last, size.cells[axis] - 1)};
}

bool PlacedBalls::fits_in(const Class& size, const Vec3& centre, double radius) const {
  const double range = radius + size.largest;
  const Vec3 edges = region_.edges();
  const Cells x = cells_near(size, centre[0], range, 0);
  const Cells y = cells_near(size, centre[1], range, 1);
  const Cells z = cells_near(size, centre[2], range, 2);
  for (std::int64_t k = z.first; k <= z.last; ++k)
    for (std::int64_t j = y.first; j <= y.last; ++j)
      for (std::int64_t i = x.first; i <= x.last; ++i) {
        const std::array<std::int64_t, 3> image{floor_divided(i, size.cells[0]),
                                                floor_divided(j, size.cells[1]),
                                                floor_divided(k, size.cells[2])};
        const Vec3 shift(static_cast<double>(image[0]) * edges[0], static_cast<double>(image[1]) * edges[1],
                         static_cast<double>(image[2]) * edges[2]);
        const std::int64_t cell =
            (i - image[0] * size.cells[0]) +
            size.cells[0] * ((j - image[1] * size.cells[1]) + size.cells[1] * (k - image[2] * size.cells[2]));
        for (std::int32_t e = size.first[cell]; e >= 0; e = size.entries[e].next) {
          const Entry& other = size.entries[e];
          const double sum = radius + other.radius;
          if ((other.centre + shift - centre).squaredNorm() < sum * sum) return false;
        }
      }
  return true;
}

}  // namespace eigengrain::generate
