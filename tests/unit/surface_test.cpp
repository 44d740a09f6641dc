// Triangles as walls: geometry of faces, edges and corners, the choice among them, K, search.
#include "eigengrain/assembly/contact_list.hpp"
#include "eigengrain/assembly/tangent.hpp"
#include "eigengrain/base/error.hpp"
#include "eigengrain/contact/facet.hpp"
#include "eigengrain/search/facet_tree.hpp"

#include "support/scenes.hpp"
#include "support/surfaces.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

namespace eigengrain::test {
namespace {

using assembly::Model;
using contact::FacetFeature;
using Kind = FacetFeature::Kind;

model::Facet facet_of(const Vec3& a, const Vec3& b, const Vec3& c) {
  model::Surface surface;
  surface.vertices = {a, b, c};
  surface.triangles = {{0, 1, 2}};
  return model::facets_of(std::vector{surface}).facet.at(0);
}

// Slow and obvious: the nearest of many points.
TEST(Facet, NearestPointIsTheNearestOfAll) {
  std::mt19937_64 random(4);
  std::array<int, 3> kinds{};
  for (int k = 0; k < 400; ++k) {
    const model::Facet facet = facet_of(random_vector(random), random_vector(random), random_vector(random));
    const Vec3 x = 2 * random_vector(random);
    const contact::NearestPoint found = contact::nearest_point(x, facet);
    ++kinds.at(static_cast<std::size_t>(found.feature.kind));
    constexpr int steps = 100;
    double least = 1e9;
    for (int i = 0; i <= steps; ++i)
      for (int j = 0; i + j <= steps; ++j) {
        const Vec3 p = facet.corner[0] + i / double{steps} * (facet.corner[1] - facet.corner[0]) +
                       j / double{steps} * (facet.corner[2] - facet.corner[0]);
        least = std::min(least, (p - x).norm());
      }
    const double distance = (found.point - x).norm();
    EXPECT_LE(distance, least + 1e-14);
    EXPECT_GE(distance, least - 0.04);  // the points are some 1/100 of up to 4 apart
  }
  for (const int count : kinds) EXPECT_GT(count, 10);
}

TEST(Facet, FeaturesAreFaceEdgesAndCorners) {
  const model::Facet facet = facet_of({0, 0, 0}, {4, 0, 0}, {0, 3, 0});
  const auto feature = [&](const Vec3& x) { return contact::nearest_point(x, facet).feature; };
  EXPECT_EQ(feature({1, 1, 5}), (FacetFeature{Kind::face, 0}));
  EXPECT_EQ(feature({1, 0, -5}), (FacetFeature{Kind::face, 0}));  // over an edge counts as inside
  EXPECT_EQ(feature({1, -1, 5}), (FacetFeature{Kind::edge, 0}));
  EXPECT_EQ(feature({3, 3, 0}), (FacetFeature{Kind::edge, 1}));
  EXPECT_EQ(feature({-1, 1, 0}), (FacetFeature{Kind::edge, 2}));
  EXPECT_EQ(feature({-1, -1, 1}), (FacetFeature{Kind::corner, 0}));
  EXPECT_EQ(feature({6, 0, 0}), (FacetFeature{Kind::corner, 1}));
  EXPECT_EQ(feature({0, 5, 2}), (FacetFeature{Kind::corner, 2}));
  EXPECT_EQ(contact::nearest_point({6, 6, 1}, facet).point,
            Vec3(0, 0, 0) + contact::nearest_point({6, 6, 0}, facet).point);
}

TEST(FacetTree, FindsWhatIsNear) {
  std::mt19937_64 random(5);
  const model::Surface surface =
      terrain(20, 0.3, [&](double, double) { return 0.2 * random_vector(random)[0]; });
  const model::Facets facets = model::facets_of(std::vector{surface});
  const search::FacetTree tree(facets.facet, 0);
  std::size_t all = 0;
  for (int k = 0; k < 200; ++k) {
    const Vec3 x = random_vector(random);
    std::vector<std::int32_t> found;
    tree.near(x, 0.5, found);
    std::sort(found.begin(), found.end());
    EXPECT_EQ(std::adjacent_find(found.begin(), found.end()), found.end());
    all += found.size();
    for (std::int32_t f = 0; f < facets.size(); ++f) {
      const double distance =
          (contact::nearest_point(x, facets.facet[static_cast<std::size_t>(f)]).point - x).norm();
      if (distance <= 0.5) {
        EXPECT_TRUE(std::binary_search(found.begin(), found.end(), f));
      }
    }
  }
  EXPECT_LT(all, 200U * 200U);  // a quarter of the 800
}

/// Force on one ball of radius 1 at x, k_n = 1.
Vec3 force_at(const Vec3& x, const model::Surface& surface) {
  SceneBuilder builder({.kn = 1, .tension = false});
  return assembly::contact_forces(builder.ball(x).surface(surface).build()).force[0];
}

// A ball outside of a box touches it once, at its nearest point: whichever of 12 triangles has it.
TEST(Surface, OfABoxPushesAlongTheLineToTheNearestPoint) {
  std::mt19937_64 random(6);
  std::uniform_real_distribution<double> uniform(-1, 1);
  const Vec3 half(2, 1.5, 1);
  std::array<int, 4> touched{};  // by how many coordinates stick out: 1 face, 2 edge, 3 corner
  for (int k = 0; k < 4000; ++k) {
    const Vec3 x = 1.9 * Vec3(2 * uniform(random), 1.5 * uniform(random), uniform(random));
    const Vec3 nearest = x.cwiseMax(-half).cwiseMin(half);
    const double distance = (x - nearest).norm();
    if (distance == 0) continue;  // inside
    const Vec3 expected = distance < 1 ? Vec3((1 - distance) / distance * (x - nearest)) : Vec3(Vec3::Zero());
    EXPECT_LT((force_at(x, cuboid(half)) - expected).norm(), 1e-14) << x.transpose();
    if (distance < 1) ++touched.at(static_cast<std::size_t>(((x - nearest).array() != 0).count()));
  }
  for (std::size_t k = 1; k < 4; ++k) EXPECT_GT(touched.at(k), 50);
}

// Inside, both walls of a corner are touched, and all three where three meet.
TEST(Surface, OfARoomPushesFromEveryWallThatIsNear) {
  std::mt19937_64 random(7);
  std::uniform_real_distribution<double> uniform(-1, 1);
  const Vec3 half(2, 1.5, 1.2);
  for (int k = 0; k < 1000; ++k) {
    const Vec3 x = 0.95 * Vec3(2 * uniform(random), 1.5 * uniform(random), 1.2 * uniform(random));
    Vec3 expected = Vec3::Zero();
    for (int axis = 0; axis < 3; ++axis) {
      expected[axis] += std::max(0.0, 1 - (x[axis] + half[axis]));
      expected[axis] -= std::max(0.0, 1 - (half[axis] - x[axis]));
    }
    EXPECT_LT((force_at(x, cuboid(half, true)) - expected).norm(), 1e-14) << x.transpose();
  }
}

// A plate thinner than the ball: its lower side does not pull the ball on top through.
TEST(Surface, OfAThinPlateActsFromOneSideAtATime) {
  const model::Surface plate = cuboid({3, 3, 0.05});
  EXPECT_LT((force_at({0.3, 0.2, 0.95}, plate) - Vec3(0, 0, 0.1)).norm(), 1e-15);
  EXPECT_LT((force_at({0.3, 0.2, -0.95}, plate) - Vec3(0, 0, -0.1)).norm(), 1e-15);
}

// Everywhere on a flat mesh, over faces, edges and corners, the force is that of a plane.
TEST(Surface, ThatIsFlatIsAPlane) {
  std::mt19937_64 random(8);
  std::uniform_real_distribution<double> uniform(-1, 1);
  for (int k = 0; k < 300; ++k) {
    Vec3 x(uniform(random), uniform(random), 0.75);
    if (k % 3 == 0) x[0] = 0.4 * static_cast<int>(2 * x[0]);  // on grid lines
    if (k % 2 == 0) x[1] = 0.4 * static_cast<int>(2 * x[1]);
    if (k % 5 == 0) x[0] = x[1];  // and diagonals
    EXPECT_LT((force_at(x, flat(12, 0.4)) - Vec3(0, 0, 0.25)).norm(), 1e-14) << x.transpose();
    if (k % 20 == 0) {
      EXPECT_LT((force_at(x, flat(60, 0.04)) - Vec3(0, 0, 0.25)).norm(), 1e-14) << x.transpose();
    }
  }
}

// In a finely divided hollow only the nearest strip pushes, towards the axis; with two of them near, their
// sum would be twice as much.
TEST(Surface, ThatIsHollowAndFineIsOneContact) {
  constexpr int sides = 200;
  const model::Surface pipe = tube(sides, 5, 4);
  std::mt19937_64 random(9);
  std::uniform_real_distribution<double> uniform(0, 2 * std::numbers::pi);
  const double apothem = 5 * std::cos(std::numbers::pi / sides);
  for (int k = 0; k < 500; ++k) {
    const double angle = uniform(random);
    const Vec3 outwards(std::cos(angle), 0, std::sin(angle));
    const Vec3 force = force_at(4.1 * outwards, pipe);
    // The strip that it looks at is at most half a strip's angle askew.
    const double askew = std::remainder(angle - std::numbers::pi / sides, 2 * std::numbers::pi / sides);
    EXPECT_NEAR(force.norm(), 1 - (apothem - 4.1 * std::cos(askew)), 1e-13);
    EXPECT_GT(-force.normalized().dot(outwards), std::cos(std::numbers::pi / sides) - 1e-14);
  }
}

TEST(Surface, HoldsACentreThatHasCrossedIt) {
  SceneBuilder builder({.kn = 1, .tension = false});
  builder.ball({0.1, 0.2, 0.3}).surface(flat(4, 1));
  Model model = assembly::build_model(builder.scene(), 0.1);
  assembly::BodyForces sum;
  assembly::ContactForceSum forces(model, true);
  const std::vector<Vec3> still{Vec3::Zero()};
  for (const double z : {0.1, -0.1, -0.3}) {
    model.bodies.position[0].z() = z;
    forces.advance(model, {model.bodies.position, still, {}, 1}, sum);
    EXPECT_LT((sum.force[0] - Vec3(0, 0, 1 - z)).norm(), 1e-15) << z;
  }
  // Also where it moves on to another triangle behind the surface.
  model.bodies.position[0].head<2>() << 0.2, 0.1;
  forces.advance(model, {model.bodies.position, still, {}, 1}, sum);
  EXPECT_LT((sum.force[0] - Vec3(0, 0, 1.3)).norm(), 1e-15);
}

TEST(Surface, WithOneSideLetsBallsThroughFromBehind) {
  for (const bool two_sided : {false, true}) {
    model::Surface sheet = flat(4, 1);
    sheet.two_sided = two_sided;
    SceneBuilder builder({.kn = 1, .tension = false});
    builder.ball({0.1, 0.2, -0.3}).surface(sheet);
    Model model = assembly::build_model(builder.scene(), 0.1);
    assembly::BodyForces sum;
    assembly::ContactForceSum forces(model, true);
    const std::vector<Vec3> still{Vec3::Zero()};
    for (const double z : {-0.1, 0.1}) {
      model.bodies.position[0].z() = z;
      forces.advance(model, {model.bodies.position, still, {}, 1}, sum);
      // With two sides it is held on the side that it came from.
      EXPECT_LT((sum.force[0] - (two_sided ? Vec3(0, 0, -1 - z) : Vec3(0, 0, 0))).norm(), 1e-15) << z;
    }
  }
}

TEST(Surface, ACentreOnItIsAnErrorThatNamesBoth) {
  SceneBuilder builder({.kn = 1, .tension = false});
  builder.ball({5, 5, 5}).ball({0.1, 0.2, 0}).surface(flat(4, 1));
  try {
    builder.build();
    ADD_FAILURE() << "no error";
  } catch (const InputError& error) {
    EXPECT_THAT(error.what(), testing::HasSubstr("ball 1: its centre (0.1, 0.2, 0) lies on surface 0, so "
                                                 "their contact has no direction"));
  }
}

TEST(Surface, RepeatsWithThePeriodicCell) {
  // A floor of exactly one cell, and a ball that hangs over its seam.
  SceneBuilder builder({.kn = 1, .tension = false});
  model::Surface floor = flat(4, 1);
  transform(floor, Mat3::Identity(), {2, 2, 0});
  floor.centre = {2, 2, 0};
  builder.surface(floor).periodic({4, 4, 20}, {true, true, false});
  for (const double x : {0.0, 1e-9, 0.05, 3.95, 2.0})
    for (const double y : {0.0, 0.02, 3.999}) {
      SceneBuilder one = builder;
      const Model model = one.ball({x, y, 0.75}).build();
      EXPECT_LT((assembly::contact_forces(model).force[0] - Vec3(0, 0, 0.25)).norm(), 1e-13) << x << " " << y;
    }
}

/// ∂(force, moment)/∂(u, θ) of the only ball, by central differences of the code's own forces.
Mat6 numerical_tangent(const Model& model) {
  constexpr double h = 1e-6;
  Mat6 k;
  for (int column = 0; column < 6; ++column) {
    const auto loads = [&](double step) {
      assembly::Displacement d{{Vec3::Zero()}, {Vec3::Zero()}};
      (column < 3 ? d.translation : d.rotation)[0][column % 3] = step;
      const assembly::BodyForces f = assembly::contact_forces(model, d);
      Vec6 v;
      v << f.force[0], f.moment[0];
      return v;
    };
    k.col(column) = -(loads(h) - loads(-h)) / (2 * h);
  }
  return k;
}

struct BallTangent {
  void add(std::int32_t /*a*/, std::int32_t /*b*/, const Mat12& block) { k += block.topLeftCorner<6, 6>(); }
  Mat6 k = Mat6::Zero();
};

// The geometric part included: none on a face, across the edge on an edge, all around at a corner.
TEST(Surface, HasTheConsistentTangentOnFacesEdgesAndCorners) {
  std::mt19937_64 random(11);
  std::uniform_real_distribution<double> uniform(-1, 1);
  std::array<int, 4> touched{};
  const Vec3 half(2, 1.5, 1);
  for (int k = 0; k < 300; ++k) {
    const Vec3 local = 1.7 * Vec3(2 * uniform(random), 1.5 * uniform(random), uniform(random));
    const Vec3 nearest = local.cwiseMax(-half).cwiseMin(half);
    const double distance = (local - nearest).norm();
    if (distance == 0 || distance > 0.99) continue;
    const Mat3 turn = random_rotation(random);
    model::Surface box = cuboid(half);
    transform(box, turn, Vec3::Zero());
    SceneBuilder builder({.kn = 1, .ks = 0.6, .tension = false, .friction = 1e3});
    Model model = builder.ball(turn * local).surface(box).build();
    // Give it a shear force.
    const std::vector<Vec3> u{0.01 * random_vector(random)};
    const std::vector<Vec3> theta{0.01 * random_vector(random)};
    assembly::BodyForces sum;
    assembly::ContactForceSum(model, true).advance(model, {model.bodies.position, u, theta, 1}, sum);
    const std::vector<Vec3> still{Vec3::Zero()};
    BallTangent tangent;
    assembly::assemble_tangent(model, {model.bodies.position, still, still, 1}, tangent);
    // Forces of order one over 2e-6: 1e-9 of rounding, and h² of curvature, larger near to edges.
    EXPECT_LT((tangent.k - numerical_tangent(model)).cwiseAbs().maxCoeff(), 1e-8 / distance);
    ++touched.at(static_cast<std::size_t>(((local - nearest).array() != 0).count()));
  }
  for (std::size_t k = 1; k < 4; ++k) EXPECT_GT(touched.at(k), 10);
}

TEST(SurfaceProblems, AreFound) {
  using Problem = model::SurfaceProblem::Kind;
  EXPECT_TRUE(model::problems_of(cuboid({1, 1, 1})).empty());
  EXPECT_TRUE(model::problems_of(flat(5, 1)).empty());
  model::Surface bad;
  bad.vertices = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, -1, 0}, {0, 0, 1}, {2, 0, 0}};
  bad.triangles = {{0, 1, 2}, {0, 1, 3}};
  auto found = model::problems_of(bad);
  ASSERT_EQ(found.size(), 1U);
  EXPECT_EQ(found[0].kind, Problem::inconsistent);
  EXPECT_EQ(found[0].place, Vec3(0.5, 0, 0));
  EXPECT_TRUE(model::orient(bad));
  EXPECT_TRUE(model::problems_of(bad).empty());
  bad.triangles = {{0, 1, 2}, {1, 0, 3}, {0, 1, 4}};
  found = model::problems_of(bad);
  ASSERT_EQ(found.size(), 1U);
  EXPECT_EQ(found[0].kind, Problem::branching);
  bad.triangles = {{0, 1, 2}, {0, 1, 5}};
  found = model::problems_of(bad);
  EXPECT_EQ(found.at(0).kind, Problem::inconsistent);
  EXPECT_EQ(found.at(1).kind, Problem::degenerate);
  EXPECT_EQ(found.at(1).first, 1);
}

TEST(SurfaceProblems, AMoebiusStripCannotBeOriented) {
  model::Surface strip;
  constexpr int count = 9;
  for (int k = 0; k < count; ++k)
    for (const double side : {-1.0, 1.0}) {
      const double angle = 2 * std::numbers::pi * k / count;
      const double twist = 0.5 * angle;
      const double r = 3 + side * std::cos(twist);
      strip.vertices.emplace_back(r * std::cos(angle), r * std::sin(angle), side * std::sin(twist));
    }
  for (int k = 0; k < count; ++k) {
    const int a = 2 * k;
    const bool last = k + 1 == count;
    const int c = last ? 1 : a + 2;
    const int d = last ? 0 : a + 3;
    strip.triangles.push_back({a, c, a + 1});
    strip.triangles.push_back({c, d, a + 1});
  }
  EXPECT_FALSE(model::orient(strip));
}

}  // namespace
}  // namespace eigengrain::test
