#include "report/axis.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <string>
#include <vector>

namespace eigengrain::report {
namespace {

std::vector<std::string> written(const Axis& axis) {
  std::vector<std::string> labels;
  for (const Tick& tick : axis.ticks())
    if (!tick.label.empty()) labels.push_back(tick.label);
  return labels;
}

using Labels = std::vector<std::string>;

TEST(Axis, LinearIsWidenedToRoundNumbers) {
  const Axis axis = Axis::linear(0.07, 0.93);
  EXPECT_DOUBLE_EQ(axis.low(), 0);
  EXPECT_DOUBLE_EQ(axis.high(), 1);
  EXPECT_EQ(written(axis), (Labels{"0", "0.2", "0.4", "0.6", "0.8", "1"}));
  EXPECT_DOUBLE_EQ(axis.place(0.25), 0.25);
}

TEST(Axis, LinearOfOneValueStillHasALength) {
  const Axis axis = Axis::linear(3, 3);
  EXPECT_GT(axis.high(), axis.low());
}

TEST(Axis, LogarithmicPutsEqualRatiosAtEqualDistances) {
  const Axis axis = Axis::logarithmic(1, 10000);
  EXPECT_DOUBLE_EQ(axis.place(1), 0);
  EXPECT_DOUBLE_EQ(axis.place(10), 0.25);
  EXPECT_DOUBLE_EQ(axis.place(10000), 1);
  EXPECT_EQ(written(axis), (Labels{"1", "10", "100", "1000", "10000"}));
}

TEST(Axis, LogarithmicOverLessThanADecadeWritesDigitsBetween) {
  EXPECT_EQ(written(Axis::logarithmic(0.21, 0.9)), (Labels{"0.2", "0.3", "0.5", "0.7", "1"}));
  EXPECT_EQ(written(Axis::logarithmic(2, 100)), (Labels{"2", "5", "10", "20", "50", "100"}));
}

TEST(Axis, LogarithmicOverManyDecadesWritesFew) {
  const Axis axis = Axis::logarithmic(1e-15, 1e3);
  EXPECT_LE(written(axis).size(), 8U);
  EXPECT_EQ(written(axis).front(), "10⁻¹⁵");
}

TEST(Axis, LogarithmicTakesWhatHasNoLogarithm) {
  for (const double low : {0.0, -1.0, std::numeric_limits<double>::quiet_NaN()}) {
    const Axis axis = Axis::logarithmic(low, 100);
    EXPECT_GT(axis.low(), 0) << low;
    EXPECT_GE(axis.place(0), 0) << low;
    EXPECT_TRUE(std::isfinite(axis.place(std::numeric_limits<double>::quiet_NaN()))) << low;
  }
}

TEST(Axis, LogarithmicWithMarginsKeepsTheEndsNear) {
  const Axis axis = Axis::logarithmic_with_margins(108, 10648);
  EXPECT_EQ(written(axis), (Labels{"100", "200", "500", "1000", "2000", "5000", "10000"}));
  EXPECT_NEAR(axis.place(108), 0.03 / 1.06, 1e-12);
  EXPECT_NEAR(axis.place(10648), 1.03 / 1.06, 1e-12);
  EXPECT_GT(Axis::logarithmic_with_margins(5, 5).high(), 5);
}

TEST(Axis, TicksAreInsideAndIncrease) {
  for (double low = 1e-9; low < 1e9; low *= 3.7)
    for (double length = 1.01; length < 1e12; length *= 5.3) {
      const Axis axis = Axis::logarithmic(low, low * length);
      ASSERT_LE(axis.low(), low * (1 + 1e-8));
      ASSERT_GE(axis.high(), low * length * (1 - 1e-8));
      ASSERT_FALSE(axis.ticks().empty());
      double before = 0;
      for (const Tick& tick : axis.ticks()) {
        ASSERT_GT(tick.value, before);
        ASSERT_GE(tick.value, axis.low() * (1 - 1e-8));
        ASSERT_LE(tick.value, axis.high() * (1 + 1e-8));
        before = tick.value;
      }
    }
}

TEST(Axis, SignedDistanceIsOddAboutZero) {
  const Axis axis = Axis::signed_distance(-1, 1, 1e-4);
  EXPECT_DOUBLE_EQ(axis.place(0), 0.5);
  for (const double value : {1e-6, 1e-4, 3e-3, 0.5})
    EXPECT_NEAR(axis.place(value) + axis.place(-value), 1, 1e-15) << value;
  // A decade is a decade, whether near the truth or far from it.
  EXPECT_NEAR(axis.place(1e-2) - axis.place(1e-3), axis.place(1) - axis.place(1e-1), 1e-15);
  EXPECT_EQ(written(axis), (Labels{"−100%", "−10%", "−1%", "−0.1%", "−0.01%", "0", "+0.01%", "+0.1%", "+1%",
                                   "+10%", "+100%"}));
}

TEST(Axis, SignedDistanceGoesAsFarAsTheData) {
  const Axis axis = Axis::signed_distance(-0.4, 0, 1e-3);
  EXPECT_DOUBLE_EQ(axis.low(), -1);
  EXPECT_DOUBLE_EQ(axis.high(), 1e-3);
}

TEST(NumberText, IsAsOneWrites) {
  EXPECT_EQ(number_text(0), "0");
  EXPECT_EQ(number_text(0.05), "0.05");
  EXPECT_EQ(number_text(12), "12");
  EXPECT_EQ(number_text(-1.5), "−1.5");
  EXPECT_EQ(number_text(1.5e-7), "1.5×10⁻⁷");
  EXPECT_EQ(number_text(1e6), "10⁶");
  EXPECT_EQ(number_text(82987), "83000");
  EXPECT_EQ(number_text(0.9999), "1");
  EXPECT_EQ(number_text(100), "100");
  EXPECT_EQ(number_text(std::numeric_limits<double>::infinity()), "∞");
}

}  // namespace
}  // namespace eigengrain::report
