#include "eigengrain/measures/partial.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

namespace eigengrain::measures {
namespace {

using std::numbers::pi;

constexpr double unit_ball = 4 * pi / 3;

// What of the unit ball lies beyond one, two or three planes at right angles, x >= a, y >= b, z >= c. By the
// divergence theorem 3V is the area on the sphere less, for each plane, its distance times the area that is
// cut out of it; the area on the sphere follows from Gauss and Bonnet:
//
//   S = 2π - Σ exterior angles of the corners - Σ a φ_a
//
// φ_a being the angle that the arc on the circle x = a, of geodesic curvature a/√(1 - a²), spans. At the
// corner of x = a and y = b the exterior angle is that of (w, -ab), w = √(1 - a² - b²). All angles come from
// the same w, so that what its rounding does to them cancels where the corner is small.

double root(double square) {
  return std::sqrt(std::max(square, 0.0));
}

double beyond(double a) {
  if (a >= 1) return 0;
  if (a <= -1) return unit_ball;
  return pi / 3 * (1 - a) * (1 - a) * (2 + a);
}

double beyond(double a, double b) {
  if (a >= 1 || b >= 1) return 0;
  if (a <= -1) return beyond(b);
  if (b <= -1) return beyond(a);
  if (a < 0) return beyond(b) - beyond(-a, b);
  if (b < 0) return beyond(a) - beyond(a, -b);
  if (a * a + b * b >= 1) return 0;
  const double w = root(1 - a * a - b * b);
  const double arc_a = 2 * std::atan2(w, b);
  const double arc_b = 2 * std::atan2(w, a);
  const double sphere = 2 * pi - 2 * std::atan2(w, -a * b) - a * arc_a - b * arc_b;
  const double face_a = 0.5 * (1 - a * a) * arc_a - b * w;
  const double face_b = 0.5 * (1 - b * b) * arc_b - a * w;
  return (sphere - a * face_a - b * face_b) / 3;
}

/// On the disk x = a: the angle of its arc with y >= b and z >= c, of which w_ab and w_ac are the ends.
double arc(double b, double c, double w_ab, double w_ac) {
  return std::atan2(w_ab, b) - std::atan2(c, w_ac);
}

/// The area that the arc and the lines y = b and z = c enclose on that disk.
double face(double a, double b, double c, double arc_a, double w_ab, double w_ac) {
  return 0.5 * ((1 - a * a) * arc_a - b * (w_ab - c) - c * (w_ac - b));
}

double beyond(double a, double b, double c) {
  if (a >= 1 || b >= 1 || c >= 1) return 0;
  if (a <= -1) return beyond(b, c);
  if (b <= -1) return beyond(a, c);
  if (c <= -1) return beyond(a, b);
  if (a < 0) return beyond(b, c) - beyond(-a, b, c);
  if (b < 0) return beyond(a, c) - beyond(a, -b, c);
  if (c < 0) return beyond(a, b) - beyond(a, b, -c);
  if (a * a + b * b + c * c >= 1) return 0;
  const double w_ab = root(1 - a * a - b * b);
  const double w_ac = root(1 - a * a - c * c);
  const double w_bc = root(1 - b * b - c * c);
  const double arc_a = arc(b, c, w_ab, w_ac);
  const double arc_b = arc(c, a, w_bc, w_ab);
  const double arc_c = arc(a, b, w_ac, w_bc);
  const double corners = std::atan2(w_ab, -a * b) + std::atan2(w_ac, -a * c) + std::atan2(w_bc, -b * c);
  const double sphere = 2 * pi - corners - a * arc_a - b * arc_b - c * arc_c;
  return (sphere - a * face(a, b, c, arc_a, w_ab, w_ac) - b * face(b, c, a, arc_b, w_bc, w_ab) -
          c * face(c, a, b, arc_c, w_ac, w_bc)) /
         3;
}

/// Between two planes across each axis: beyond the lower ones and not beyond the upper ones.
double between(const Vec3& low, const Vec3& high) {
  double volume = 0;
  for (int corner = 0; corner < 8; ++corner) {
    const auto at = [&](int k) { return ((corner >> k) & 1) != 0 ? high[k] : low[k]; };
    const bool odd = (((corner >> 2) ^ (corner >> 1) ^ corner) & 1) != 0;
    const double part = beyond(at(0), at(1), at(2));
    volume += odd ? -part : part;
  }
  return std::max(volume, 0.0);
}

double clipped(double from, double to) {
  return std::max(std::min(to, 1.0) - std::max(from, 0.0), 0.0);
}

}  // namespace

double ball_inside(const model::SphereRegion& sphere, const Vec3& centre, double r) {
  const double d = (centre - sphere.centre).norm();
  const double big = std::max(r, sphere.radius);
  const double small = std::min(r, sphere.radius);
  if (d >= big + small) return 0;
  if (d <= big - small) return unit_ball * small * small * small;
  const double depth = big + small - d;
  const double difference = big - small;
  return pi * depth * depth * (d * d + 2 * d * (big + small) - 3 * difference * difference) / (12 * d);
}

double ball_inside(const model::BoxRegion& box, const Vec3& centre, double r) {
  const Vec3 low = (box.min - centre) / r;
  const Vec3 high = (box.max - centre) / r;
  if ((low.array() >= 1).any() || (high.array() <= -1).any()) return 0;
  if ((low.array() <= -1).all() && (high.array() >= 1).all()) return unit_ball * r * r * r;
  return between(low, high) * r * r * r;
}

double line_inside(const model::SphereRegion& sphere, const Vec3& start, const Vec3& way) {
  // |start + t way - centre|² = R²
  const Vec3 from = start - sphere.centre;
  const double a = way.squaredNorm();
  const double b = from.dot(way);
  const double c = from.squaredNorm() - sphere.radius * sphere.radius;
  const double discriminant = b * b - a * c;
  if (!(discriminant > 0)) return 0;
  const double half = std::sqrt(discriminant);
  return clipped((-b - half) / a, (-b + half) / a);
}

double line_inside(const model::BoxRegion& box, const Vec3& start, const Vec3& way) {
  double from = 0;
  double to = 1;
  for (int k = 0; k < 3; ++k) {
    if (way[k] == 0) {
      if (!(start[k] >= box.min[k] && start[k] < box.max[k])) return 0;
      continue;
    }
    double enter = (box.min[k] - start[k]) / way[k];
    double leave = (box.max[k] - start[k]) / way[k];
    if (enter > leave) std::swap(enter, leave);
    from = std::max(from, enter);
    to = std::min(to, leave);
  }
  return clipped(from, to);
}

}  // namespace eigengrain::measures
