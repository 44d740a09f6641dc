#pragma once

#include "eigengrain/base/vec.hpp"

#include <cstdint>
#include <vector>

namespace eigengrain::generate {

/// Balls that a generator has made, one row a ball.
struct Balls {
  std::vector<Vec3> position;  ///< centre, m
  std::vector<double> radius;  ///< m

  void add(const Vec3& centre, double r) {
    position.push_back(centre);
    radius.push_back(r);
  }
};

/// No generator makes more balls than this: they take more memory than machines have, and most likely a unit
/// is wrong.
constexpr std::int64_t most_balls = 100'000'000;

}  // namespace eigengrain::generate
