#include "eigengrain/generate/random_fill.hpp"

#include "eigengrain/base/error.hpp"
#include "eigengrain/base/text.hpp"

#include "placed_balls.hpp"
#include "random_place.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <numeric>
#include <optional>
#include <vector>

namespace eigengrain::generate {
namespace {

std::vector<std::size_t> largest_first(std::span<const double> radii) {
  std::vector<std::size_t> order(radii.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::stable_sort(order.begin(), order.end(),
                   [&](std::size_t a, std::size_t b) { return radii[a] > radii[b]; });
  return order;
}

std::optional<Vec3> free_place(const PlacedBalls& placed, const Region& region, double radius, int attempts,
                               Random& random) {
  for (int k = 0; k < attempts; ++k) {
    const Vec3 x = random_place(region, radius, random);
    if (placed.fits(x, radius)) return x;
  }
  return std::nullopt;
}

}  // namespace

Balls fill_at_random(std::span<const double> radii, const Region& region, Random& random, int attempts) {
  const std::vector<std::size_t> order = largest_first(radii);
  if (!order.empty()) {
    require_room(radii[order.front()], region);
    require_room_for_image(radii[order.front()], region);
  }
  Balls balls{.position = std::vector<Vec3>(radii.size()), .radius = {radii.begin(), radii.end()}};
  PlacedBalls placed(region);
  double class_least = std::numeric_limits<double>::infinity();
  std::vector<double> done;
  done.reserve(radii.size());
  for (std::size_t rank = 0; rank < order.size(); ++rank) {
    const double radius = radii[order[rank]];
    if (radius < class_least) {
      class_least = radius / 2;
      const auto end = std::partition_point(order.begin(), order.end(),
                                            [&](std::size_t i) { return radii[i] >= class_least; });
      placed.begin_class(radius, (end - order.begin()) - static_cast<std::int64_t>(rank));
    }
    const auto place = free_place(placed, region, radius, attempts, random);
    if (!place)
      throw InputError(fmt::format(
          "ball {} of {} found no free place in {} attempts, at a solid fraction of {:.4f} of the {:.4f} "
          "wanted; "
          "equal balls placed at random do not get beyond 0.38: lower the fraction, or take \"fill: dense\"",
          grouped(static_cast<std::int64_t>(rank) + 1), grouped(static_cast<std::int64_t>(order.size())),
          grouped(attempts), solid_fraction(done, region), solid_fraction(radii, region)));
    placed.add(*place, radius);
    balls.position[order[rank]] = *place;
    done.push_back(radius);
  }
  return balls;
}

}  // namespace eigengrain::generate
