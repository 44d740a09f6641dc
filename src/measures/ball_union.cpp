#include "eigengrain/measures/ball_union.hpp"

#include "ball_slice.hpp"
#include "gauss_rule.hpp"

#include <Eigen/Eigenvalues>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <vector>

namespace eigengrain::measures {
namespace {

struct Ball {
  Vec3 centre;
  double radius;
};

/// Without those inside others, which change nothing.
std::vector<Ball> outer_balls(const std::vector<Ball>& balls) {
  std::vector<Ball> result;
  for (std::size_t i = 0; i < balls.size(); ++i) {
    bool inside = false;
    for (std::size_t j = 0; j < balls.size() && !inside; ++j) {
      if (i == j) continue;
      const double room = balls[j].radius - balls[i].radius - (balls[j].centre - balls[i].centre).norm();
      inside = room > 0 || (room == 0 && (balls[j].radius > balls[i].radius || j < i));
    }
    if (!inside) result.push_back(balls[i]);
  }
  return result;
}

/// The circle in which two spheres meet.
struct Circle {
  bool exists = false;
  Vec3 centre;
  Vec3 axis;
  double radius = 0;
};

Circle meeting_of(const Ball& a, const Ball& b) {
  const Vec3 branch = b.centre - a.centre;
  const double d = branch.norm();
  if (d == 0 || d >= a.radius + b.radius) return {};
  const double along = (d * d + a.radius * a.radius - b.radius * b.radius) / (2 * d);
  const double square = a.radius * a.radius - along * along;
  if (!(square > 0)) return {};
  const Vec3 axis = branch / d;
  return {true, a.centre + along * axis, axis, std::sqrt(square)};
}

/// Adds the x of the points in which a circle meets a sphere.
void add_triple_points(const Circle& circle, const Ball& ball, std::vector<double>& places) {
  // c + r (cos t e1 + sin t e2), |.| = R from the ball: A cos t + B sin t = C
  const Vec3 e1 = circle.axis.unitOrthogonal();
  const Vec3 e2 = circle.axis.cross(e1);
  const Vec3 from = circle.centre - ball.centre;
  const double a = 2 * circle.radius * from.dot(e1);
  const double b = 2 * circle.radius * from.dot(e2);
  const double c = ball.radius * ball.radius - from.squaredNorm() - circle.radius * circle.radius;
  const double length = std::hypot(a, b);
  if (!(length > 0) || std::abs(c) > length) return;
  const double middle = std::atan2(b, a);
  const double half = std::acos(c / length);
  for (const double t : {middle - half, middle + half})
    places.push_back(circle.centre.x() + circle.radius * (std::cos(t) * e1.x() + std::sin(t) * e2.x()));
}

/// Where slices change their pattern, increasing.
std::vector<double> changes(const std::vector<Ball>& balls) {
  std::vector<double> places;
  for (std::size_t i = 0; i < balls.size(); ++i) {
    places.push_back(balls[i].centre.x() - balls[i].radius);
    places.push_back(balls[i].centre.x() + balls[i].radius);
    for (std::size_t j = i + 1; j < balls.size(); ++j) {
      const Circle circle = meeting_of(balls[i], balls[j]);
      if (!circle.exists) continue;
      const double reach = circle.radius * std::hypot(circle.axis.y(), circle.axis.z());
      places.push_back(circle.centre.x() - reach);
      places.push_back(circle.centre.x() + reach);
      for (std::size_t k = j + 1; k < balls.size(); ++k)
        if (meeting_of(balls[i], balls[k]).exists && meeting_of(balls[j], balls[k]).exists)
          add_triple_points(circle, balls[k], places);
    }
  }
  std::sort(places.begin(), places.end());
  return places;
}

/// ∫ dV and ∫ of x, y, z, xx, xy, xz, yy, yz, zz.
using Moments = Eigen::Matrix<double, 10, 1>;

Moments slice_at(const std::vector<Ball>& balls, double x, std::vector<Disc>& discs) {
  discs.clear();
  for (const Ball& ball : balls) {
    const double from = x - ball.centre.x();
    const double square = ball.radius * ball.radius - from * from;
    if (square > 0) discs.push_back({ball.centre.y(), ball.centre.z(), std::sqrt(square)});
  }
  const SliceMoments s = slice_moments(discs);
  Moments m;
  m << s.area, x * s.area, s.y, s.z, x * x * s.area, x * s.y, x * s.z, s.yy, s.yz, s.zz;
  return m;
}

Moments integrate(const std::vector<Ball>& balls, const std::vector<double>& places, int points) {
  const GaussRule rule(points);
  std::vector<Disc> discs;
  Moments sum = Moments::Zero();
  for (std::size_t k = 0; k + 1 < places.size(); ++k) {
    const double middle = 0.5 * (places[k] + places[k + 1]);
    const double half = 0.5 * (places[k + 1] - places[k]);
    if (!(half > 1e-15)) continue;
    for (int p = 0; p < points; ++p) {
      const double angle = 0.5 * std::numbers::pi * (1 + rule.place[static_cast<std::size_t>(p)]);
      const double weight = 0.5 * std::numbers::pi * rule.weight[static_cast<std::size_t>(p)];
      sum += weight * half * std::sin(angle) * slice_at(balls, middle - half * std::cos(angle), discs);
    }
  }
  return sum;
}

}  // namespace

BallUnion ball_union(std::span<const Vec3> centres, std::span<const double> radii) {
  if (centres.empty()) return {};
  // In units of the size and about a point within: numbers of order one.
  Vec3 origin = Vec3::Zero();
  for (const Vec3& x : centres) origin += x / static_cast<double>(centres.size());
  double size = 0;
  for (std::size_t i = 0; i < centres.size(); ++i)
    size = std::max(size, (centres[i] - origin).norm() + radii[i]);
  std::vector<Ball> balls;
  for (std::size_t i = 0; i < centres.size(); ++i)
    balls.push_back({(centres[i] - origin) / size, radii[i] / size});
  balls = outer_balls(balls);

  constexpr double enough = 1e-13;
  constexpr int most_points = 256;
  const std::vector<double> places = changes(balls);
  int points = 16;
  Moments m = integrate(balls, places, points);
  double change = 1;
  while (change > enough && points < most_points) {
    points *= 2;
    const Moments finer = integrate(balls, places, points);
    change = (finer - m).cwiseAbs().maxCoeff() / finer[0];
    m = finer;
  }

  const double volume = m[0];
  const Vec3 centre = m.segment<3>(1) / volume;
  Mat3 second;
  second << m[4], m[5], m[6], m[5], m[7], m[8], m[6], m[8], m[9];
  second -= volume * centre * centre.transpose();
  BallUnion result;
  result.volume = volume * size * size * size;
  result.centre = origin + size * centre;
  result.inertia = std::pow(size, 5) * (second.trace() * Mat3::Identity() - second);
  // Sums of some hundred terms with signs.
  result.error = change + 100 * std::numeric_limits<double>::epsilon();
  return result;
}

PrincipalAxes principal_axes(const Mat3& inertia, double same) {
  const Eigen::SelfAdjointEigenSolver<Mat3> solver(inertia);
  PrincipalAxes result{solver.eigenvalues(), Quat::Identity()};
  Vec3& moment = result.inertia;
  const double tolerance = same * moment[2];
  if (moment[2] - moment[0] <= tolerance) {
    moment.setConstant(moment.mean());
    return result;
  }
  if (moment[1] - moment[0] <= tolerance)
    moment[0] = moment[1] = 0.5 * (moment[0] + moment[1]);
  else if (moment[2] - moment[1] <= tolerance)
    moment[1] = moment[2] = 0.5 * (moment[1] + moment[2]);
  Mat3 axes = solver.eigenvectors();
  if (axes.determinant() < 0) axes.col(2) = -axes.col(2);
  result.orientation = Quat(axes).normalized();
  return result;
}

}  // namespace eigengrain::measures
