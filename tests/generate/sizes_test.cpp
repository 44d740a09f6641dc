#include "eigengrain/generate/sizes.hpp"

#include "eigengrain/model/bodies.hpp"

#include "generate/elementary.hpp"
#include "generate/support.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <numbers>

namespace eigengrain::generate {
namespace {

using testing::HasSubstr;

constexpr double infinity = std::numeric_limits<double>::infinity();

/// Mean and variance of a distribution, or of what was drawn from it.
struct Moments {
  double mean = 0;
  double variance = 0;
};

double density(double z) {
  return std::exp(-z * z / 2) / std::sqrt(2 * std::numbers::pi);
}
double below(double z) {
  return std::erfc(-z / std::numbers::sqrt2) / 2;
}

Moments from_raw(double first, double second) {
  return {first, second - first * first};
}

/// Of a Gaussian cut to [least, most] (Johnson, Kotz & Balakrishnan, Continuous Univariate Distributions
/// 1, 13.10).
Moments of_normal(double mean, double deviation, double least, double most) {
  const double a = (least - mean) / deviation;
  const double b = (most - mean) / deviation;
  const double share = below(b) - below(a);
  const double shift = (density(a) - density(b)) / share;
  return {mean + deviation * shift,
          deviation * deviation * (1 + (a * density(a) - b * density(b)) / share - shift * shift)};
}

/// E r^k of a lognormal of log-mean m and log-deviation s, cut: e^(km + k²s²/2) times a ratio of shares.
Moments of_lognormal(double mean, double deviation, double least, double most) {
  const double s = std::sqrt(std::log(1 + deviation * deviation / (mean * mean)));
  const double m = std::log(mean) - s * s / 2;
  const auto raw = [&](double k) {
    const double a = (std::log(least) - m) / s;
    const double b = (std::log(most) - m) / s;
    return std::exp(k * m + k * k * s * s / 2) * (below(b - k * s) - below(a - k * s)) /
           (below(b) - below(a));
  };
  return from_raw(raw(1), raw(2));
}

/// ∫ r^e dr from a to b.
double integral(double e, double a, double b) {
  return e == -1 ? std::log(b / a) : (std::pow(b, e + 1) - std::pow(a, e + 1)) / (e + 1);
}

Moments of_power(double e, double a, double b) {
  const double all = integral(e, a, b);
  return from_raw(integral(e + 1, a, b) / all, integral(e + 2, a, b) / all);
}

/// The mean and variance of 200,000 radii agree with those known, to five standard errors (which chance alone
/// exceeds once in a million).
void expect_moments(const SizeDistribution& sizes, const Moments& known, double least, double most) {
  constexpr int n = 200'000;
  const SizeSampler sampler(sizes);
  Random random(7);
  std::vector<double> radii(n);
  double sum = 0;
  for (double& r : radii) {
    r = sampler.draw(random);
    sum += r;
    ASSERT_GE(r, least);
    ASSERT_LE(r, most);
  }
  const double mean = sum / n;
  double second = 0;
  double fourth = 0;
  for (const double r : radii) {
    const double d2 = (r - mean) * (r - mean);
    second += d2 / n;
    fourth += d2 * d2 / n;
  }
  EXPECT_NEAR(mean, known.mean, 5 * std::sqrt(second / n));
  EXPECT_NEAR(second, known.variance, 5 * std::sqrt((fourth - second * second) / n));
}

TEST(Sizes, MomentsAreThoseOfTheDistribution) {
  expect_moments(UniformSizes{2, 5}, {3.5, 9.0 / 12}, 2, 5);
  expect_moments(NormalSizes{.mean = 5, .deviation = 0.5, .least = 3.5, .most = 6.5},
                 of_normal(5, 0.5, 3.5, 6.5), 3.5, 6.5);
  expect_moments(NormalSizes{.mean = 5, .deviation = 2, .least = 6, .most = 7}, of_normal(5, 2, 6, 7), 6, 7);
  expect_moments(LognormalSizes{.mean = 3, .deviation = 1}, {3, 1}, 0, infinity);
  expect_moments(LognormalSizes{.mean = 3, .deviation = 1, .least = 2.5, .most = 4},
                 of_lognormal(3, 1, 2.5, 4), 2.5, 4);
  for (const double exponent : {-4.0, -3.0, -1.0, 0.0, 2.5})
    expect_moments(PowerLawSizes{exponent, 1, 4}, of_power(exponent, 1, 4), 1, 4);
}

TEST(Sizes, MomentsOfTablesByNumber) {
  // A quarter has r = 1, the rest lies evenly in [2, 4]: E r = 1/4 + 3/4 · 3, E r² = 1/4 + 3/4 · 28/3.
  const TableSizes sizes{.classes = {{1, 1, 1}, {2, 4, 3}}};
  expect_moments(sizes, from_raw(0.25 + 0.75 * 3, 0.25 + 0.75 * 28 / 3), 1, 4);
}

TEST(Sizes, MomentsOfTablesByMass) {
  // Even in mass means numbers like r^-3; two radii of equal mass are as many as 1/r³.
  expect_moments(TableSizes{.classes = {{1, 3, 1}}, .by_mass = true}, of_power(-3, 1, 3), 1, 3);
  const double small = 8.0 / 9;
  expect_moments(TableSizes{.classes = {{1, 1, 0.5}, {2, 2, 0.5}}, .by_mass = true},
                 from_raw(small + (1 - small) * 2, small + (1 - small) * 4), 1, 2);
}

TEST(Sizes, MassSharesOfATableComeOutAsMass) {
  const SizeSampler sampler(TableSizes{.classes = {{1, 2, 0.7}, {3, 3, 0.3}}, .by_mass = true});
  Random random(3);
  double all = 0;
  double large = 0;
  for (int k = 0; k < 200'000; ++k) {
    const double r = sampler.draw(random);
    all += r * r * r;
    if (r > 2) large += r * r * r;
  }
  // Some 3,400 of the balls are large: their number, hence their mass, scatters by 1/√3400 of itself, times
  // 0.7.
  EXPECT_NEAR(large / all, 0.3, 5 * 0.3 * 0.7 / std::sqrt(3400.0));
}

TEST(Sizes, SamplesAreTheSameOnEveryMachine) {
  // The 10,000th number of a default std::mt19937_64 (C++ standard, [rand.predef]).
  Random random(5489);
  double last = 0;
  for (int k = 0; k < 10'000; ++k) last = random.uniform();
  EXPECT_EQ(last, static_cast<double>(9981545732273789042ULL >> 11U) * 0x1p-53);
}

TEST(Sizes, ElementaryFunctionsAreAccurate) {
  constexpr double ulp = std::numeric_limits<double>::epsilon();
  for (double x = 1e-12; x < 1e12; x *= 1.0371)
    EXPECT_NEAR(elementary::log(x), std::log(x), 2 * ulp * std::abs(std::log(x))) << x;
  EXPECT_EQ(elementary::log(1), 0);
  for (double x = -50; x < 50; x += 0.0373) EXPECT_NEAR(elementary::exp(x) / std::exp(x), 1, 4 * ulp) << x;
  EXPECT_EQ(elementary::exp(0), 1);
  EXPECT_NEAR(elementary::pow(2, 10), 1024, 16 * 1024 * ulp);
}

TEST(Sizes, RadiiAreDrawnUpToTheVolumeAskedFor) {
  Random random(1);
  const SizeSampler equal(ConstantSize{0.5});
  const double sphere = model::sphere_mass(0.5, 1.0);
  EXPECT_EQ(draw_radii(equal, 100.4 * sphere, random), std::vector<double>(100, 0.5));
  EXPECT_EQ(draw_radii(equal, 100.6 * sphere, random).size(), 101U);
  EXPECT_THAT(refusal([&] { draw_radii(equal, 0.4 * sphere, random); }),
              HasSubstr("less than half of one ball"));
}

TEST(Sizes, RefusesAGaussianWithNearlyNothingWithinItsLimits) {
  EXPECT_THAT(refusal([] { SizeSampler(NormalSizes{.mean = 5, .deviation = 0.1, .least = 6, .most = 7}); }),
              HasSubstr("of the distribution lies between 6 and 7 m"));
  EXPECT_THAT(
      refusal([] { SizeSampler(LognormalSizes{.mean = 5, .deviation = 0.1, .least = 1, .most = 2}); }),
      HasSubstr("of the distribution lies between 1 and 2 m"));
}

}  // namespace
}  // namespace eigengrain::generate
