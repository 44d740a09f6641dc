#include "cell_grid.hpp"

#include "eigengrain/base/adjacency.hpp"
#include "eigengrain/base/parallel.hpp"

#include <algorithm>
#include <bit>
#include <utility>

namespace eigengrain::search {

GridAxis GridAxis::open(double lower, double upper, double edge) {
  GridAxis axis;
  // Cells are counted from the coordinate 0 and not from `lower`, which may be a body that flew away.
  axis.cells_per_metre_ = 1 / edge;
  axis.lower_ = lower;
  axis.upper_ = upper;
  axis.offset_ = axis.unbounded_cell(lower);
  axis.count_ = axis.unbounded_cell(upper) + 1;
  return axis;
}

GridAxis GridAxis::periodic(double origin, double length, double edge) {
  GridAxis axis;
  axis.periodic_ = true;
  axis.origin_ = origin;
  axis.count_ = std::max(std::int64_t{1}, static_cast<std::int64_t>(std::min(length / edge, farthest / 4)));
  axis.cells_per_metre_ = static_cast<double>(axis.count_) / length;
  return axis;
}

CellGrid::CellGrid(const WrappedBodies& bodies, std::span<const std::int32_t> members, double edge) {
  set_axes(bodies, members, edge);
  fill(bodies, members, choose_buckets(static_cast<std::int64_t>(members.size())));
}

void CellGrid::set_axes(const WrappedBodies& bodies, std::span<const std::int32_t> members, double edge) {
  const auto place = [&](std::int32_t body) { return bodies.places()[body]; };
  Box box{.lower = place(members.front()), .upper = place(members.front())};
  for (const std::int32_t body : members) {
    box.lower = box.lower.cwiseMin(place(body));
    box.upper = box.upper.cwiseMax(place(body));
  }
  const model::PeriodicCell& cell = bodies.cell();
  for (int k = 0; k < 3; ++k) {
    const auto axis = static_cast<std::size_t>(k);
    axes_[axis] = cell.periodic[axis]
                      ? GridAxis::periodic(cell.origin[k], bodies.lengths()[k], bodies.stretch()[k] * edge)
                      : GridAxis::open(box.lower[k], box.upper[k], edge);
  }
}

/// One bucket a cell if that takes no more than a few for each body, else a table of two to four for each.
std::int64_t CellGrid::choose_buckets(std::int64_t members) {
  constexpr std::int64_t most = std::int64_t{1} << 30;  // group_by_row counts rows in 32 bits
  const std::int64_t affordable = std::min(4 * members + 64, most);
  // By division: the product of three counts may overflow.
  const std::int64_t x = axes_[0].count();
  const std::int64_t y = axes_[1].count();
  const std::int64_t z = axes_[2].count();
  dense_ = x <= affordable && y <= affordable / x && z <= affordable / x / y;
  if (dense_) return x * y * z;
  const std::uint64_t table = std::bit_ceil(static_cast<std::uint64_t>(std::min(2 * members, most)));
  table_mask_ = table - 1;
  // A piece of a row that starts in the last place goes beyond it rather than round the corner.
  return static_cast<std::int64_t>(table) + piece - 1;
}

void CellGrid::fill(const WrappedBodies& bodies, std::span<const std::int32_t> members,
                    std::int64_t buckets) {
  const std::span<const Vec3> centres = bodies.centres();
  const std::span<const Vec3> places = bodies.places();
  const auto count = static_cast<std::int64_t>(members.size());
  std::vector<std::int32_t> bucket_of(members.size());
  for_each_index(count, [&](std::int64_t m) {
    const Vec3& place = places[static_cast<std::size_t>(members[m])];
    const std::int64_t x = axes_[0].cell_of(place.x());
    const std::int64_t y = axes_[1].cell_of(place.y());
    const std::int64_t z = axes_[2].cell_of(place.z());
    const std::int64_t bucket = dense_ ? dense_bucket(x, y, z) : table_bucket(x, y, z);
    bucket_of[m] = static_cast<std::int32_t>(bucket);
  });
  Adjacency sorted = group_by_row(static_cast<std::int32_t>(buckets), bucket_of);
  starts_ = std::move(sorted.offsets);
  entries_.resize(members.size());
  for_each_index(count, [&](std::int64_t e) {
    const std::int32_t member = sorted.targets[e];
    const std::int32_t body = members[member];
    entries_[e] = {centres[body], body};
  });
}

}  // namespace eigengrain::search
