#include "pair_searcher.hpp"

#include <algorithm>
#include <cstdlib>
#include <utility>

namespace eigengrain::search {
namespace {

bool first_nonzero_is_positive(const WideImage& image) {
  return image > WideImage{};
}

bool fits(const WideImage& image) {
  return std::all_of(image.begin(), image.end(), [](std::int32_t i) { return std::abs(i) <= image_limit; });
}

model::Image narrowed(const WideImage& image) {
  return {static_cast<std::int8_t>(image[0]), static_cast<std::int8_t>(image[1]),
          static_cast<std::int8_t>(image[2])};
}

}  // namespace

bool precedes(const CandidatePair& left, const CandidatePair& right) {
  if (left.a != right.a) return left.a < right.a;
  if (left.b != right.b) return left.b < right.b;
  return left.image < right.image;
}

void PairSearcher::search(std::int32_t body, FoundPairs& result) {
  row_.clear();
  const std::span<const SizeLevel> levels = levels_.for_body(body);
  for (const SizeLevel& level : levels) {
    // In its own level a body leaves it to partners of smaller index to find the pair.
    const std::int32_t least_partner = &level == &levels.back() ? body : 0;
    preselect(body, level, least_partner, result);
    for (std::size_t h = 0; h < hit_count_; ++h) add_pair(body, hits_[h], result);
  }
  // A bucket that was visited for two of its cells has given its bodies twice.
  std::sort(row_.begin(), row_.end(), precedes);
  row_.erase(std::unique(row_.begin(), row_.end()), row_.end());
  for (const CandidatePair& p : row_) (p.a == body ? result.own : result.foreign).push_back(p);
}

/// Sets the hits to all copies of bodies >= least_partner in the level that may be partners.
void PairSearcher::preselect(std::int32_t body, const SizeLevel& level, std::int32_t least_partner,
                             FoundPairs& result) {
  hit_count_ = 0;
  const Vec3 centre = wrapped_.centres()[body];
  const double size = radii_[body] + 0.5 * reach_;
  // The factor covers the rounding of every expression that is relative to the distance itself.
  const double range = (size + level.largest) * (1 + 0x1p-40) + wrapped_.slack();
  level.grid.visit_near(wrapped_.places()[body], range * wrapped_.stretch(),
                        [&](std::span<const CellGrid::Entry> entries, const WideImage& image) {
                          ++result.rows_visited;
                          result.distance_tests += std::ssize(entries);
                          // Instead of all bodies of an image, move the one that looks at them the other way.
                          add_hits(entries, centre - wrapped_.shift(image), range * range, least_partner,
                                   image);
                        });
}

void PairSearcher::add_hits(std::span<const CellGrid::Entry> entries, const Vec3& centre,
                            double squared_range, std::int32_t least_partner, const WideImage& image) {
  if (hits_.size() < hit_count_ + entries.size()) hits_.resize(2 * (hit_count_ + entries.size()));
  // Written always and kept by counting on: a branch here would be mispredicted for every contact.
  Hit* next = hits_.data() + hit_count_;
  for (const CellGrid::Entry& entry : entries) {
    *next = {entry.body, image};
    const auto near = static_cast<std::ptrdiff_t>((entry.centre - centre).squaredNorm() <= squared_range);
    next += near & static_cast<std::ptrdiff_t>(entry.body >= least_partner);
  }
  hit_count_ = static_cast<std::size_t>(next - hits_.data());
}

/// Adds the pair of the body and the hit to the row if they are close enough.
void PairSearcher::add_pair(std::int32_t body, const Hit& hit, FoundPairs& result) {
  if (hit.body == body && !first_nonzero_is_positive(hit.image)) return;
  const WidePair pair = pair_of(body, hit);
  if (!within_reach(pair)) return;
  if (fits(pair.image)) {
    row_.push_back({pair.a, pair.b, narrowed(pair.image)});
  } else if (!result.far) {
    result.far = pair;
  }
}

/// In the order a <= b, with the image between the centres as given instead of their wrapped copies.
WidePair PairSearcher::pair_of(std::int32_t body, const Hit& hit) const {
  const WideImage& home = wrapped_.home(body);
  const WideImage& home_of_hit = wrapped_.home(hit.body);
  WidePair pair{.a = body, .b = hit.body, .image = hit.image};
  for (std::size_t k = 0; k < 3; ++k) pair.image[k] += home[k] - home_of_hit[k];
  if (pair.b < pair.a) {
    std::swap(pair.a, pair.b);
    for (std::int32_t& i : pair.image) i = -i;
  }
  return pair;
}

bool PairSearcher::within_reach(const WidePair& pair) const {
  const auto a = static_cast<std::size_t>(pair.a);
  const auto b = static_cast<std::size_t>(pair.b);
  const Vec3 branch = centres_[b] + wrapped_.shift(pair.image) - centres_[a];
  const double limit = radii_[a] + radii_[b] + reach_;
  return branch.squaredNorm() <= limit * limit;
}

}  // namespace eigengrain::search
