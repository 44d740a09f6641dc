#include "eigengrain/generate/random_fill.hpp"

#include "generate/support.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace eigengrain::generate {
namespace {

using testing::HasSubstr;

Balls filled(std::vector<double> radii, const Region& region, std::uint64_t seed = 1) {
  Random random(seed);
  return fill_at_random(radii, region, random);
}

/// A power of sizes between 1 and 8: many small ones, a few large ones, in no order.
std::vector<double> many_sizes(int n) {
  Random random(11);
  std::vector<double> radii;
  for (int k = 0; k < n; ++k) {
    const double u = random.uniform();
    radii.push_back(1 / (1 - 0.875 * u));
  }
  return radii;
}

TEST(RandomFill, BallsLieInsideAndDoNotOverlap) {
  for (const std::array<bool, 3> periodic :
       {std::array{false, false, false}, std::array{true, false, true}, std::array{true, true, true}}) {
    const Region region{.lower = {-3, 5, 0}, .upper = {77, 85, 60}, .periodic = periodic};
    const std::vector<double> radii = many_sizes(800);
    const Balls balls = filled(radii, region);
    EXPECT_EQ(balls.radius, radii);
    EXPECT_GT(solid_fraction(radii, region), 0.25);
    EXPECT_TRUE(all_inside(balls, region, 1e-12));
    // Squares are compared: rounding of coordinates below 100 m, some 1e-14 m.
    EXPECT_GE(neighbours_of(balls, region, 0).least_gap, -1e-13);
  }
}

TEST(RandomFill, SeesImagesInACellOfTheSizeOfItsBalls) {
  const Region region = cell({2.2, 2.2, 50});
  const Balls balls = filled(std::vector<double>(12, 1.0), region);
  EXPECT_GE(neighbours_of(balls, region, 0).least_gap, -1e-13);
}

TEST(RandomFill, DependsOnTheSeedOnly) {
  const Region region = cell({20, 20, 20});
  const std::vector<double> radii(500, 1.0);
  EXPECT_EQ(filled(radii, region).position, filled(radii, region).position);
  EXPECT_NE(filled(radii, region).position, filled(radii, region, 2).position);
}

TEST(RandomFill, GivesUpHonestly) {
  const Region region = cell({20, 20, 20});
  const std::string message = refusal([&] { filled(std::vector<double>(1000, 1.0), region); });
  EXPECT_THAT(message, testing::ContainsRegex(
                           "ball [0-9]+ of 1,000 found no free place in 20,000 attempts, at a solid "
                           "fraction of 0.3[3-8][0-9]+ of the 0.5236 wanted"));
  EXPECT_THAT(refusal([&] { filled({11}, region); }), HasSubstr("overlaps its own image"));
  EXPECT_THAT(refusal([&] {
                filled({11}, box({0, 0, 0}, {30, 30, 20}));
              }),
              HasSubstr("does not fit into the region, which is 20 m wide along z"));
}

}  // namespace
}  // namespace eigengrain::generate
