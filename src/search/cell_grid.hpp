#pragma once

#include "eigengrain/base/vec.hpp"

#include "wrapped_bodies.hpp"

#include <array>
#include <cstdint>
#include <span>
#include <vector>

namespace eigengrain::search {

/// Consecutive cells first..last; none if last < first.
struct CellRange {
  std::int64_t first = 0;
  std::int64_t last = -1;
};

/// One axis of a grid: which cell holds a coordinate. Cells are counted from 0; on a periodic axis cell
/// c + count is the next image of cell c.
class GridAxis {
 public:
  GridAxis() = default;
  /// lower, upper: the bodies' extent; edge: the least length of a cell, m.
  static GridAxis open(double lower, double upper, double edge);
  static GridAxis periodic(double origin, double length, double edge);

  std::int64_t count() const { return count_; }

  /// The cell of a body of this grid (of its wrapped copy).
  std::int64_t cell_of(double x) const {
    const std::int64_t cell = unbounded_cell(x);
    return cell < 0 ? 0 : (cell < count_ ? cell : count_ - 1);
  }

  /// The cells that [lower, upper] touches: unwrapped on a periodic axis, else only those with bodies.
  /// Because the cell never decreases when the coordinate grows, rounding loses nobody within.
  CellRange cells_of(double lower, double upper) const {
    if (periodic_) return {unbounded_cell(lower), unbounded_cell(upper)};
    if (upper < lower_ || lower > upper_) return {};
    return {cell_of(lower), cell_of(upper)};
  }

  /// Calls body(first, last, image) for each image of the cell that the range runs through, with the
  /// range's part in it counted from the start of that image.
  template <class Body>
  void for_each_image(const CellRange& range, const Body& body) const {
    if (range.first >= 0 && range.last < count_) {
      body(range.first, range.last, 0);
      return;
    }
    std::int64_t image = floor_divided(range.first, count_);
    for (std::int64_t start = image * count_; start <= range.last; start += count_, ++image) {
      const std::int64_t first = range.first > start ? range.first - start : 0;
      const std::int64_t last = range.last - start < count_ ? range.last - start : count_ - 1;
      body(first, last, static_cast<std::int32_t>(image));
    }
  }

 private:
  /// Cells farther out than this share one: the product with cells_per_metre_ stays exact to a small
  /// fraction of a cell, and nothing overflows however far a body has flown.
  static constexpr double farthest = 1099511627776.0;  // 2^40

  static std::int64_t floor_divided(std::int64_t a, std::int64_t b) {
    return a / b - static_cast<std::int64_t>(a % b < 0);
  }

  std::int64_t unbounded_cell(double x) const {
    const double value = (x - origin_) * cells_per_metre_;
    // In this order of comparison not-a-number becomes the limit.
    const double below = value < farthest ? value : farthest;
    const double bounded = below > -farthest ? below : -farthest;
    // Not std::floor, which is a call on processors that are only known to be x86-64.
    const auto truncated = static_cast<std::int64_t>(bounded);
    return truncated - static_cast<std::int64_t>(bounded < static_cast<double>(truncated)) - offset_;
  }

  bool periodic_ = false;
  double origin_ = 0;
  double cells_per_metre_ = 1;
  std::int64_t offset_ = 0;
  std::int64_t count_ = 1;
  double lower_ = 0;
  double upper_ = 0;
};

/// Bodies sorted into cells, in memory proportional to their number however far apart they are: a cell is
/// looked up in a bucket, and a bucket may hold bodies of other cells too. Visitors therefore see all bodies
/// near a point, possibly some twice, and some from anywhere.
///
/// In a compact domain every cell has its own bucket, in rows along x. Otherwise pieces of such rows are
/// put at pseudo-random places of a table: unlike a plain wrapped grid this has no bad case for bodies in a
/// regular pattern. Cells are boxes in the places of bodies (WrappedBodies).
class CellGrid {
 public:
  struct Entry {
    Vec3 centre;  ///< of the wrapped copy, m
    std::int32_t body = 0;
  };

  /// members: the bodies of this grid, at least one; edge: the least length of a cell, m.
  CellGrid(const WrappedBodies& bodies, std::span<const std::int32_t> members, double edge);

  /// Calls visit(entries, image) such that every copy (body, image) with a place within the box place ± range
  /// occurs.
  template <class Visit>
  void visit_near(const Vec3& place, const Vec3& range, const Visit& visit) const {
    std::array<CellRange, 3> cells;
    for (int k = 0; k < 3; ++k) {
      const auto axis = static_cast<std::size_t>(k);
      cells[axis] = axes_[axis].cells_of(place[k] - range[k], place[k] + range[k]);
      if (cells[axis].last < cells[axis].first) return;
    }
    axes_[2].for_each_image(cells[2], [&](std::int64_t z, std::int64_t last_z, std::int32_t image_z) {
      for (; z <= last_z; ++z)
        axes_[1].for_each_image(cells[1], [&](std::int64_t y, std::int64_t last_y, std::int32_t image_y) {
          for (; y <= last_y; ++y)
            axes_[0].for_each_image(cells[0], [&](std::int64_t x, std::int64_t last_x, std::int32_t image_x) {
              visit_row(x, last_x, y, z, WideImage{image_x, image_y, image_z}, visit);
            });
        });
    });
  }

 private:
  /// Table rows keep this many (2^5) cells along x together, so that neighbours are neighbours in memory.
  static constexpr int piece_bits = 5;
  static constexpr std::int64_t piece = std::int64_t{1} << piece_bits;

  static std::uint64_t mixed(std::int64_t piece_of_x, std::int64_t y, std::int64_t z) {
    std::uint64_t h = static_cast<std::uint64_t>(piece_of_x) * 0x9e3779b97f4a7c15ULL;
    h = (h ^ h >> 32U ^ static_cast<std::uint64_t>(y)) * 0xbf58476d1ce4e5b9ULL;
    h = (h ^ h >> 32U ^ static_cast<std::uint64_t>(z)) * 0x94d049bb133111ebULL;
    return h ^ h >> 32U;
  }

  std::int64_t dense_bucket(std::int64_t x, std::int64_t y, std::int64_t z) const {
    return x + axes_[0].count() * (y + axes_[1].count() * z);
  }
  std::int64_t table_bucket(std::int64_t x, std::int64_t y, std::int64_t z) const {
    return static_cast<std::int64_t>(mixed(x >> piece_bits, y, z) & table_mask_) + (x & (piece - 1));
  }

  std::span<const Entry> entries_of(std::int64_t bucket, std::int64_t buckets) const {
    const std::int64_t begin = starts_[bucket];
    const std::int64_t end = starts_[bucket + buckets];
    return {entries_.data() + begin, static_cast<std::size_t>(end - begin)};
  }

  template <class Visit>
  void visit_row(std::int64_t x, std::int64_t last_x, std::int64_t y, std::int64_t z, const WideImage& image,
                 const Visit& visit) const {
    if (dense_) {
      visit(entries_of(dense_bucket(x, y, z), last_x - x + 1), image);
      return;
    }
    while (x <= last_x) {
      const std::int64_t piece_end = (x | (piece - 1)) + 1;
      const std::int64_t end = piece_end <= last_x ? piece_end : last_x + 1;
      visit(entries_of(table_bucket(x, y, z), end - x), image);
      x = end;
    }
  }

  void set_axes(const WrappedBodies& bodies, std::span<const std::int32_t> members, double edge);
  std::int64_t choose_buckets(std::int64_t members);
  void fill(const WrappedBodies& bodies, std::span<const std::int32_t> members, std::int64_t buckets);

  std::array<GridAxis, 3> axes_;
  bool dense_ = true;
  std::uint64_t table_mask_ = 0;
  std::vector<std::int64_t> starts_;  ///< [buckets + 1] into entries_
  std::vector<Entry> entries_;        ///< bucket after bucket
};

}  // namespace eigengrain::search
