#include "eigengrain/model/bodies.hpp"

#include <algorithm>
#include <numbers>
#include <numeric>
#include <utility>

namespace eigengrain::model {
namespace {

/// Spreads the low 21 bits of v to every third bit.
std::uint64_t spread_bits(std::uint64_t v) {
  v &= 0x1fffff;
  v = (v | v << 32U) & 0x1f00000000ffff;
  v = (v | v << 16U) & 0x1f0000ff0000ff;
  v = (v | v << 8U) & 0x100f00f00f00f00f;
  v = (v | v << 4U) & 0x10c30c30c30c30c3;
  v = (v | v << 2U) & 0x1249249249249249;
  return v;
}

template <class T>
std::vector<T> gather(const std::vector<T>& column, std::span<const std::int32_t> order) {
  std::vector<T> result;
  if (column.empty()) return result;  // a column that the scene does not need
  result.reserve(order.size());
  for (const std::int32_t row : order) result.push_back(column[row]);
  return result;
}

/// The clumps whose balls are elsewhere now. Clumps and the order of their balls stay.
Clumps with_rows_moved(const Clumps& clumps, std::span<const std::int32_t> order) {
  Clumps result = clumps;
  if (clumps.empty()) return result;
  std::vector<std::int32_t> row_now(order.size());
  result.of_row.resize(order.size());
  for (std::size_t row = 0; row < order.size(); ++row) {
    row_now[static_cast<std::size_t>(order[row])] = static_cast<std::int32_t>(row);
    result.of_row[row] = clumps.of(order[row]);
  }
  for (std::int32_t& row : result.member) row = row_now[static_cast<std::size_t>(row)];
  return result;
}

}  // namespace

double sphere_mass(double radius, double density) {
  return 4.0 / 3.0 * std::numbers::pi * radius * radius * radius * density;
}

double sphere_inertia(double radius, double mass) {
  return 0.4 * mass * radius * radius;
}

double disk_mass(double radius, double density) {
  return std::numbers::pi * radius * radius * density;
}

double disk_inertia(double radius, double mass) {
  return 0.5 * mass * radius * radius;
}

void scale_radius(Bodies& bodies, std::size_t row, double factor) {
  double& mass = bodies.mass[row];
  // Which of both it is shows in I/mR²: 2/5 or 1/2.
  const bool disk = bodies.inertia[row] > 0.45 * mass * bodies.radius[row] * bodies.radius[row];
  bodies.radius[row] *= factor;
  mass *= disk ? factor * factor : factor * factor * factor;
  bodies.inertia[row] =
      disk ? disk_inertia(bodies.radius[row], mass) : sphere_inertia(bodies.radius[row], mass);
}

Bodies reordered(const Bodies& bodies, std::span<const std::int32_t> order) {
  return {.identity = gather(bodies.identity, order),
          .position = gather(bodies.position, order),
          .radius = gather(bodies.radius, order),
          .mass = gather(bodies.mass, order),
          .inertia = gather(bodies.inertia, order),
          .material = gather(bodies.material, order),
          .fixed = gather(bodies.fixed, order),
          .velocity = gather(bodies.velocity, order),
          .spin = gather(bodies.spin, order),
          .orientation = gather(bodies.orientation, order),
          .clumps = with_rows_moved(bodies.clumps, order)};
}

void sort_along_curve(Bodies& bodies) {
  if (bodies.size() == 0) return;
  Vec3 lower = bodies.position.front();
  Vec3 upper = lower;
  for (const Vec3& x : bodies.position) {
    lower = lower.cwiseMin(x);
    upper = upper.cwiseMax(x);
  }
  // One scale for the three axes keeps the cells of the curve cubic.
  constexpr double cells = 2097151.0;  // 2^21 - 1
  const double extent = (upper - lower).maxCoeff();
  const double scale = extent > 0 ? cells / extent : 0.0;

  std::vector<std::pair<std::uint64_t, std::int32_t>> keys(bodies.position.size());
  for (std::size_t i = 0; i < keys.size(); ++i) {
    const Vec3 cell = (bodies.position[i] - lower) * scale;
    keys[i] = {spread_bits(static_cast<std::uint64_t>(cell.x())) |
                   spread_bits(static_cast<std::uint64_t>(cell.y())) << 1U |
                   spread_bits(static_cast<std::uint64_t>(cell.z())) << 2U,
               static_cast<std::int32_t>(i)};
  }
  std::sort(keys.begin(), keys.end(), [&](const auto& left, const auto& right) {
    if (left.first != right.first) return left.first < right.first;
    return bodies.identity[left.second] < bodies.identity[right.second];
  });
  std::vector<std::int32_t> order(keys.size());
  std::transform(keys.begin(), keys.end(), order.begin(), [](const auto& key) { return key.second; });
  bodies = reordered(bodies, order);
}

}  // namespace eigengrain::model
