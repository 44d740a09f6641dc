#include "eigengrain/generate/dense_packing.hpp"

#include "eigengrain/base/parallel.hpp"
#include "eigengrain/generate/sizes.hpp"

#include "generate/support.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

namespace eigengrain::generate {
namespace {

using testing::HasSubstr;

DensePacking packed(int n, const Region& region, std::uint64_t seed = 1) {
  Random random(seed);
  return pack_densely(std::vector<double>(static_cast<std::size_t>(n), 1.0), region, random);
}

/// A periodic cube in which n balls of radius 1 make the fraction.
Region cube_for(int n, double fraction) {
  return cell(Vec3::Constant(std::cbrt(n * 4.18879020478639098 / fraction)));
}

/// What a packing in a periodic cell is like, computed pair by pair.
struct Mechanics {
  double mean = 0;       ///< relative overlap
  double largest = 0;    ///< relative overlap
  double force = 0;      ///< root of the mean square on a ball, over the mean force in a contact
  double isostatic = 0;  ///< contacts a ball, without those that have less than four
};

Mechanics mechanics_of(const Balls& balls, const Region& region) {
  Mechanics result;
  std::vector<Vec3> force(balls.radius.size(), Vec3::Zero());
  std::vector<int> contacts(balls.radius.size(), 0);
  double sum = 0;
  int count = 0;
  for (const search::CandidatePair& pair :
       search::candidate_pairs(balls.position, balls.radius, region.cell())) {
    const Vec3 d = balls.position[pair.b] + region.cell().shift(pair.image) - balls.position[pair.a];
    const double reach = balls.radius[pair.a] + balls.radius[pair.b];
    const double overlap = reach - d.norm();
    if (overlap <= 0) continue;
    force[pair.a] -= overlap * d.normalized();
    force[pair.b] += overlap * d.normalized();
    ++contacts[pair.a];
    ++contacts[pair.b];
    ++count;
    sum += overlap;
    result.mean += overlap / reach;
    result.largest = std::max(result.largest, overlap / reach);
  }
  double square = 0;
  for (const Vec3& f : force) square += f.squaredNorm();
  result.mean /= count;
  result.force = std::sqrt(square / static_cast<double>(force.size())) / (sum / count);
  const auto held = std::count_if(contacts.begin(), contacts.end(), [](int c) { return c >= 4; });
  for (const int c : contacts)
    result.isostatic += c >= 4 ? static_cast<double>(c) / static_cast<double>(held) : 0;
  return result;
}

TEST(DensePacking, BelowJammingNothingOverlaps) {
  for (const double fraction : {0.4, 0.55, 0.6}) {
    const Region region = cube_for(1000, fraction);
    const DensePacking packing = packed(1000, region);
    EXPECT_TRUE(packing.at_rest);
    EXPECT_NEAR(packing.fraction, fraction, 1e-12);
    EXPECT_EQ(packing.largest_overlap, 0);
    EXPECT_EQ(packing.balls.radius, std::vector<double>(1000, 1.0));
    EXPECT_TRUE(all_inside(packing.balls, region, 0));
    // Wrapping a centre into the cell of 30 m rounds it by some 1e-15 m; the hair left is 1e-8 m wide.
    EXPECT_GE(neighbours_of(packing.balls, region, 0.1).least_gap, 0);
  }
}

TEST(DensePacking, BeyondJammingItIsInEquilibrium) {
  const Region region = cube_for(1000, 0.67);
  const DensePacking packing = packed(1000, region);
  EXPECT_TRUE(packing.at_rest);
  EXPECT_NEAR(packing.fraction, 0.67, 1e-12);
  const Mechanics known = mechanics_of(packing.balls, region);
  EXPECT_LT(known.force, 1.001e-6);
  EXPECT_NEAR(packing.mean_overlap, known.mean, 1e-12);
  EXPECT_NEAR(packing.largest_overlap, known.largest, 1e-12);
  EXPECT_GT(packing.coordination, 6);
}

TEST(DensePacking, ReachesTheMeanOverlapAndIsNearlyIsostatic) {
  for (const double wanted : {1e-2, 1e-4}) {
    Random random(5);
    const Region region = cube_for(500, 0.64);
    const DensePacking packing = pack_to_overlap(std::vector<double>(500, 1.0), region, wanted, random);
    const Mechanics known = mechanics_of(packing.balls, region);
    EXPECT_NEAR(known.mean, wanted, 0.01 * wanted);
    EXPECT_LT(known.force, 1.001e-6);
    EXPECT_NEAR(packing.scale, 1, 0.03);
    EXPECT_EQ(packing.balls.radius.front(), packing.scale);
    // n balls that hold each other have 3(n - 1) contacts and one more for a state of self-stress (Maxwell),
    // 6 - 4/n a ball; Δφ beyond jamming 7.7 Δφ^0.5 more (O'Hern et al. 2003, table I), where Δφ is about
    // 3 · 0.64 of the overlap. Which balls are held is judged by their contacts: hence the factor 1.5.
    if (wanted == 1e-4) {
      EXPECT_GT(known.isostatic, 5.99);
      EXPECT_LT(known.isostatic, 6 + 1.5 * 7.7 * std::sqrt(3 * 0.64 * wanted));
    }
  }
}

TEST(DensePacking, HasFacesWhereTheRegionDoesNotRepeat) {
  const Region region{.lower = {-1, 0, 2}, .upper = {19, 20, 22}, .periodic = {false, true, false}};
  const DensePacking packing = packed(1000, region);  // 4189 of 8000 m³
  EXPECT_TRUE(packing.at_rest);
  EXPECT_EQ(packing.largest_overlap, 0);
  EXPECT_TRUE(all_inside(packing.balls, region, 0));
  EXPECT_GE(neighbours_of(packing.balls, region, 0.1).least_gap, 0);
}

TEST(DensePacking, TakesManySizes) {
  const Region region = cell({40, 40, 40});
  Random random(2);
  const SizeSampler sampler(PowerLawSizes{.exponent = -3, .least = 1, .most = 6});
  std::vector<double> radii = draw_radii(sampler, 0.6 * region.volume(), random);
  const std::size_t count = radii.size();
  const DensePacking packing = pack_densely(radii, region, random);
  EXPECT_TRUE(packing.at_rest);
  EXPECT_EQ(packing.largest_overlap, 0);
  std::vector<double> back = packing.balls.radius;
  std::sort(back.begin(), back.end());
  std::sort(radii.begin(), radii.end());
  ASSERT_EQ(back.size(), count);
  EXPECT_EQ(back, radii);
  EXPECT_GE(neighbours_of(packing.balls, region, 0.1).least_gap, 0);
}

TEST(DensePacking, IsTheSameToTheBitOnAnyNumberOfThreads) {
  const Region region = cube_for(10000, 0.5);  // three chunks of balls
  std::vector<std::vector<Vec3>> results;
  for (const int count : {1, 2, 4}) {
    set_threads(count);
    results.push_back(packed(10000, region).balls.position);
  }
  set_threads(0);
  EXPECT_EQ(results[1], results[0]);
  EXPECT_EQ(results[2], results[0]);
  EXPECT_NE(packed(10000, region, 2).balls.position, results[0]);
}

TEST(DensePacking, RefusesWhatIsNoPacking) {
  EXPECT_THAT(refusal([] { packed(200, cube_for(200, 0.95)); }),
              HasSubstr("at a solid fraction of 0.9500 balls overlap by up to 0."));
  EXPECT_THAT(refusal([] { packed(1, cell({1.9, 5, 5})); }), HasSubstr("overlaps its own image"));
}

}  // namespace
}  // namespace eigengrain::generate
