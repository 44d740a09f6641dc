#include "eigengrain/model/bodies.hpp"

#include "eigengrain/base/assert.hpp"

#include <algorithm>
#include <cmath>
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

/// Appends rows to a column that may be absent on either side; `rest` stands for what is not there.
template <class T>
void append(std::vector<T>& column, std::size_t rows, const std::vector<T>& more, std::size_t more_rows,
            const T& rest) {
  if (column.empty() && more.empty()) return;
  column.resize(rows, rest);
  column.insert(column.end(), more.begin(), more.end());
  column.resize(rows + more_rows, rest);
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

/// A disk as against a sphere: their moments are 1/2 and 2/5 m R².
bool is_disk(double radius, double mass, double inertia) {
  return inertia > 0.45 * mass * radius * radius;
}

/// Mass and moment of a ball whose radius is s times that at first.
void set_size(const RadiusRamp& first, double s, double& radius, double& mass, double& inertia) {
  const bool disk = is_disk(first.radius, first.mass, first.inertia);
  const double mass_scale = disk ? s * s : s * s * s;
  radius = s * first.radius;
  mass = mass_scale * first.mass;
  inertia = mass_scale * s * s * first.inertia;
}

}  // namespace

double RadiusRamp::scale(double time) const {
  return 1 + (factor - 1) * std::clamp((time - from) / over, 0.0, 1.0);
}

void scale_radii(Bodies& bodies, std::span<const std::int32_t> rows, double factor) {
  for (const std::int32_t row : rows) {
    const auto i = static_cast<std::size_t>(row);
    EIGENGRAIN_ASSERT(bodies.clumps.of(row) == Clumps::none && factor > 0, row, factor);
    const RadiusRamp now{.radius = bodies.radius[i], .mass = bodies.mass[i], .inertia = bodies.inertia[i]};
    set_size(now, factor, bodies.radius[i], bodies.mass[i], bodies.inertia[i]);
    if (bodies.ramp.empty()) continue;
    RadiusRamp& ramp = bodies.ramp[i];
    const RadiusRamp first = ramp;
    set_size(first, factor, ramp.radius, ramp.mass, ramp.inertia);
  }
}

double set_radii(Bodies& bodies, double time) {
  double greatest = 0;
  for (std::size_t i = 0; i < bodies.ramp.size(); ++i) {
    const RadiusRamp& ramp = bodies.ramp[i];
    if (ramp.factor == 1) continue;
    const double before = bodies.radius[i];
    set_size(ramp, ramp.scale(time), bodies.radius[i], bodies.mass[i], bodies.inertia[i]);
    greatest = std::max(greatest, std::abs(bodies.radius[i] - before));
  }
  return greatest;
}

bool radii_change(const Bodies& bodies, double begin, double end) {
  return std::any_of(bodies.ramp.begin(), bodies.ramp.end(),
                     [&](const RadiusRamp& ramp) { return ramp.scale(begin) != ramp.scale(end); });
}

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
          .applied_force = gather(bodies.applied_force, order),
          .applied_moment = gather(bodies.applied_moment, order),
          .damping = gather(bodies.damping, order),
          .ramp = gather(bodies.ramp, order),
          .mass_factor = gather(bodies.mass_factor, order),
          .clumps = with_rows_moved(bodies.clumps, order)};
}

void append_rows(Bodies& bodies, const Bodies& more) {
  const std::size_t rows = bodies.position.size();
  const std::size_t added = more.position.size();
  const auto every = [](auto& column, const auto& values) {
    column.insert(column.end(), values.begin(), values.end());
  };
  every(bodies.position, more.position);
  every(bodies.radius, more.radius);
  every(bodies.mass, more.mass);
  every(bodies.inertia, more.inertia);
  every(bodies.material, more.material);
  every(bodies.fixed, more.fixed);
  bodies.identity.resize(rows + added);
  std::iota(bodies.identity.begin() + static_cast<std::ptrdiff_t>(rows), bodies.identity.end(),
            static_cast<std::int64_t>(rows));
  const Vec3 none = Vec3::Zero();
  append(bodies.velocity, rows, more.velocity, added, none);
  append(bodies.spin, rows, more.spin, added, none);
  append(bodies.orientation, rows, more.orientation, added, Quat(Quat::Identity()));
  append(bodies.applied_force, rows, more.applied_force, added, none);
  append(bodies.applied_moment, rows, more.applied_moment, added, none);
  append(bodies.damping, rows, more.damping, added, Bodies::scene_damping);
  append(bodies.ramp, rows, more.ramp, added, RadiusRamp());
  append(bodies.mass_factor, rows, more.mass_factor, added, 1.0);
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
