#pragma once

#include "eigengrain/base/vec.hpp"
#include "eigengrain/generate/region.hpp"

#include <array>
#include <cstdint>
#include <vector>

namespace eigengrain::generate {

/// Balls that do not overlap, added in the order of decreasing radius, and asked whether another one fits.
/// They are sorted into one grid for each size class (within a factor of two), so that a small ball looks at
/// few others.
class PlacedBalls {
 public:
  explicit PlacedBalls(const Region& region) : region_(region) {}

  /// Opens a class for `expected` more balls, none larger than `largest` (m).
  void begin_class(double largest, std::int64_t expected);
  /// Whether a ball at that place, within the region, overlaps none.
  bool fits(const Vec3& centre, double radius) const;
  /// Adds a ball to the class opened last.
  void add(const Vec3& centre, double radius);

 private:
  struct Entry {
    Vec3 centre;
    double radius = 0;
    std::int32_t next = -1;  ///< of the same cell
  };
  struct Class {
    double largest = 0;
    std::array<std::int64_t, 3> cells{};
    std::vector<std::int32_t> first;  ///< [cells] index of an entry; -1: empty
    std::vector<Entry> entries;
  };
  /// Cells first..last along one axis; beyond 0..cells they are images.
  struct Cells {
    std::int64_t first = 0;
    std::int64_t last = -1;
  };

  std::int64_t cell_of(const Class& size, double x, int axis) const;
  Cells cells_near(const Class& size, double x, double range, int axis) const;
  bool fits_in(const Class& size, const Vec3& centre, double radius) const;

  Region region_;
  std::vector<Class> classes_;
};

}  // namespace eigengrain::generate
