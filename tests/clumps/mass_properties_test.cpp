// Volume, centre and inertia of unions of balls, against closed forms.
#include "eigengrain/measures/ball_union.hpp"

#include "support/scenes.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <numbers>
#include <random>
#include <vector>

namespace eigengrain::test {
namespace {

using measures::ball_union;
using measures::BallUnion;
using std::numbers::pi;

/// Sums of some thousand terms of order one: what is asked for everywhere, and some ten times what is seen.
constexpr double rounding = 1e-13;

/// Relative to the size of the tensor.
double apart(const Mat3& a, const Mat3& b) {
  return (a - b).norm() / b.norm();
}

/// A body of revolution about x between `from` and `to`, whose radius squared is that of a ball of radius r
/// centred at c: volume, ∫x, ∫x² dV and ∫½ρ² dV. All are integrals of polynomials.
struct Zone {
  double volume = 0;
  double first = 0;
  double second = 0;
  double axial = 0;

  void add(double c, double r, double from, double to) {
    const auto power = [&](int n) { return (std::pow(to - c, n + 1) - std::pow(from - c, n + 1)) / (n + 1); };
    const double area0 = pi * (r * r * power(0) - power(2));  // ∫ρ² and with t = x - c
    const double area1 = pi * (r * r * power(1) - power(3));
    const double area2 = pi * (r * r * power(2) - power(4));
    volume += area0;
    first += c * area0 + area1;
    second += c * c * area0 + 2 * c * area1 + area2;
    axial += 0.5 * pi * (std::pow(r, 4) * power(0) - 2 * r * r * power(2) + power(4));
  }
};

/// The union of the same balls along an axis, anywhere in space.
void expect_revolution(const std::vector<double>& along, const std::vector<double>& radius,
                       const Zone& zone) {
  std::mt19937_64 random(3);
  const double centre = zone.first / zone.volume;
  const double polar = zone.axial;
  const double across = 0.5 * zone.axial + zone.second - zone.volume * centre * centre;
  for (int k = 0; k < 12; ++k) {
    Vec3 axis = random_vector(random).normalized();
    if (k < 3) axis = Vec3::Unit(k);  // along x all changes of the slices fall on one place
    const Vec3 origin = random_vector(random);
    std::vector<Vec3> balls;
    for (const double x : along) balls.emplace_back(origin + x * axis);
    const BallUnion found = ball_union(balls, radius);
    EXPECT_NEAR(found.volume / zone.volume, 1, rounding) << axis.transpose();
    EXPECT_LT((found.centre - origin - centre * axis).norm(), rounding * 4);
    const Mat3 along_axis = axis * axis.transpose();
    EXPECT_LT(apart(found.inertia, polar * along_axis + across * (Mat3::Identity() - along_axis)), rounding);
    EXPECT_LT(found.error, 1e-12);
  }
}

TEST(BallUnion, OfOneBallIsTheBall) {
  const std::vector<Vec3> at{{1, -2, 3}};
  const std::vector<double> radius{2};
  const BallUnion found = ball_union(at, radius);
  EXPECT_NEAR(found.volume / (4 * pi / 3 * 8), 1, rounding);
  EXPECT_LT((found.centre - at[0]).norm(), rounding);
  EXPECT_LT(apart(found.inertia, 8 * pi / 15 * 32 * Mat3::Identity()), rounding);
}

TEST(BallUnion, OfTwoOverlappingBallsLacksTheLens) {
  for (const double d : {0.1, 0.7, 1.0, 1.6, 1.99}) {
    Zone zone;
    zone.add(0, 1, -1, 0.5 * d);
    zone.add(d, 1, 0.5 * d, d + 1);
    // The lens of two unit balls (MathWorld, Sphere-Sphere Intersection) is what this zone lacks.
    EXPECT_NEAR(zone.volume, 8 * pi / 3 - pi * (4 + d) * (2 - d) * (2 - d) / 12, 1e-14);
    expect_revolution({0, d}, {1, 1}, zone);
  }
}

TEST(BallUnion, OfUnequalBalls) {
  // Radii 1 and 0.6 at a distance of 1.2: they meet in the plane (d² + 1 - 0.36)/2d.
  const double d = 1.2;
  const double plane = (d * d + 1 - 0.36) / (2 * d);
  Zone zone;
  zone.add(0, 1, -1, plane);
  zone.add(d, 0.6, plane, d + 0.6);
  expect_revolution({0, d}, {1, 0.6}, zone);
}

TEST(BallUnion, OfThreeInARowThatAllOverlap) {
  // At 0, 0.6 and 1.2 with radius one the outer two overlap as well; slices of the row are the largest disc.
  Zone zone;
  zone.add(0, 1, -1, 0.3);
  zone.add(0.6, 1, 0.3, 0.9);
  zone.add(1.2, 1, 0.9, 2.2);
  expect_revolution({0, 0.6, 1.2}, {1, 1, 1}, zone);
}

TEST(BallUnion, OfDisjointAndTouchingBallsIsTheirSum) {
  for (const double d : {2.0, 2.5, 7.0}) {
    Zone zone;
    zone.add(0, 1, -1, 1);
    zone.add(d, 1, d - 1, d + 1);
    expect_revolution({0, d}, {1, 1}, zone);
  }
}

TEST(BallUnion, CountsABallWithinAnotherNotAtAll) {
  const std::vector<Vec3> at{{0, 0, 0}, {0.3, 0.1, 0}, {0, 0, 0}, {0, 0.5, 0}};
  const std::vector<double> radius{1, 0.5, 1, 0.5};  // the last touches from within
  const BallUnion found = ball_union(at, radius);
  EXPECT_NEAR(found.volume / (4 * pi / 3), 1, rounding);
  EXPECT_LT(apart(found.inertia, 8 * pi / 15 * Mat3::Identity()), rounding);
}

/// A bent chain: 0 and 1 overlap, 1 and 2 overlap, 0 and 2 are apart; so the sum of the balls less two
/// lenses.
TEST(BallUnion, OfABentChainIsBallsLessLenses) {
  const double d = 1.5;
  const std::vector<Vec3> at{{0, d, 0}, {0, 0, 0}, {d * std::sin(2.0), d * std::cos(2.0), 0}};
  const std::vector<double> radius{1, 1, 1};
  Zone lens;
  lens.add(d, 1, d - 1, 0.5 * d);  // along its axis, from ball 1
  lens.add(0, 1, 0.5 * d, 1);
  const double ball = 4 * pi / 3;
  const double volume = 3 * ball - 2 * lens.volume;
  Vec3 first = Vec3::Zero();
  Mat3 second = Mat3::Zero();
  for (const Vec3& x : at) {
    first += ball * x;
    second += ball * (x * x.transpose() + 0.2 * Mat3::Identity());
  }
  for (const Vec3& end : {at[0], at[2]}) {
    const Vec3 e = end.normalized();
    first -= lens.first * e;
    // ∫½ρ² dV is that of one axis across twice: ∫y² = ½ of it
    second -= lens.second * e * e.transpose() + 0.5 * lens.axial * (Mat3::Identity() - e * e.transpose());
  }
  const Vec3 centre = first / volume;
  second -= volume * centre * centre.transpose();
  const BallUnion found = ball_union(at, radius);
  EXPECT_NEAR(found.volume / volume, 1, rounding);
  EXPECT_LT((found.centre - centre).norm(), rounding);
  EXPECT_LT(apart(found.inertia, second.trace() * Mat3::Identity() - second), rounding);
}

TEST(BallUnion, WhereThreeMeetIsFrameIndifferent) {
  // No closed form, but slices in another direction are other numbers altogether.
  std::mt19937_64 random(5);
  for (const int count : {3, 4, 12}) {
    std::vector<Vec3> at;
    std::vector<double> radius;
    std::uniform_real_distribution<double> size(0.6, 1.2);
    for (int i = 0; i < count; ++i) {
      at.emplace_back(0.6 * random_vector(random));
      radius.push_back(size(random));
    }
    const BallUnion first = ball_union(at, radius);
    for (int k = 0; k < 5; ++k) {
      const Mat3 q = random_rotation(random);
      std::vector<Vec3> turned;
      for (const Vec3& x : at) turned.emplace_back(q * x);
      const BallUnion second = ball_union(turned, radius);
      EXPECT_NEAR(second.volume / first.volume, 1, first.error + second.error);
      EXPECT_LT(apart(second.inertia, q * first.inertia * q.transpose()), first.error + second.error);
    }
  }
}

TEST(BallUnion, WhereThreeMeetAgreesWithACloudOfPoints) {
  const std::vector<Vec3> at{{0, 0, 0}, {1, 0, 0}, {0.4, 0.9, 0.2}};
  const std::vector<double> radius{1, 0.9, 0.8};
  const BallUnion found = ball_union(at, radius);
  // Midpoints of cells, oblique to the balls: of some 50,000 cells at the surface the parts in and out differ
  // at random, by 1e-4 of the volume.
  constexpr int n = 200;
  std::mt19937_64 random(9);
  const Mat3 oblique = random_rotation(random);
  double volume = 0;
  Mat3 second = Mat3::Zero();
  const double h = 4.0 / n;
  for (int i = 0; i < n; ++i)
    for (int j = 0; j < n; ++j)
      for (int k = 0; k < n; ++k) {
        const Vec3 x = found.centre + oblique * (Vec3::Constant(-2) + h * Vec3(i + 0.5, j + 0.5, k + 0.5));
        bool inside = false;
        for (std::size_t b = 0; b < at.size(); ++b)
          inside = inside || (x - at[b]).squaredNorm() < radius[b] * radius[b];
        if (!inside) continue;
        volume += h * h * h;
        const Vec3 s = x - found.centre;
        second += h * h * h * s * s.transpose();
      }
  EXPECT_NEAR(volume / found.volume, 1, 2e-4);
  EXPECT_LT(apart(found.inertia, second.trace() * Mat3::Identity() - second), 2e-4);
}

TEST(PrincipalAxes, DiagonaliseWithAProperRotation) {
  std::mt19937_64 random(7);
  for (int k = 0; k < 20; ++k) {
    const Mat3 q = random_rotation(random);
    const Mat3 tensor = q * Vec3(1, 2, 2.5).asDiagonal() * q.transpose();
    const measures::PrincipalAxes axes = measures::principal_axes(tensor);
    const Mat3 turn = axes.orientation.toRotationMatrix();
    EXPECT_LT((turn * axes.inertia.asDiagonal() * turn.transpose() - tensor).norm(), 1e-14);
    EXPECT_NEAR(turn.determinant(), 1, 1e-14);
  }
}

TEST(PrincipalAxes, OfABodyOfRevolutionAreEqualToTheBit) {
  const BallUnion two = ball_union(std::vector<Vec3>{{0, 0, 0}, {0.3, 0.4, 0.5}}, std::vector<double>{1, 1});
  const measures::PrincipalAxes axes = measures::principal_axes(two.inertia);
  EXPECT_EQ(axes.inertia[1], axes.inertia[2]);
  const BallUnion one = ball_union(std::vector<Vec3>{{0, 0, 0}}, std::vector<double>{1});
  const measures::PrincipalAxes ball = measures::principal_axes(one.inertia);
  EXPECT_EQ(ball.inertia[0], ball.inertia[2]);
  EXPECT_EQ(ball.orientation.coeffs(), Quat::Identity().coeffs());
}

}  // namespace
}  // namespace eigengrain::test
