#include "eigengrain/search/candidates.hpp"

#include "eigengrain/base/adjacency.hpp"
#include "eigengrain/base/assert.hpp"
#include "eigengrain/base/error.hpp"
#include "eigengrain/base/parallel.hpp"

#include "pair_search.hpp"
#include "pair_searcher.hpp"
#include "size_levels.hpp"
#include "wrapped_bodies.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <utility>

namespace eigengrain::search {
namespace {

constexpr std::int64_t chunk_size = 1024;

/// A ball that touches its own image number 128 would be reported below too, but only after a search
/// through as many cells as the cell is too small.
void require_cell_not_tiny(std::span<const double> radii, const Vec3& heights, double reach) {
  const double largest = *std::max_element(radii.begin(), radii.end());
  for (int k = 0; k < 3; ++k) {
    const bool repeats = heights[k] > 0;
    if (!repeats || 2 * largest + reach < (image_limit + 1) * heights[k]) continue;
    throw InputError(fmt::format(
        "the periodic cell is {:g} m long along {}: a ball of radius {:g} m touches more than {} images of "
        "itself there; enlarge the cell (repeat its contents)",
        heights[k], "xyz"[k], largest, image_limit));
  }
}

[[noreturn]] void throw_far(const WidePair& pair) {
  throw InputError(
      fmt::format("balls {} and {} (in storage, from 0) touch across ({}, {}, {}) periodic cells, and no "
                  "more than {} can "
                  "be counted; wrap the centres into the cell, or enlarge the cell",
                  pair.a, pair.b, pair.image[0], pair.image[1], pair.image[2], image_limit));
}

/// Puts the foreign pairs into the rows of their a. Both kinds are in order already, so rows are merged.
void merge_foreign(std::int32_t bodies, std::vector<FoundPairs>& chunks) {
  std::vector<CandidatePair> foreign;
  for (const FoundPairs& chunk : chunks)
    foreign.insert(foreign.end(), chunk.foreign.begin(), chunk.foreign.end());
  if (foreign.empty()) return;
  std::vector<std::int32_t> row_of(foreign.size());
  std::transform(foreign.begin(), foreign.end(), row_of.begin(), [](const auto& p) { return p.a; });
  const Adjacency rows = group_by_row(bodies, row_of);

  for_chunks(bodies, chunk_size, [&](std::int64_t begin, std::int64_t end, std::int64_t c) {
    std::vector<CandidatePair>& own = chunks[c].own;
    const auto first = static_cast<std::size_t>(rows.offsets[begin]);
    const auto last = static_cast<std::size_t>(rows.offsets[end]);
    std::vector<CandidatePair> arrived;
    arrived.reserve(last - first);
    for (std::size_t k = first; k < last; ++k)
      arrived.push_back(foreign[static_cast<std::size_t>(rows.targets[k])]);
    std::vector<CandidatePair> merged;
    merged.reserve(own.size() + arrived.size());
    std::merge(own.begin(), own.end(), arrived.begin(), arrived.end(), std::back_inserter(merged), precedes);
    own = std::move(merged);
  });
}

PairSearch concatenated(const std::vector<FoundPairs>& chunks) {
  PairSearch result;
  std::vector<std::size_t> starts{0};
  for (const FoundPairs& chunk : chunks) {
    starts.push_back(starts.back() + chunk.own.size());
    result.rows_visited += chunk.rows_visited;
    result.distance_tests += chunk.distance_tests;
  }
  result.pairs.resize(starts.back());
  for_chunks(std::ssize(chunks), 1, [&](std::int64_t, std::int64_t, std::int64_t c) {
    const auto chunk = static_cast<std::size_t>(c);
    std::copy(chunks[chunk].own.begin(), chunks[chunk].own.end(),
              result.pairs.begin() + static_cast<std::ptrdiff_t>(starts[chunk]));
  });
  return result;
}

}  // namespace

PairSearch search_pairs(std::span<const Vec3> centres, std::span<const double> radii,
                        const model::PeriodicCell& cell, double reach) {
  EIGENGRAIN_ASSERT(centres.size() == radii.size(), centres.size(), radii.size());
  EIGENGRAIN_ASSERT(reach >= 0 && std::isfinite(reach), reach);
  for ([[maybe_unused]] const double radius : radii)
    EIGENGRAIN_ASSERT(radius > 0 && std::isfinite(radius), radius);
  if (centres.empty()) return {};

  const WrappedBodies wrapped(centres, cell);
  require_cell_not_tiny(radii, wrapped.heights(), reach);
  const SizeLevels levels(wrapped, radii, reach);

  const auto bodies = static_cast<std::int32_t>(centres.size());
  std::vector<FoundPairs> chunks(static_cast<std::size_t>((bodies + chunk_size - 1) / chunk_size));
  for_chunks(bodies, chunk_size, [&](std::int64_t begin, std::int64_t end, std::int64_t c) {
    // Collected here and not in `chunks`, where threads would write to the same cache lines.
    FoundPairs found;
    PairSearcher searcher(centres, radii, wrapped, levels, reach);
    for (std::int64_t body = begin; body < end; ++body)
      searcher.search(static_cast<std::int32_t>(body), found);
    chunks[c] = std::move(found);
  });
  // Thrown here because an exception must not leave a parallel loop.
  for (const FoundPairs& chunk : chunks)
    if (chunk.far) throw_far(*chunk.far);
  merge_foreign(bodies, chunks);
  return concatenated(chunks);
}

std::vector<CandidatePair> candidate_pairs(std::span<const Vec3> centres, std::span<const double> radii,
                                           const model::PeriodicCell& cell, double reach) {
  return search_pairs(centres, radii, cell, reach).pairs;
}

}  // namespace eigengrain::search
