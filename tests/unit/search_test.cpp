#include "eigengrain/base/error.hpp"
#include "eigengrain/base/parallel.hpp"
#include "eigengrain/search/candidates.hpp"

#include "search/pair_search.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>
#include <tuple>

namespace eigengrain::search {

// For the messages of gtest.
void PrintTo(const CandidatePair& p, std::ostream* out) {
  *out << "(" << p.a << ", " << p.b << ", [" << int{p.image[0]} << " " << int{p.image[1]} << " "
       << int{p.image[2]} << "])";
}

namespace {

using model::PeriodicCell;

struct Balls {
  std::vector<Vec3> centres;
  std::vector<double> radii;

  std::int32_t size() const { return static_cast<std::int32_t>(centres.size()); }
  void add(const Vec3& centre, double radius) {
    centres.push_back(centre);
    radii.push_back(radius);
  }
};

const PeriodicCell open_space{};

std::vector<CandidatePair> search(const Balls& balls, const PeriodicCell& cell = open_space,
                                  double reach = 0) {
  return candidate_pairs(balls.centres, balls.radii, cell, reach);
}

auto key(const CandidatePair& p) {
  return std::tuple(p.a, p.b, p.image);
}

/// Images worth a look along an axis: those that bring the distance along this axis within the limit,
/// and one more on either side.
std::pair<int, int> image_range(const PeriodicCell& cell, int axis, double branch, double limit) {
  if (!cell.periodic[static_cast<std::size_t>(axis)]) return {0, 0};
  const double length = cell.edges(axis, axis);
  return {static_cast<int>(std::floor((-limit - branch) / length)) - 1,
          static_cast<int>(std::ceil((limit - branch) / length)) + 1};
}

/// The definition in candidates.hpp, word for word, in O(n² x images).
std::vector<CandidatePair> all_pairs(const Balls& balls, const PeriodicCell& cell, double reach) {
  std::vector<CandidatePair> pairs;
  const auto test = [&](std::int32_t a, std::int32_t b, const model::Image& image) {
    if (a == b && image <= model::Image{}) return;
    const auto i = static_cast<std::size_t>(a);
    const auto j = static_cast<std::size_t>(b);
    const Vec3 branch = balls.centres[j] + cell.shift(image) - balls.centres[i];
    const double limit = balls.radii[i] + balls.radii[j] + reach;
    if (branch.squaredNorm() <= limit * limit) pairs.push_back({a, b, image});
  };
  for (std::int32_t a = 0; a < balls.size(); ++a) {
    for (std::int32_t b = a; b < balls.size(); ++b) {
      const auto i = static_cast<std::size_t>(a);
      const auto j = static_cast<std::size_t>(b);
      const Vec3 branch = balls.centres[j] - balls.centres[i];
      const double limit = balls.radii[i] + balls.radii[j] + reach;
      const auto [x0, x1] = image_range(cell, 0, branch.x(), limit);
      const auto [y0, y1] = image_range(cell, 1, branch.y(), limit);
      const auto [z0, z1] = image_range(cell, 2, branch.z(), limit);
      for (int x = x0; x <= x1; ++x)
        for (int y = y0; y <= y1; ++y)
          for (int z = z0; z <= z1; ++z)
            test(a, b,
                 {static_cast<std::int8_t>(x), static_cast<std::int8_t>(y), static_cast<std::int8_t>(z)});
    }
  }
  return pairs;
}

/// Compares with the definition, and returns the number of pairs.
std::size_t expect_exact(const Balls& balls, const PeriodicCell& cell = open_space, double reach = 0) {
  const std::vector<CandidatePair> expected = all_pairs(balls, cell, reach);
  const std::vector<CandidatePair> found = search(balls, cell, reach);
  // Not one matcher for all: its message would list many thousand pairs.
  EXPECT_EQ(found.size(), expected.size());
  const auto difference = std::mismatch(found.begin(), found.end(), expected.begin(), expected.end());
  if (difference.first != found.end() && difference.second != expected.end()) {
    EXPECT_EQ(*difference.first, *difference.second);
  }
  return found.size();
}

/// n balls whose centres fill the box evenly; radii between largest/ratio and largest, numbers ~ r^-power.
/// With ratio 1 all are equal.
Balls cloud(int n, const Vec3& lower, const Vec3& lengths, double largest, double ratio, std::uint64_t seed,
            double power = 2.5) {
  std::mt19937_64 random(seed);
  std::uniform_real_distribution<double> uniform(0, 1);
  Balls balls;
  const double rarest = std::pow(ratio, -power);
  for (int i = 0; i < n; ++i) {
    const Vec3 place(uniform(random), uniform(random), uniform(random));
    const double fraction = rarest + (1 - rarest) * uniform(random);
    const double radius = std::min(largest, largest / ratio * std::pow(fraction, -1 / power));
    balls.add(lower + place.cwiseProduct(lengths), radius);
  }
  return balls;
}

/// As cloud, in a cube of the side that makes the solid fraction (overlaps counted twice) the one given.
Balls packed(int n, double ratio, double solid_fraction, std::uint64_t seed) {
  Balls balls = cloud(n, Vec3::Zero(), Vec3::Ones(), 1, ratio, seed);
  double volume = 0;
  for (const double r : balls.radii) volume += 4.0 / 3.0 * std::numbers::pi * r * r * r;
  const double side = std::cbrt(volume / solid_fraction);
  for (Vec3& x : balls.centres) x *= side;
  return balls;
}

PeriodicCell cell_along(bool x, bool y, bool z, const Vec3& lengths, const Vec3& origin = Vec3::Zero()) {
  return PeriodicCell::box(origin, lengths, {x, y, z});
}

TEST(CandidatePairs, NoneForNoBallAndForOne) {
  EXPECT_TRUE(search({}).empty());
  EXPECT_TRUE(search({}, cell_along(true, true, true, Vec3::Ones())).empty());
  Balls one;
  one.add({1, 2, 3}, 0.5);
  EXPECT_TRUE(search(one).empty());
  EXPECT_TRUE(search(one, cell_along(true, true, true, Vec3::Constant(1.5))).empty());
}

TEST(CandidatePairs, OfACloudOfEqualBalls) {
  EXPECT_GT(expect_exact(packed(1500, 1, 0.5, 1)), 1000U);
}

TEST(CandidatePairs, OfADiluteCloud) {
  // Fewer balls than cells: the table of pieces of rows.
  EXPECT_GT(expect_exact(packed(2000, 1.5, 0.01, 2)), 10U);
}

TEST(CandidatePairs, OfUnequalBalls) {
  for (const double ratio : {3.0, 10.0, 30.0, 1000.0}) {
    SCOPED_TRACE(ratio);
    EXPECT_GT(expect_exact(packed(1500, ratio, 0.6, 3)), 1000U);
  }
}

TEST(CandidatePairs, OfSizesOnTheBordersOfTheLevels) {
  Balls balls = packed(1000, 1, 0.5, 4);
  for (std::size_t i = 0; i < balls.radii.size(); ++i) {
    constexpr double power_of_two[]{1, 0.5, 0.25, 0.125};
    balls.radii[i] = power_of_two[i % 4];
    if (i % 3 == 0) balls.radii[i] = std::nextafter(balls.radii[i], 0.0);
  }
  EXPECT_GT(expect_exact(balls), 100U);
}

TEST(CandidatePairs, OfBallsWithinReach) {
  for (const double reach : {0.05, 1.0, 5.0}) {
    SCOPED_TRACE(reach);
    expect_exact(packed(600, 10, 0.2, 5), open_space, reach);
    expect_exact(cloud(100, Vec3::Zero(), Vec3::Constant(6), 0.5, 4, 6),
                 cell_along(true, false, true, Vec3::Constant(6)), reach);
  }
}

TEST(CandidatePairs, WithOutliersFarAway) {
  for (const double distance : {1e9, 1e15, 1e100}) {
    SCOPED_TRACE(distance);
    Balls balls = packed(1000, 4, 0.5, 7);
    balls.centres[10] = Vec3(distance, -distance, 0.3 * distance);
    balls.centres[20] = -balls.centres[10];
    balls.centres[30].y() = -distance;
    EXPECT_GT(expect_exact(balls), 100U);
  }
}

TEST(CandidatePairs, OfAGroupFarFromTheOrigin) {
  Balls balls = packed(500, 4, 0.5, 8);
  for (Vec3& x : balls.centres) x += Vec3(1e12, -1e12, 1e13);
  EXPECT_GT(expect_exact(balls), 100U);
}

TEST(CandidatePairs, NotANumberTouchesNothing) {
  Balls balls = packed(200, 2, 0.5, 9);
  balls.centres[5].x() = std::nan("");
  balls.centres[6].setConstant(std::nan(""));
  for (const CandidatePair& p : search(balls)) {
    EXPECT_TRUE(p.a != 5 && p.b != 5 && p.a != 6 && p.b != 6);
  }
  for (const CandidatePair& p : search(balls, cell_along(true, true, false, Vec3::Constant(9)))) {
    EXPECT_TRUE(p.a != 5 && p.b != 5 && p.a != 6 && p.b != 6);
  }
}

TEST(CandidatePairs, OfCoincidentCentres) {
  Balls balls = packed(100, 3, 0.3, 10);
  for (std::size_t i = 0; i < 50; ++i) balls.centres[2 * i] = balls.centres[0];
  EXPECT_GE(expect_exact(balls), 50U * 49 / 2);
}

TEST(CandidatePairs, OfALatticeThatJustTouches) {
  // Every number is exact here, and so is the comparison.
  Balls lattice;
  for (int x = 0; x < 8; ++x)
    for (int y = 0; y < 8; ++y)
      for (int z = 0; z < 8; ++z) lattice.add(Vec3(x, y, z), 0.5);
  EXPECT_EQ(expect_exact(lattice), 3U * 7 * 8 * 8);
  EXPECT_EQ(expect_exact(lattice, cell_along(true, true, true, Vec3::Constant(8))), 3U * 8 * 8 * 8);
  EXPECT_EQ(expect_exact(lattice, cell_along(true, false, false, Vec3::Constant(8), {-3.25, 0, 0})),
            (8U + 7 + 7) * 8 * 8);
  for (double& r : lattice.radii) r = std::nextafter(0.5, 0.0);
  EXPECT_EQ(expect_exact(lattice), 0U);
}

TEST(CandidatePairs, OfALatticeOfNumbersThatAreRounded) {
  // A third of a metre is not a double: which pairs touch is up to rounding, but the rounding of the
  // definition and not that of the grid.
  Balls lattice;
  for (int x = -4; x < 4; ++x)
    for (int y = -4; y < 4; ++y)
      for (int z = -4; z < 4; ++z) lattice.add(Vec3(x / 3.0, y / 3.0 + 0.1, z / 3.0 - 1e3), 1 / 6.0);
  expect_exact(lattice);
  expect_exact(lattice, cell_along(true, true, true, Vec3::Constant(8 / 3.0), {0.7, 1e2, -3}));
}

TEST(CandidatePairs, AlongPeriodicAxes) {
  for (unsigned axes = 1; axes < 8; ++axes) {
    SCOPED_TRACE(axes);
    const Vec3 lengths(6, 8, 10);
    const Vec3 origin(-2, 5, 0.5);
    const PeriodicCell cell =
        cell_along((axes & 1U) != 0, (axes & 2U) != 0, (axes & 4U) != 0, lengths, origin);
    for (const double ratio : {1.0, 10.0, 30.0}) {
      const double largest = ratio == 1 ? 0.6 : 2.5;
      EXPECT_GT(expect_exact(cloud(500, origin, lengths, largest, ratio, 11, 1.5), cell), 50U);
    }
  }
}

TEST(CandidatePairs, InALargePeriodicCellThatIsNearlyEmpty) {
  // More cells than a dense grid may have; the clouds lie across the cell's corner.
  const PeriodicCell cell = cell_along(true, true, true, Vec3::Constant(1e7), {3, 3, 3});
  Balls balls = cloud(400, Vec3::Constant(-2), Vec3::Constant(10), 1, 4, 12);
  EXPECT_GT(expect_exact(balls, cell), 100U);
}

TEST(CandidatePairs, LengthsOfAxesThatDoNotRepeatMeanNothing) {
  const Balls balls = packed(200, 2, 0.5, 13);
  PeriodicCell cell;
  cell.edges.diagonal() = Vec3(std::nan(""), -1, INFINITY);
  cell.origin = Vec3::Constant(std::nan(""));
  EXPECT_EQ(search(balls, cell), search(balls));
}

TEST(CandidatePairs, InCellsSmallerThanTheBalls) {
  for (const double length : {0.3, 0.5, 1.0, 1.7, 2.0, 3.3, 5.0}) {
    SCOPED_TRACE(length);
    const Vec3 lengths(length, 1.1 * length, 0.9 * length);
    for (unsigned axes = 1; axes < 8; ++axes) {
      const PeriodicCell cell = cell_along((axes & 1U) != 0, (axes & 2U) != 0, (axes & 4U) != 0, lengths);
      expect_exact(cloud(4, Vec3::Zero(), lengths, 1, 8, 14), cell, 0.1);
      const std::size_t pairs = expect_exact(cloud(4, Vec3::Zero(), lengths, 1, 1, 15), cell);
      // Every ball lies in the eightfold volume of another, four to a cell, and each pair counts once.
      const double expected =
          8 * 4.0 / 3.0 * std::numbers::pi / (0.99 * length * length * length) * 4 * 4 / 2;
      if (axes == 7 && length < 1) {
        EXPECT_NEAR(static_cast<double>(pairs), expected, 0.1 * expected);
      }
    }
  }
}

TEST(CandidatePairs, OfABallAndItsOwnImages) {
  Balls one;
  one.add({0.5, 0.5, 0.5}, 1);
  // Two radii are two cells: images 1 and 2 along x, the latter just touching.
  EXPECT_THAT(search(one, cell_along(true, false, false, Vec3::Ones())),
              testing::ElementsAre(CandidatePair{0, 0, {1, 0, 0}}, CandidatePair{0, 0, {2, 0, 0}}));
  EXPECT_THAT(search(one, cell_along(true, true, false, Vec3::Constant(1.9))),
              testing::ElementsAre(CandidatePair{0, 0, {0, 1, 0}}, CandidatePair{0, 0, {1, 0, 0}}));
}

TEST(CandidatePairs, ImagesReferToTheCentresAsStored) {
  Balls two;
  two.add({0.1, 0, 0}, 0.25);
  two.add({-28.1, 0, 0}, 0.25);
  EXPECT_THAT(search(two, cell_along(true, false, false, Vec3::Ones())),
              testing::ElementsAre(CandidatePair{0, 1, {28, 0, 0}}));

  const Vec3 lengths(4, 5, 6);
  for (const double largest : {0.5, 2.0}) {
    Balls balls = cloud(200, Vec3::Zero(), lengths, largest, 3, 16);
    std::mt19937_64 random(17);
    std::uniform_int_distribution<int> image(-20, 20);
    for (Vec3& x : balls.centres)
      x += Vec3(image(random) * lengths.x(), image(random) * lengths.y(), image(random) * lengths.z());
    EXPECT_GT(expect_exact(balls, cell_along(true, true, true, lengths, {1, -2, 0})), 50U);
  }
}

TEST(CandidatePairs, ImagesThatCannotBeCountedAreAnInputError) {
  const PeriodicCell cell = cell_along(true, false, false, Vec3::Ones());
  const auto message = [&](const Balls& balls) -> std::string {
    try {
      search(balls, cell);
    } catch (const InputError& error) {
      return error.what();
    }
    return "";
  };
  Balls two;
  two.add({0.5, 0, 0}, 0.25);
  two.add({-126.5, 0, 0}, 0.25);
  EXPECT_EQ(message(two), "");
  EXPECT_EQ(search(two, cell).front(), (CandidatePair{0, 1, {127, 0, 0}}));
  two.centres[1].x() = 128.5;
  EXPECT_THAT(message(two), testing::AllOf(testing::HasSubstr("(-128, 0, 0)"), testing::HasSubstr("wrap")));
  two.centres[1].x() = 1e12;
  EXPECT_THAT(message(two), testing::AllOf(testing::HasSubstr("1e+12 m"), testing::HasSubstr("wrap")));

  Balls giant;
  giant.add(Vec3::Zero(), 63.75);
  EXPECT_EQ(search(giant, cell).size(), 127U);
  giant.radii[0] = 64;
  EXPECT_THAT(message(giant), testing::AllOf(testing::HasSubstr("64 m"), testing::HasSubstr("enlarge")));
}

TEST(CandidatePairs, AreTheSameForAnyNumberOfThreadsAndSorted) {
  struct RestoreThreads {
    int before = threads();
    ~RestoreThreads() { set_threads(before); }
  } restore;
  const Balls balls = packed(20000, 10, 0.5, 18);
  const PeriodicCell cell = cell_along(true, true, false, Vec3::Constant(4), {1, 1, 1});
  set_threads(1);
  const std::vector<CandidatePair> open = search(balls);
  const std::vector<CandidatePair> periodic = search(balls, cell);
  EXPECT_GT(open.size(), 20000U);
  for (const auto* pairs : {&open, &periodic})
    EXPECT_TRUE(std::is_sorted(pairs->begin(), pairs->end(),
                               [](const auto& left, const auto& right) { return key(left) < key(right); }));
  for (const int count : {2, 3}) {
    set_threads(count);
    EXPECT_EQ(search(balls), open);
    EXPECT_EQ(search(balls, cell), periodic);
  }
}

double work_per_ball(const Balls& balls) {
  const PairSearch result = search_pairs(balls.centres, balls.radii, open_space, 0);
  return static_cast<double>(result.rows_visited + result.distance_tests) / balls.size();
}

TEST(CandidatePairs, CostAboutTheSameForEachBallHoweverMany) {
  for (const double ratio : {1.0, 10.0, 30.0}) {
    SCOPED_TRACE(ratio);
    const double few = work_per_ball(packed(4000, ratio, 0.6, 19));
    const double many = work_per_ball(packed(32000, ratio, 0.6, 20));
    // Few balls have more of them at the surface of the cloud, where there is less to meet.
    EXPECT_LT(many, 1.5 * few);
    EXPECT_LT(many, 120);
  }
}

TEST(CandidatePairs, CostLittleMoreWithAnOutlier) {
  Balls balls = packed(20000, 1, 0.6, 21);
  const double compact = work_per_ball(balls);
  for (const double distance : {1e3, 1e9, -1e30}) {
    balls.centres[7] = Vec3::Constant(distance);
    EXPECT_LT(work_per_ball(balls), 2.5 * compact);
  }
}

TEST(CandidatePairs, CostLittleInASparseRegularLattice) {
  // Where a grid wrapped round its edges would put whole rows of balls into the same bucket.
  for (const double pitch : {10.0, 16.0, 64.0, 1000.0}) {
    SCOPED_TRACE(pitch);
    Balls lattice;
    for (int x = 0; x < 32; ++x)
      for (int y = 0; y < 32; ++y)
        for (int z = 0; z < 32; ++z) lattice.add(pitch * Vec3(x, y, z), 0.5);
    EXPECT_LT(work_per_ball(lattice), 100);
  }
}

}  // namespace
}  // namespace eigengrain::search
