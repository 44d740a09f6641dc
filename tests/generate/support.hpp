#pragma once

#include "eigengrain/base/error.hpp"
#include "eigengrain/generate/balls.hpp"
#include "eigengrain/generate/region.hpp"
#include "eigengrain/search/candidates.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <string>
#include <vector>

namespace eigengrain::generate {

inline Region box(const Vec3& lower, const Vec3& upper) {
  return {.lower = lower, .upper = upper};
}
inline Region cell(const Vec3& lengths, std::array<bool, 3> periodic = {true, true, true}) {
  return {.lower = Vec3::Zero(), .upper = lengths, .periodic = periodic};
}

/// What the balls have to do with each other, found without the code under test: pairs closer than `reach` to
/// contact.
struct Neighbours {
  std::vector<int> count;                                      ///< [n] of each ball, images included
  double least_gap = std::numeric_limits<double>::infinity();  ///< m; negative: overlap
  double greatest_gap = -std::numeric_limits<double>::infinity();
};

inline Neighbours neighbours_of(const Balls& balls, const Region& region, double reach) {
  Neighbours result;
  result.count.assign(balls.radius.size(), 0);
  for (const search::CandidatePair& pair :
       search::candidate_pairs(balls.position, balls.radius, region.cell(), reach)) {
    const Vec3 d = balls.position[pair.b] + region.cell().shift(pair.image) - balls.position[pair.a];
    const double gap = d.norm() - balls.radius[pair.a] - balls.radius[pair.b];
    ++result.count[pair.a];
    ++result.count[pair.b];
    result.least_gap = std::min(result.least_gap, gap);
    result.greatest_gap = std::max(result.greatest_gap, gap);
  }
  return result;
}

/// Whether all balls lie inside of the open axes and all centres inside of the periodic ones, up to
/// `tolerance`.
inline bool all_inside(const Balls& balls, const Region& region, double tolerance) {
  for (std::size_t i = 0; i < balls.radius.size(); ++i)
    for (int k = 0; k < 3; ++k) {
      const double margin = region.periodic[k] ? 0 : balls.radius[i];
      const double x = balls.position[i][k];
      if (x - margin < region.lower[k] - tolerance || x + margin > region.upper[k] + tolerance) return false;
    }
  return true;
}

/// The message of the InputError that the call throws; empty if it throws none.
template <class Call>
std::string refusal(const Call& call) {
  try {
    call();
  } catch (const InputError& error) {
    return error.what();
  }
  return {};
}

}  // namespace eigengrain::generate
