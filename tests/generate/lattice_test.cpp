#include "eigengrain/generate/lattice.hpp"

#include "generate/support.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

namespace eigengrain::generate {
namespace {

using std::numbers::pi;
using testing::Each;
using testing::HasSubstr;

struct Known {
  const char* name;
  int neighbours;
  double fraction;  ///< of space, or of the plane where planar, for balls that touch
};

/// Textbook values (e.g. Conway & Sloane, Sphere Packings, Lattices and Groups, ch. 1).
const Known known[]{
    {"sc", 6, pi / 6},
    {"bcc", 8, pi* std::sqrt(3.0) / 8},
    {"fcc", 12, pi / (3 * std::sqrt(2.0))},
    {"hcp", 12, pi / (3 * std::sqrt(2.0))},
    {"diamond", 4, pi* std::sqrt(3.0) / 16},
    {"square", 4, pi / 4},
    {"hexagonal", 6, pi / (2 * std::sqrt(3.0))},
};

constexpr double radius = 0.005;

/// A periodic cell of 3 × 4 × 5 cells of the lattice, somewhere.
Region fitting(const Lattice& lattice, double spacing) {
  Vec3 edges = lattice.cell * spacing;
  if (lattice.planar) edges.z() = spacing;
  Region region = cell(edges.cwiseProduct(Vec3(3, 4, 5)));
  region.lower += Vec3(0.3, -0.2, 0.1);
  region.upper += Vec3(0.3, -0.2, 0.1);
  return region;
}

TEST(Lattice, HasItsNumberOfNeighboursAndItsSolidFraction) {
  ASSERT_EQ(lattices().size(), std::size(known));
  for (const Known& expected : known) {
    SCOPED_TRACE(expected.name);
    const Lattice* lattice = find_lattice(expected.name);
    ASSERT_NE(lattice, nullptr);
    const Region region = fitting(*lattice, 2 * radius);
    const Balls balls = fill_with_lattice(*lattice, radius, 2 * radius, region);
    ASSERT_EQ(balls.radius.size(), lattice->sites.size() * (lattice->planar ? 12 : 60));
    const Neighbours found = neighbours_of(balls, region, 1e-3 * radius);
    EXPECT_THAT(found.count, Each(expected.neighbours));
    // Coordinates are below 1 m: an error of a few times 2^-53 m.
    EXPECT_LT(std::abs(found.least_gap), 1e-15);
    EXPECT_LT(std::abs(found.greatest_gap), 1e-15);
    const Vec3 edges = region.edges();
    const double fraction = lattice->planar ? static_cast<double>(balls.radius.size()) * pi * radius *
                                                  radius / (edges.x() * edges.y())
                                            : solid_fraction(balls.radius, region);
    // The edges carry the rounding of their faces, 1e-16 m of 0.03 m, three times; the rest a few roundings.
    EXPECT_NEAR(fraction / expected.fraction, 1, 2e-14);
  }
  EXPECT_EQ(find_lattice("fc"), nullptr);
}

TEST(Lattice, OverlapsByWhatTheSpacingLeaves) {
  const Lattice& fcc = *find_lattice("fcc");
  const double spacing = 2 * radius - 1e-5;
  const Region region = fitting(fcc, spacing);
  const Neighbours found = neighbours_of(fill_with_lattice(fcc, radius, spacing, region), region, 0);
  EXPECT_THAT(found.count, Each(12));
  EXPECT_NEAR(found.least_gap, -1e-5, 1e-15);
  EXPECT_NEAR(found.greatest_gap, -1e-5, 1e-15);
}

TEST(Lattice, FillsABoxFromItsLowerFaces) {
  const Lattice& cubic = *find_lattice("sc");
  const Region ten = box({0, 0, 0}, {10 * 2 * radius, 10 * 2 * radius, 10 * 2 * radius});
  const Balls balls = fill_with_lattice(cubic, radius, 2 * radius, ten);
  EXPECT_EQ(balls.radius.size(), 1000U);
  EXPECT_TRUE(all_inside(balls, ten, 1e-15));
  EXPECT_EQ(balls.position.front(), Vec3::Constant(radius));
  Region less = ten;
  less.upper.z() -= 1e-6;
  EXPECT_EQ(fill_with_lattice(cubic, radius, 2 * radius, less).radius.size(), 900U);
  less.upper.z() += 2 * radius - 2e-6;
  EXPECT_EQ(fill_with_lattice(cubic, radius, 2 * radius, less).radius.size(), 1000U);
}

TEST(Lattice, LeavesOutTheSitesThatDoNotFitIntoABox) {
  // Layers of hcp normal to z: the third, c = √(8/3) spacings up, fits and the fourth does not.
  const Lattice& hcp = *find_lattice("hcp");
  const double height = 2 * radius * (1 + 1.01 * std::sqrt(8.0 / 3));
  const Region region = box({0, 0, 0}, {0.1, 0.1, height});
  const Balls balls = fill_with_lattice(hcp, radius, 2 * radius, region);
  EXPECT_TRUE(all_inside(balls, region, 1e-15));
  EXPECT_GE(neighbours_of(balls, region, 0).least_gap, -1e-15);
  double top = 0;
  for (const Vec3& x : balls.position) top = std::max(top, x.z());
  EXPECT_NEAR(top, radius + 2 * radius * std::sqrt(8.0 / 3), 1e-15);
  // Rows of ten balls, and of nine between them; eleven rows √3/2 spacings apart in two layers of A, in B as
  // many as lie inside: counted by hand, A has rows 0..10 (10.39 rows fit), B begins a third of a row higher.
  EXPECT_EQ(balls.radius.size(), 2U * (6 * 10 + 5 * 9) + (5 * 10 + 5 * 9));
}

TEST(Lattice, RepeatsWhereTheRegionDoesAndEndsWhereItDoesNot) {
  const Lattice& cubic = *find_lattice("sc");
  const Region region = cell({0.03, 0.03, 0.035}, {true, true, false});
  const Balls balls = fill_with_lattice(cubic, radius, 0.01, region);
  EXPECT_EQ(balls.radius.size(), 27U);
  EXPECT_EQ(balls.position.front(), Vec3(0, 0, radius));
}

TEST(Lattice, PlanarOnesLieMidway) {
  const Balls balls =
      fill_with_lattice(*find_lattice("hexagonal"), radius, 0.01, box({0, 0, 1}, {0.1, 0.1, 2}));
  for (const Vec3& x : balls.position) EXPECT_EQ(x.z(), 1.5);
}

TEST(Lattice, RefusesLengthsThatDoNotRepeatAndNamesTheNearestThatDo) {
  const Lattice& cubic = *find_lattice("sc");
  const std::string message = refusal([&] {
    fill_with_lattice(cubic, radius, 0.01, cell({0.034, 0.03, 0.0361}));
  });
  EXPECT_THAT(message,
              HasSubstr("does not repeat with the cell: along x the cell is 0.034 m long, 3.4 times the "
                        "lattice's 0.01 m; the nearest length that fits is 0.03 m; along z"));
  EXPECT_THAT(message, HasSubstr("the nearest length that fits is 0.04 m"));
  EXPECT_THAT(message, testing::Not(HasSubstr("along y")));
  // Ten digits are enough, nine are not.
  EXPECT_EQ(refusal([&] {
              fill_with_lattice(cubic, radius, 0.01, cell({0.03 * (1 + 9e-10), 0.03, 0.03}));
            }),
            "");
  EXPECT_NE(refusal([&] {
              fill_with_lattice(cubic, radius, 0.01, cell({0.03 * (1 + 2e-9), 0.03, 0.03}));
            }),
            "");
}

TEST(Lattice, RefusesWhatHasNoRoomAndWhatIsTooMany) {
  const Lattice& cubic = *find_lattice("sc");
  EXPECT_THAT(refusal([&] {
                fill_with_lattice(cubic, 1, 2, box({0, 0, 0}, {3, 1.9, 3}));
              }),
              HasSubstr("a ball of radius 1 m does not fit into the region, which is 1.9 m wide along y"));
  EXPECT_THAT(refusal([&] {
                fill_with_lattice(cubic, 1e-6, 2e-6, box({0, 0, 0}, {1, 1, 1}));
              }),
              HasSubstr("1.25e+17 balls, and no more than 100,000,000 can be made; are the units right?"));
}

}  // namespace
}  // namespace eigengrain::generate
