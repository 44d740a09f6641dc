#pragma once

#include "eigengrain/base/vec.hpp"
#include "eigengrain/model/surroundings.hpp"

#include <array>
#include <cstdint>
#include <span>
#include <vector>

namespace eigengrain::search {

/// An image index wide enough for any centre and any cell; model::Image holds what a pair may have.
using WideImage = std::array<std::int32_t, 3>;

/// The smallest box around some of the bodies, m.
struct Box {
  Vec3 lower;
  Vec3 upper;
};

Box bounding_box(std::span<const Vec3> centres);

/// The centres as the grids see them: moved by whole cell lengths into the periodic cell. They only
/// preselect, so that a rounding error here never decides about a pair; it is covered by slack().
/// Where no axis repeats they are the centres given, not a copy.
class WrappedBodies {
 public:
  /// Throws InputError for a centre so far outside of the cell that its place in the cell is lost.
  WrappedBodies(std::span<const Vec3> centres, const model::PeriodicCell& cell);

  std::span<const Vec3> centres() const { return copies_.empty() ? given_ : copies_; }

  /// Where the body itself stands, seen from its wrapped copy: x = wrapped + home * lengths.
  const WideImage& home(std::int32_t body) const { return homes_.empty() ? no_image_ : homes_[body]; }

  const model::PeriodicCell& cell() const { return cell_; }
  /// Cell lengths, 0 along an axis that does not repeat.
  const Vec3& lengths() const { return lengths_; }
  /// Bound of the rounding errors of distances between wrapped copies, and of their cells, m.
  double slack() const { return slack_; }

 private:
  void wrap();

  std::span<const Vec3> given_;
  const model::PeriodicCell& cell_;
  Vec3 lengths_ = Vec3::Zero();
  double slack_ = 0;
  WideImage no_image_{};
  std::vector<Vec3> copies_;
  std::vector<WideImage> homes_;
};

}  // namespace eigengrain::search
