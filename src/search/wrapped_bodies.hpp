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

/// The centres as the grids see them: moved by whole cells into the periodic cell. They only
/// preselect, so that a rounding error here never decides about a pair; it is covered by slack().
/// Where no axis repeats they are the centres given, not a copy.
///
/// Grids have axes at right angles. In a cell whose edges have not, bodies are sorted by places: how far
/// along each edge, times the edge's length (x itself along an axis that does not repeat). What is no farther
/// than r is then no farther than stretch() r in places, axis by axis. In a box places are the centres.
class WrappedBodies {
 public:
  /// Throws InputError for a centre so far outside of the cell that its place in the cell is lost.
  WrappedBodies(std::span<const Vec3> centres, const model::PeriodicCell& cell);

  std::span<const Vec3> centres() const { return copies_.empty() ? given_ : copies_; }
  std::span<const Vec3> places() const { return places_.empty() ? centres() : places_; }

  /// Where the body itself stands, seen from its wrapped copy: x = wrapped + H home.
  const WideImage& home(std::int32_t body) const { return homes_.empty() ? no_image_ : homes_[body]; }

  const model::PeriodicCell& cell() const { return cell_; }
  /// Translation to an image, m.
  Vec3 shift(const WideImage& image) const { return repeating_.shift(image); }
  /// Lengths of the edges that repeat, 0 along other axes.
  const Vec3& lengths() const { return lengths_; }
  /// Distances between opposite faces, 0 along an axis that does not repeat.
  Vec3 heights() const { return lengths_.cwiseQuotient(stretch_); }
  const Vec3& stretch() const { return stretch_; }
  /// Bound of the rounding errors of distances between wrapped copies, and of their cells, m.
  double slack() const { return slack_; }

 private:
  void wrap_into_box(const Box& box);
  void wrap_into_slanted(const Box& box);

  std::span<const Vec3> given_;
  const model::PeriodicCell& cell_;
  model::PeriodicCell repeating_;  ///< the cell with zeros for edges that do not repeat
  Vec3 lengths_ = Vec3::Zero();
  Vec3 stretch_ = Vec3::Ones();
  double slack_ = 0;
  WideImage no_image_{};
  std::vector<Vec3> copies_;
  std::vector<Vec3> places_;
  std::vector<WideImage> homes_;
};

}  // namespace eigengrain::search
