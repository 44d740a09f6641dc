#include "eigengrain/generate/jittered_lattice.hpp"

#include "eigengrain/base/error.hpp"
#include "eigengrain/generate/lattice.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>

namespace eigengrain::generate {
namespace {

constexpr double jitter = 0.05;
constexpr double spread_of_radii = 0.1;
constexpr double spacing = 2.0;
constexpr std::int64_t balls_of_cell = 4;

/// Cells along x (and y), and along z.
struct Cells {
  std::int64_t across = 1;
  std::int64_t along = 1;
  std::int64_t balls() const { return balls_of_cell * across * across * along; }
};

Cells nearest_cells(std::int64_t balls) {
  Cells best{};
  for (const std::int64_t ratio : {1, 2}) {
    const double edge = std::cbrt(static_cast<double>(balls) / static_cast<double>(balls_of_cell * ratio));
    const std::int64_t across = std::max<std::int64_t>(1, std::llround(edge));
    const Cells cells{across, ratio * across};
    if (std::abs(cells.balls() - balls) < std::abs(best.balls() - balls)) best = cells;
  }
  return best;
}

}  // namespace

PeriodicBalls jittered_lattice(std::int64_t balls, Random& random) {
  if (balls < 1 || balls > most_balls)
    throw InputError(fmt::format("a lattice of {} balls; give a number from 1 to {}", balls, most_balls));
  const Lattice& lattice = *find_lattice("fcc");
  const Cells cells = nearest_cells(balls);
  PeriodicBalls result{
      .balls = {},
      .region = {.lower = Vec3::Zero(),
                 .upper = spacing * Vec3(static_cast<double>(cells.across) * lattice.cell.x(),
                                         static_cast<double>(cells.across) * lattice.cell.y(),
                                         static_cast<double>(cells.along) * lattice.cell.z()),
                 .periodic = {true, true, true}}};
  result.balls = fill_with_lattice(lattice, 0.5 * spacing, spacing, result.region);
  const auto symmetric = [&] { return 2 * random.uniform() - 1; };
  const model::PeriodicCell cell = result.region.cell();
  for (Vec3& x : result.balls.position) {
    const double dx = symmetric();  // one after the other: the order of arguments is not given
    const double dy = symmetric();
    const double dz = symmetric();
    x = cell.wrapped(x + jitter * Vec3(dx, dy, dz));
  }
  for (double& radius : result.balls.radius) radius *= 1 + spread_of_radii * symmetric();
  return result;
}

}  // namespace eigengrain::generate
