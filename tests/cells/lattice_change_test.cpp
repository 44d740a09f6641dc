// Cells whose edges slant: other edges of the same lattice, pairs found through it, and what regions see.
#include "eigengrain/measures/window.hpp"
#include "eigengrain/search/candidates.hpp"

#include "cells/support.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <tuple>

namespace eigengrain::test {
namespace {

using model::Image;
using model::PeriodicCell;
using search::CandidatePair;

double slant(const PeriodicCell& cell, int i, int j) {
  return std::abs(cell.edges.col(i).dot(cell.edges.col(j))) / cell.edges.col(j).squaredNorm();
}

TEST(Reduce, FindsShortEdgesOfTheSameLattice) {
  std::mt19937_64 random(1);
  std::uniform_int_distribution<int> integer(-3, 3);
  int changed = 0;
  for (int trial = 0; trial < 2000; ++trial) {
    PeriodicCell cell = slanted_cell(random, 0.3);
    // Sheared far, with integers, so that good edges exist; and some that are not.
    for (int k = 0; k < 3; ++k) cell.edges.col(k) += integer(random) * cell.edges.col((k + 1) % 3);
    if (trial % 2 == 0) cell.edges.col(1) += 0.37 * cell.edges.col(2);
    cell.rate = Mat3::Random();
    const PeriodicCell before = cell;
    const model::LatticeChange change = model::reduce(cell);
    changed += change.any() ? 1 : 0;
    EXPECT_EQ(change.edges * change.images, Eigen::Matrix3i(Eigen::Matrix3i::Identity()));
    // Edges of up to 40 and integers of up to some tens: rounding of 1e-13.
    EXPECT_LT((before.edges * change.edges.cast<double>() - cell.edges).norm(), 1e-12 * before.edges.norm());
    EXPECT_LT((before.rate * change.edges.cast<double>() - cell.rate).norm(), 1e-11 * before.edges.norm());
    EXPECT_NEAR(cell.volume() / before.volume(), 1, 1e-11);
    for (int i = 0; i < 3; ++i)
      for (int j = 0; j < 3; ++j) {
        if (i != j) {
          EXPECT_LT(slant(cell, i, j), 0.5 + 1e-6);
        }
      }
    EXPECT_FALSE(model::reduce(cell).any());
  }
  EXPECT_GT(changed, 1900);
}

TEST(Reduce, LeavesEdgesAloneThatDoNotSlantOrDoNotRepeat) {
  PeriodicCell box = PeriodicCell::box(Vec3::Zero(), {1, 20, 3}, {true, true, true});
  EXPECT_FALSE(model::reduce(box).any());
  PeriodicCell layer = PeriodicCell::box(Vec3::Zero(), {1, 1, 5}, {true, true, false});
  layer.edges(0, 1) = 0.5;  // at the limit
  EXPECT_FALSE(model::reduce(layer).any());
  layer.edges(0, 1) = 0.51;
  const model::LatticeChange change = model::reduce(layer);
  EXPECT_TRUE(change.any());
  EXPECT_DOUBLE_EQ(layer.edges(0, 1), -0.49);
  EXPECT_EQ(change.images * Eigen::Vector3i(0, 1, 0), Eigen::Vector3i(1, 1, 0));
}

TEST(SlantedCell, WrapsIntoItself) {
  std::mt19937_64 random(2);
  for (int trial = 0; trial < 200; ++trial) {
    const PeriodicCell cell = slanted_cell(random, 0.6);
    const Vec3 x = 30 * Vec3::Random();
    const Vec3 inside = cell.inverse() * (cell.wrapped(x) - cell.origin);
    const Vec3 cells = cell.inverse() * (x - cell.wrapped(x));
    for (int k = 0; k < 3; ++k) {
      // Twenty cells of four ulps each.
      EXPECT_GE(inside[k], -1e-13);
      EXPECT_LE(inside[k], 1 + 1e-13);
      EXPECT_NEAR(cells[k], std::round(cells[k]), 1e-12);
    }
  }
}

/// The definition in candidates.hpp, with all images that can matter: an image by k along edge e is at least
/// |k| heights of the cell away from where it began.
std::vector<CandidatePair> all_pairs(const std::vector<Vec3>& centres, const std::vector<double>& radii,
                                     const PeriodicCell& cell, double reach) {
  const Mat3 inverse = cell.inverse();
  std::vector<CandidatePair> pairs;
  for (std::int32_t a = 0; a < static_cast<std::int32_t>(centres.size()); ++a)
    for (std::int32_t b = a; b < static_cast<std::int32_t>(centres.size()); ++b) {
      const double limit = radii[a] + radii[b] + reach;
      const Vec3 apart = inverse * (centres[b] - centres[a]);
      std::array<int, 3> most{};
      for (int k = 0; k < 3; ++k)
        if (cell.periodic[k])
          most[k] = static_cast<int>(std::ceil(limit * inverse.row(k).norm() + std::abs(apart[k]))) + 1;
      for (int i = -most[0]; i <= most[0]; ++i)
        for (int j = -most[1]; j <= most[1]; ++j)
          for (int k = -most[2]; k <= most[2]; ++k) {
            const Image image{static_cast<std::int8_t>(i), static_cast<std::int8_t>(j),
                              static_cast<std::int8_t>(k)};
            if (a == b && image <= Image{}) continue;
            if ((centres[b] + cell.shift(image) - centres[a]).squaredNorm() <= limit * limit)
              pairs.push_back({a, b, image});
          }
    }
  return pairs;
}

struct Cloud {
  std::vector<Vec3> centres;
  std::vector<double> radii;
};

/// Balls of sizes within `ratio`, anywhere in a cell and in copies of it.
Cloud cloud(std::mt19937_64& random, const PeriodicCell& cell, int balls, double largest, double ratio,
            int copies) {
  std::uniform_real_distribution<double> uniform(0, 1);
  std::uniform_int_distribution<int> copy(-copies, copies);
  Cloud made;
  for (int i = 0; i < balls; ++i) {
    Vec3 place(uniform(random), uniform(random), uniform(random));
    for (int k = 0; k < 3; ++k) place[k] += cell.periodic[static_cast<std::size_t>(k)] ? copy(random) : 0;
    made.centres.emplace_back(cell.origin + cell.edges * place);
    made.radii.push_back(largest * std::pow(ratio, -uniform(random)));
  }
  return made;
}

TEST(SlantedCell, HasThePairsThatTheDefinitionSays) {
  std::mt19937_64 random(3);
  std::size_t pairs = 0;
  std::size_t own = 0;
  for (int trial = 0; trial < 150; ++trial) {
    // Up to twice the slant at which a cell is reduced, cells of a few balls and of a fraction of one.
    PeriodicCell cell = slanted_cell(random, 0.25 * (trial % 4));
    cell.periodic = {trial % 3 != 1, true, trial % 5 != 2};
    for (int k = 0; k < 3; ++k) {
      if (cell.periodic[static_cast<std::size_t>(k)]) continue;
      cell.edges.row(k).setZero();
      cell.edges.col(k) = 3 * Vec3::Unit(k);
    }
    const double largest = std::array{0.2, 0.7, 2.5}[static_cast<std::size_t>(trial % 3)];
    const Cloud balls = cloud(random, cell, 40, largest, trial % 2 == 0 ? 1 : 8, trial % 7);
    const auto found = search::candidate_pairs(balls.centres, balls.radii, cell, 0.05);
    const auto wanted = all_pairs(balls.centres, balls.radii, cell, 0.05);
    EXPECT_EQ(found, wanted) << trial;
    pairs += found.size();
    own += static_cast<std::size_t>(
        std::count_if(found.begin(), found.end(), [](const CandidatePair& p) { return p.a == p.b; }));
  }
  EXPECT_GT(pairs, 100000U);
  EXPECT_GT(own, 1000U);
}

TEST(SlantedCell, HasTheSamePairsByOtherEdges) {
  std::mt19937_64 random(4);
  for (int trial = 0; trial < 50; ++trial) {
    PeriodicCell cell = slanted_cell(random, 0.3);
    cell.edges.col(2) += 2 * cell.edges.col(0) - cell.edges.col(1);
    const Cloud balls = cloud(random, cell, 60, trial % 2 == 0 ? 0.5 : 1.5, 2, 2);
    PeriodicCell reduced = cell;
    ASSERT_TRUE(model::reduce(reduced).any());
    const auto places = [&](const PeriodicCell& in) {
      std::vector<std::tuple<std::int32_t, std::int32_t, double>> all;
      for (const CandidatePair& p : search::candidate_pairs(balls.centres, balls.radii, in))
        all.emplace_back(p.a, p.b, (balls.centres[p.b] + in.shift(p.image) - balls.centres[p.a]).norm());
      std::sort(all.begin(), all.end());
      return all;
    };
    const auto first = places(cell);
    const auto second = places(reduced);
    ASSERT_EQ(first.size(), second.size());
    for (std::size_t k = 0; k < first.size(); ++k) {
      EXPECT_EQ(std::get<0>(first[k]), std::get<0>(second[k]));
      EXPECT_EQ(std::get<1>(first[k]), std::get<1>(second[k]));
      EXPECT_NEAR(std::get<2>(first[k]), std::get<2>(second[k]), 1e-12);  // sums of numbers of up to 30
    }
  }
}

// Each image of a point or ball is inside or not, whichever edges say where it is: counted one by one.
TEST(SlantedCell, ShowsRegionsAllImages) {
  std::mt19937_64 random(5);
  for (int trial = 0; trial < 40; ++trial) {
    assembly::Model model;
    model.cell = slanted_cell(random, 0.4);
    model.cell.rate = Mat3::Random();
    const Vec3 corner = Vec3::Random();
    const model::Region region{
        "r", trial % 2 == 0 ? decltype(model::Region::shape)(model::BoxRegion{corner, corner + Vec3(7, 4, 5)})
                            : decltype(model::Region::shape)(model::SphereRegion{corner, 3.5})};
    const measures::Window window(region, model);
    const Vec3 x = 5 * Vec3::Random();
    int seen = 0;
    Vec3 velocities = Vec3::Zero();
    window.for_each_inside(x, [&](const Vec3&, const Vec3& velocity) {
      ++seen;
      velocities += velocity;
    });
    const double volume = window.ball(x, 0.8);
    const double line = window.line(x, {0.5, -1, 0.3});
    int wanted = 0;
    Vec3 wanted_velocities = Vec3::Zero();
    double wanted_volume = 0;
    double wanted_line = 0;
    assembly::Model open;
    const measures::Window alone(region, open);
    constexpr int most = 20;
    for (int i = -most; i <= most; ++i)
      for (int j = -most; j <= most; ++j)
        for (int k = -most; k <= most; ++k) {
          const Vec3 image = x + model.cell.shift(std::array{i, j, k});
          alone.for_each_inside(image, [&](const Vec3&, const Vec3&) {
            ++wanted;
            wanted_velocities += model.cell.rate * Vec3(i, j, k);
          });
          wanted_volume += alone.ball(image, 0.8);
          wanted_line += alone.line(image, {0.5, -1, 0.3});
        }
    EXPECT_EQ(seen, wanted);
    EXPECT_LT((velocities - wanted_velocities).norm(), 1e-11);
    EXPECT_NEAR(volume, wanted_volume, 1e-11);
    EXPECT_NEAR(line, wanted_line, 1e-12);
  }
}

}  // namespace
}  // namespace eigengrain::test
