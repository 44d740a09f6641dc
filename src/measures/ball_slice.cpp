#include "ball_slice.hpp"

#include "gauss_rule.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>
#include <vector>

namespace eigengrain::measures {
namespace {

constexpr double full = 2 * std::numbers::pi;

/// Angles from first to second.
using Interval = std::pair<double, double>;

/// What other discs cover of the edge of a disc, as intervals within [0, 2π]; false if they cover all of it.
bool covered_parts(std::span<const Disc> discs, std::size_t mine, std::vector<Interval>& parts) {
  parts.clear();
  const Disc& disc = discs[mine];
  for (std::size_t j = 0; j < discs.size(); ++j) {
    if (j == mine) continue;
    const double dy = discs[j].y - disc.y;
    const double dz = discs[j].z - disc.z;
    const double d = std::hypot(dy, dz);
    const double other = discs[j].radius;
    if (d >= disc.radius + other) continue;
    // Of equal discs in one place the first has the edge.
    if (d + disc.radius <= other && (d + disc.radius < other || d > 0 || j < mine)) return false;
    if (d + other <= disc.radius) continue;
    const double cosine = (d * d + disc.radius * disc.radius - other * other) / (2 * d * disc.radius);
    const double half = std::acos(std::clamp(cosine, -1.0, 1.0));
    double low = std::atan2(dz, dy) - half;
    if (low < 0) low += full;
    const double high = low + 2 * half;
    if (high <= full) {
      parts.emplace_back(low, high);
    } else {
      parts.emplace_back(low, full);
      parts.emplace_back(0.0, high - full);
    }
  }
  std::sort(parts.begin(), parts.end());
  return true;
}

/// Adds the integrals along an arc. The integrands are polynomials of sine and cosine of degree four: on a
/// quarter of a circle twelve points of Gauss's rule have them to rounding.
void add_arc(const Disc& disc, double from, double to, SliceMoments& sum) {
  static const GaussRule rule(12);
  const int pieces = std::max(1, static_cast<int>(std::ceil((to - from) / (0.5 * std::numbers::pi))));
  const double half = 0.5 * (to - from) / pieces;
  for (int piece = 0; piece < pieces; ++piece) {
    const double middle = from + (2 * piece + 1) * half;
    for (std::size_t p = 0; p < rule.place.size(); ++p) {
      const double t = middle + half * rule.place[p];
      const double y = disc.y + disc.radius * std::cos(t);
      const double z = disc.z + disc.radius * std::sin(t);
      const double dz = half * rule.weight[p] * disc.radius * std::cos(t);
      sum.area += y * dz;
      sum.y += 0.5 * y * y * dz;
      sum.z += y * z * dz;
      sum.yy += y * y * y / 3 * dz;
      sum.yz += 0.5 * y * y * z * dz;
      sum.zz += y * z * z * dz;
    }
  }
}

}  // namespace

SliceMoments slice_moments(std::span<const Disc> discs) {
  SliceMoments sum;
  std::vector<Interval> parts;
  for (std::size_t i = 0; i < discs.size(); ++i) {
    if (!covered_parts(discs, i, parts)) continue;
    double end = 0;  // of what is covered so far
    for (const auto& [low, high] : parts) {
      if (low > end) add_arc(discs[i], end, low, sum);
      end = std::max(end, high);
    }
    if (end < full) add_arc(discs[i], end, full, sum);
  }
  return sum;
}

}  // namespace eigengrain::measures
