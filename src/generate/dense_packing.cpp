#include "eigengrain/generate/dense_packing.hpp"

#include "eigengrain/base/error.hpp"

#include "overlap_minimiser.hpp"
#include "random_place.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <numeric>
#include <utility>

namespace eigengrain::generate {
namespace {

using End = OverlapMinimiser::End;

constexpr std::int64_t most_iterations = 20'000;
constexpr double balanced = 1e-6;
/// Overlaps beyond this are no packing.
constexpr double largest_accepted = 0.1;

void require_room_for_all(std::span<const double> radii, const Region& region) {
  const double largest = *std::max_element(radii.begin(), radii.end());
  require_room(largest, region);
  require_room_for_image(largest, region);
}

/// Neighbours in space near each other in memory: rows of cells of the mean diameter.
std::vector<std::size_t> rows_of_cells(std::span<const Vec3> centres, const Region& region, double edge) {
  std::vector<std::array<double, 3>> keys;
  keys.reserve(centres.size());
  for (const Vec3& x : centres) {
    const Vec3 cell = ((x - region.lower) / edge).array().floor();
    keys.push_back({cell.z(), cell.y(), cell.x()});
  }
  std::vector<std::size_t> order(centres.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::stable_sort(order.begin(), order.end(),
                   [&](std::size_t a, std::size_t b) { return keys[a] < keys[b]; });
  return order;
}

OverlapMinimiser random_start(std::span<const double> radii, const Region& region, Random& random) {
  std::vector<Vec3> places;
  places.reserve(radii.size());
  for (const double r : radii) places.push_back(random_place(region, r, random));
  const double mean = std::accumulate(radii.begin(), radii.end(), 0.0) / static_cast<double>(radii.size());
  std::vector<Vec3> centres;
  std::vector<double> sorted_radii;
  centres.reserve(radii.size());
  sorted_radii.reserve(radii.size());
  for (const std::size_t i : rows_of_cells(places, region, 2 * mean)) {
    centres.push_back(places[i]);
    sorted_radii.push_back(radii[i]);
  }
  return {std::move(centres), std::move(sorted_radii), region};
}

DensePacking packing_of(OverlapMinimiser& minimiser, const Region& region, double scale, bool at_rest) {
  const Overlaps overlaps = minimiser.measure();
  DensePacking packing;
  const model::PeriodicCell cell = region.cell();
  for (const Vec3& x : minimiser.centres()) packing.balls.position.push_back(cell.wrapped(x));
  packing.balls.radius.assign(minimiser.radii().begin(), minimiser.radii().end());
  packing.fraction = solid_fraction(packing.balls.radius, region);
  packing.largest_overlap = overlaps.largest;
  packing.mean_overlap = overlaps.contacts > 0 ? overlaps.relative_sum / overlaps.contacts : 0;
  // Each contact of two balls is one of both.
  packing.coordination = overlaps.ends / static_cast<double>(packing.balls.radius.size());
  packing.scale = scale;
  packing.iterations = minimiser.iterations();
  packing.at_rest = at_rest;
  return packing;
}

void require_packing(const DensePacking& packing) {
  if (packing.largest_overlap <= largest_accepted) return;
  throw InputError(fmt::format(
      "at a solid fraction of {:.4f} balls overlap by up to {:.3f} of their diameter; equal balls jam near "
      "0.64, in a region a few balls wide earlier: lower the fraction",
      packing.fraction, packing.largest_overlap));
}

/// Searches the factor of the radii that gives the mean overlap wanted. Compression adds a little less to the
/// overlap than to the radii, so that stepping by what is missing gets there from one side. It begins well
/// beyond jamming: packings that come from there hardly rearrange, where those that are just about to jam do
/// so slowly and often.
class ScaleSearch {
 public:
  explicit ScaleSearch(double wanted) : wanted_(wanted), scale_(1.01 + 2 * wanted) {}

  double scale() const { return scale_; }
  /// Steps on, after the mean overlap that the present factor has given; 0: nothing holds the balls.
  void step(double overlap) {
    if (overlap > 0)
      step_ = wanted_ - overlap;
    else  // too far back, or not yet far enough
      step_ = step_ < 0 ? -step_ / 2 : std::max(2 * step_, wanted_);
    scale_ *= 1 + step_;
  }

 private:
  double wanted_;
  double scale_;
  double step_ = 0;  ///< relative, the last one
};

}  // namespace

DensePacking pack_densely(std::vector<double> radii, const Region& region, Random& random) {
  require_room_for_all(radii, region);
  OverlapMinimiser minimiser = random_start(radii, region, random);
  // Balls a hair larger are moved until they overlap by no more than that hair: the real ones do not overlap
  // at all.
  constexpr double hair = 1e-6;
  minimiser.set_scale(1 + 1.01 * hair);
  End end = minimiser.minimise(hair, balanced, most_iterations);
  minimiser.set_scale(1);
  // Jammed: equilibrium of the real balls.
  if (end == End::balanced) end = minimiser.minimise(0, balanced, most_iterations);
  DensePacking packing = packing_of(minimiser, region, 1, end != End::tired);
  require_packing(packing);
  return packing;
}

DensePacking pack_to_overlap(std::vector<double> radii, const Region& region, double mean_overlap,
                             Random& random) {
  constexpr double tolerance = 0.01;
  constexpr int most_rounds = 60;
  require_room_for_all(radii, region);
  OverlapMinimiser minimiser = random_start(radii, region, random);
  ScaleSearch search(mean_overlap);
  // Nothing overlaps but for a thousandth of what is wanted: not jammed.
  const double apart = 1e-3 * mean_overlap;
  const auto reached = [&](End end) {
    const Overlaps overlaps = minimiser.measure();
    return end == End::apart ? 0 : overlaps.relative_sum / overlaps.contacts;
  };
  const auto near = [&](double overlap, double part) {
    return std::abs(overlap - mean_overlap) <= part * tolerance * mean_overlap;
  };
  for (int round = 0; round < most_rounds; ++round) {
    minimiser.set_scale(search.scale());
    // Most equilibria are only looked at and need not be good ones.
    double overlap = reached(minimiser.minimise(apart, 1e-3, most_iterations));
    if (near(overlap, 0.5)) {
      const End end = minimiser.minimise(apart, balanced, most_iterations);
      overlap = reached(end);
      if (near(overlap, 1) && end == End::balanced) {
        DensePacking packing = packing_of(minimiser, region, search.scale(), true);
        require_packing(packing);
        return packing;
      }
    }
    search.step(overlap);
  }
  throw InputError(
      fmt::format("no packing with a mean overlap of {} was found in {} equilibria; ask for a larger "
                  "overlap, or for more balls",
                  mean_overlap, most_rounds));
}

}  // namespace eigengrain::generate
