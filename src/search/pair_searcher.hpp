#pragma once

#include "eigengrain/search/candidates.hpp"

#include "cell_grid.hpp"
#include "size_levels.hpp"
#include "wrapped_bodies.hpp"

#include <cstddef>
#include <cstdint>
#include <limits>
#include <optional>
#include <span>
#include <vector>

namespace eigengrain::search {

/// The greatest image index that model::Image can hold, in size.
constexpr std::int32_t image_limit = std::numeric_limits<std::int8_t>::max();

/// A CandidatePair whose image is not yet known to fit.
struct WidePair {
  std::int32_t a = 0;
  std::int32_t b = 0;
  WideImage image{};
};

/// The order of the result of candidate_pairs.
bool precedes(const CandidatePair& left, const CandidatePair& right);

/// What some consecutive bodies have found; both lists are in the order of the bodies that searched, and for
/// each of them sorted.
struct FoundPairs {
  std::vector<CandidatePair> own;      ///< a is the body that searched
  std::vector<CandidatePair> foreign;  ///< b is: a is a larger body that comes earlier in storage
  std::optional<WidePair> far;         ///< a pair whose image does not fit
  std::int64_t rows_visited = 0;
  std::int64_t distance_tests = 0;
};

/// Finds the partners of one body after the other. The body of the smaller size class (in the same class, the
/// one of the smaller index) looks up the cells around it. The grids preselect generously; within_reach
/// decides from the centres and radii as they were given, in the order (a, b), so that neither grids nor
/// threads can change a result.
///
/// One searcher serves many bodies of one thread: its lists are reused, so that a body costs no allocation.
class PairSearcher {
 public:
  PairSearcher(std::span<const Vec3> centres, std::span<const double> radii, const WrappedBodies& wrapped,
               const SizeLevels& levels, double reach)
      : centres_(centres), radii_(radii), wrapped_(wrapped), levels_(levels), reach_(reach) {}

  void search(std::int32_t body, FoundPairs& result);

 private:
  /// A copy of a body that the grid found near; the image is that of the wrapped copy.
  struct Hit {
    std::int32_t body = 0;
    WideImage image{};
  };

  void preselect(std::int32_t body, const SizeLevel& level, std::int32_t least_partner, FoundPairs& result);
  void add_hits(std::span<const CellGrid::Entry> entries, const Vec3& centre, double squared_range,
                std::int32_t least_partner, const WideImage& image);
  void add_pair(std::int32_t body, const Hit& hit, FoundPairs& result);
  WidePair pair_of(std::int32_t body, const Hit& hit) const;
  bool within_reach(const WidePair& pair) const;

  std::span<const Vec3> centres_;
  std::span<const double> radii_;
  const WrappedBodies& wrapped_;
  const SizeLevels& levels_;
  double reach_;
  std::vector<Hit> hits_;  ///< the first hit_count_ count
  std::size_t hit_count_ = 0;
  std::vector<CandidatePair> row_;
};

}  // namespace eigengrain::search
