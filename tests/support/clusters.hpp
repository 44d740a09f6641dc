#pragma once

#include "support/scenes.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <optional>
#include <random>
#include <utility>
#include <vector>

/// Clusters of balls without stress, for runs that are to be linear.
namespace eigengrain::test {

/// Of the radius; its forces must be small against those of the motion.
inline constexpr double cluster_overlap = 1e-13;

/// Centre of a ball that just touches three others, on the side of `side`.
inline std::optional<Vec3> seat(const std::array<Vec3, 3>& c, const std::array<double, 3>& reach,
                                double side) {
  const Vec3 ex = (c[1] - c[0]).normalized();
  const double i = ex.dot(c[2] - c[0]);
  const Vec3 ey = (c[2] - c[0] - i * ex).normalized();
  const double d = (c[1] - c[0]).norm();
  const double j = ey.dot(c[2] - c[0]);
  const double x = (reach[0] * reach[0] - reach[1] * reach[1] + d * d) / (2 * d);
  const double y = (reach[0] * reach[0] - reach[2] * reach[2] + i * i + j * j) / (2 * j) - i / j * x;
  const double z2 = reach[0] * reach[0] - x * x - y * y;
  if (!(z2 > 0.01)) return std::nullopt;
  return c[0] + x * ex + y * ey + side * std::sqrt(z2) * ex.cross(ey);
}

struct PlacedBalls {
  std::vector<Vec3> centres;
  std::vector<double> radii;
};

/// Balls of different sizes, each in the seat of three others and none deeper in another than the overlap.
///
/// among  how many of the balls that came last seats are looked for among: all of them for clusters that
///        spread, a few for long ones that are found soon
inline PlacedBalls unstressed_places(std::uint64_t seed, int balls, std::size_t among = SIZE_MAX) {
  std::mt19937_64 random(seed);
  std::uniform_real_distribution<double> uniform(0, 1);
  std::vector<Vec3> centres;
  std::vector<double> radii;
  const auto pick = [&] {
    const std::size_t choice = std::min(among, centres.size());
    return centres.size() - choice + static_cast<std::size_t>(uniform(random) * static_cast<double>(choice));
  };
  while (static_cast<int>(centres.size()) < balls) {
    const double radius = 1 + 0.5 * uniform(random);
    Vec3 centre = Vec3::Zero();
    if (centres.size() < 3) {
      // The first three as a triangle: the second beside the first, the third in between.
      if (centres.size() == 1) centre = {(radii[0] + radius) * (1 - cluster_overlap), 0, 0};
      if (centres.size() == 2) {
        const double a = (radii[0] + radius) * (1 - cluster_overlap);
        const double b = (radii[1] + radius) * (1 - cluster_overlap);
        const double x = (a * a - b * b + centres[1].x() * centres[1].x()) / (2 * centres[1].x());
        centre = {x, std::sqrt(a * a - x * x), 0};
      }
    } else {
      const std::array<std::size_t, 3> hosts{pick(), pick(), pick()};
      if (hosts[0] == hosts[1] || hosts[0] == hosts[2] || hosts[1] == hosts[2]) continue;
      std::array<Vec3, 3> c;
      std::array<double, 3> reach{};
      for (std::size_t k = 0; k < 3; ++k) {
        c[k] = centres[hosts[k]];
        reach[k] = (radii[hosts[k]] + radius) * (1 - cluster_overlap);
      }
      const auto found = seat(c, reach, uniform(random) < 0.5 ? -1 : 1);
      if (!found || !found->allFinite()) continue;
      centre = *found;
      bool fits = true;
      for (std::size_t k = 0; k < centres.size(); ++k)
        fits = fits && (centres[k] - centre).norm() > (radii[k] + radius) * (1 - 2 * cluster_overlap);
      if (!fits) continue;
    }
    centres.push_back(centre);
    radii.push_back(radius);
  }
  return {std::move(centres), std::move(radii)};
}

inline SceneBuilder unstressed_cluster(std::uint64_t seed, int balls, const Springs& springs, double alpha) {
  const PlacedBalls places = unstressed_places(seed, balls);
  SceneBuilder builder(springs);
  for (std::size_t k = 0; k < places.centres.size(); ++k)
    builder.ball(places.centres[k], places.radii[k], std::pow(places.radii[k], 3));
  return builder.damped(alpha);
}

}  // namespace eigengrain::test
