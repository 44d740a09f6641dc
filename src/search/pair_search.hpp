#pragma once

#include "eigengrain/search/candidates.hpp"

#include <cstdint>
#include <span>
#include <vector>

namespace eigengrain::search {

/// What candidate_pairs does, with a count of its work: operations, not seconds, so that tests can hold the
/// cost to account on any machine.
struct PairSearch {
  std::vector<CandidatePair> pairs;
  std::int64_t rows_visited = 0;    ///< rows of cells looked up
  std::int64_t distance_tests = 0;  ///< copies of bodies met there
};

PairSearch search_pairs(std::span<const Vec3> centres, std::span<const double> radii,
                        const model::PeriodicCell& cell, double reach);

}  // namespace eigengrain::search
