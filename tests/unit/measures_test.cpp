// Measures against closed forms: lattices, cut spheres, columns. k = 1 and R = 1 unless said.
#include "eigengrain/measures/measure.hpp"

#include "support/lattices.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <random>
#include <vector>

namespace eigengrain::test {
namespace {

using measures::Measure;
using model::BoxRegion;
using model::Region;
using model::SphereRegion;
using std::numbers::pi;

constexpr double ball = 4 * pi / 3;

/// Positive definite sums of some ten terms of order 1: a few ulps.
constexpr double rounding = 2e-15;

Measure measured(const assembly::Model& model, const Region& region = {}) {
  return measures::measure(model, std::vector{region}).front();
}

void expect_near(const Mat3& found, const Mat3& wanted, double tolerance) {
  EXPECT_LE((found - wanted).cwiseAbs().maxCoeff(), tolerance) << found << "\nwanted\n" << wanted;
}

Vec3 uniform_point(std::mt19937_64& random, double low, double high) {
  std::uniform_real_distribution<double> uniform(low, high);
  const double x = uniform(random);
  const double y = uniform(random);
  return {x, y, uniform(random)};
}

/// The integral of f over [-r, r] and [low, high], by the midpoint rule in t with x = -r cos t, which takes
/// the root out of the ends: exact to 1/1000² where f has kinks.
template <class Function>
double integral(double low, double high, double r, const Function& f) {
  constexpr int parts = 1000;
  const double begin = std::acos(std::clamp(-low / r, -1.0, 1.0));
  const double end = std::acos(std::clamp(-high / r, -1.0, 1.0));
  const double h = (end - begin) / parts;
  double sum = 0;
  for (int i = 0; i < parts; ++i) {
    const double t = begin + (i + 0.5) * h;
    sum += f(-r * std::cos(t), r * std::sin(t)) * r * std::sin(t) * h;
  }
  return sum;
}

/// Ball of radius 1 at the origin in a box, strip by strip.
double ball_in_box_by_strips(const BoxRegion& box) {
  return integral(box.min.x(), box.max.x(), 1, [&](double, double disk) {
    return integral(box.min.y(), box.max.y(), disk, [&](double, double half) {
      return std::max(std::min(half, box.max.z()) - std::max(-half, box.min.z()), 0.0);
    });
  });
}

TEST(PartialVolume, OfABallInASphereIsALens) {
  const SphereRegion sphere{Vec3(1, 2, 3), 2};
  const auto at = [&](double d, double r) {
    return measures::ball_inside(sphere, Vec3(1, 2, 3) + d * Vec3(2, -1, 2) / 3, r);
  };
  EXPECT_EQ(at(3.01, 1), 0);
  EXPECT_NEAR(at(0.5, 1), ball, rounding * ball);
  EXPECT_NEAR(at(0, 3), 8 * ball, rounding * 8 * ball);
  // Two caps: of the ball of radius r cut at distance c from its centre, π/3 (r - c)²(2r + c).
  const double d = 2.5;
  const double c = (d * d + 1 - 4) / (2 * d);  // of the ball with r = 1
  const double caps = pi / 3 * (std::pow(1 - c, 2) * (2 + c) + std::pow(2 - (d - c), 2) * (4 + d - c));
  EXPECT_NEAR(at(d, 1), caps, 4 * rounding);
}

TEST(PartialVolume, OfABallInABoxHasTheSimpleOnes) {
  constexpr double far = std::numeric_limits<double>::infinity();
  const auto inside = [](const Vec3& low, const Vec3& high) {
    return measures::ball_inside(BoxRegion{Vec3(1, 2, 3) + 2 * low, Vec3(1, 2, 3) + 2 * high}, Vec3(1, 2, 3),
                                 2) /
           8;
  };
  EXPECT_DOUBLE_EQ(inside(Vec3::Constant(-1), Vec3::Constant(1)), ball);
  EXPECT_DOUBLE_EQ(inside(Vec3::Zero(), Vec3::Constant(far)), ball / 8);
  EXPECT_DOUBLE_EQ(inside({-far, 0, 0}, Vec3::Constant(2)), ball / 4);
  EXPECT_DOUBLE_EQ(inside({-1, 0, -1}, Vec3::Constant(1)), ball / 2);
  const auto cap = [](double c) { return pi / 3 * (1 - c) * (1 - c) * (2 + c); };
  EXPECT_NEAR(inside({-2, -2, 0.3}, Vec3::Constant(2)), cap(0.3), rounding);
  EXPECT_NEAR(inside({-2, -2, -0.3}, Vec3::Constant(2)), cap(-0.3), rounding * 2);
  EXPECT_NEAR(inside({-2, -0.2, -2}, {2, 0.5, 2}), ball - cap(0.5) - cap(0.2), rounding * 4);
  EXPECT_EQ(inside({1, -2, -2}, Vec3::Constant(2)), 0);
  EXPECT_EQ(inside({0.6, 0.6, 0.6}, Vec3::Constant(2)), 0);  // 3 · 0.36 > 1: the corner is outside
  // A box that is inside the ball.
  EXPECT_NEAR(inside(Vec3(-0.3, -0.2, 0.1), Vec3(0.4, 0.5, 0.3)), 0.7 * 0.7 * 0.2, rounding * 10);
  // A corner just inside the ball: three planes at √(1/3) - h leave a tetrahedron with curved base, of height
  // √3 h along (1, 1, 1) and volume (√3 h)³ √3/2 = 9h³/2 for small h.
  const double h = 1e-4;
  EXPECT_NEAR(inside(Vec3::Constant(std::sqrt(1 / 3.0) - h), Vec3::Constant(2)) / (4.5 * h * h * h), 1, 1e-3);
}

TEST(PartialVolume, OfABallInABoxAgreesWithQuadrature) {
  std::mt19937_64 random(1);
  for (int k = 0; k < 20; ++k) {
    const Vec3 p = uniform_point(random, -1.2, 1.2);
    const Vec3 q = uniform_point(random, -1.2, 1.2);
    const BoxRegion box{p.cwiseMin(q), p.cwiseMax(q)};
    // Kinks of slope 1 in a midpoint rule of 1000 parts of up to π: some (π/1000)².
    EXPECT_NEAR(measures::ball_inside(box, Vec3::Zero(), 1), ball_in_box_by_strips(box), 2e-5);
  }
}

TEST(PartialVolume, OfABallSumsUpOverBoxesSideBySide) {
  std::mt19937_64 random(2);
  for (int k = 0; k < 2000; ++k) {
    Vec3 cut[4];
    cut[0] = Vec3::Constant(-2);
    cut[3] = Vec3::Constant(2);
    const Vec3 p = uniform_point(random, -1.3, 1.3);
    const Vec3 q = uniform_point(random, -1.3, 1.3);
    cut[1] = p.cwiseMin(q);
    cut[2] = p.cwiseMax(q);
    double sum = 0;
    for (int i = 0; i < 3; ++i)
      for (int j = 0; j < 3; ++j)
        for (int l = 0; l < 3; ++l)
          sum += measures::ball_inside(BoxRegion{{cut[i].x(), cut[j].y(), cut[l].z()},
                                                 {cut[i + 1].x(), cut[j + 1].y(), cut[l + 1].z()}},
                                       Vec3::Zero(), 1);
    // 27 sums of eight terms, each with a few ulps of the ball.
    ASSERT_NEAR(sum, ball, 27 * 8 * 1e-16 * ball);
  }
}

TEST(PartialLine, IsWhatABoxOrASphereCutsOut) {
  const BoxRegion box{Vec3::Zero(), Vec3(1, 2, 3)};
  EXPECT_DOUBLE_EQ(measures::line_inside(box, {-1, 1, 1}, {4, 0, 0}), 0.25);
  EXPECT_DOUBLE_EQ(measures::line_inside(box, {0.5, 1, 1}, {-1, 0, 0}), 0.5);
  EXPECT_DOUBLE_EQ(measures::line_inside(box, {-0.5, 0.5, 1.5}, {1, 1, 0}), 0.5);
  EXPECT_EQ(measures::line_inside(box, {-0.5, 2.5, 1.5}, {1, 1, 0}), 0);
  EXPECT_EQ(measures::line_inside(box, {0, 0.5, 1}, {0, 1, 0}), 1);  // in the lower face
  EXPECT_EQ(measures::line_inside(box, {1, 0.5, 1}, {0, 1, 0}), 0);  // in the upper one
  const SphereRegion sphere{Vec3(1, 0, 0), 1};
  EXPECT_DOUBLE_EQ(measures::line_inside(sphere, {-1, 0, 0}, {4, 0, 0}), 0.5);
  EXPECT_DOUBLE_EQ(measures::line_inside(sphere, {1, 0, 0}, {0, 4, 0}), 0.25);
  EXPECT_DOUBLE_EQ(measures::line_inside(sphere, {-1, 0.6, 0}, {4, 0, 0}), 0.4);
  EXPECT_EQ(measures::line_inside(sphere, {-1, 1.1, 0}, {4, 0, 0}), 0);
  EXPECT_EQ(measures::line_inside(sphere, {2.5, 0, 0}, {1, 0, 0}), 0);
}

/// A lattice strained by diag(e) from touching, frictionless, k = 1.
SceneBuilder strained(const Lattice& lattice, const Vec3& strain) {
  SceneBuilder builder = make_lattice(lattice, {.kn = 1, .tension = false}, {3, 3, 3});
  const Vec3 stretch = Vec3::Ones() + strain;
  for (Vec3& x : builder.scene().bodies.position) x = x.cwiseProduct(stretch);
  builder.scene().cell.edges = builder.scene().cell.edges * stretch.asDiagonal();
  return builder;
}

/// Regions that must all show the same in a lattice: all of it, and cells of it wherever they begin.
std::vector<Region> cells_of(const model::Scene& scene) {
  std::vector<Region> regions{{"all", {}}};
  const Vec3 cell = scene.cell.lengths() / 3;
  std::mt19937_64 random(3);
  for (int k = 0; k < 5; ++k) {
    const Vec3 corner = uniform_point(random, -20, 20);
    regions.push_back({"cell", BoxRegion{corner, corner + cell}});
  }
  regions.push_back({"larger than the cell", BoxRegion{Vec3::Constant(0.3), Vec3::Constant(0.3) + 5 * cell}});
  return regions;
}

// Per site SC has 3 contacts in a volume d³ and FCC 6 in d³/√2: σ = -F/d² and -2√2 F/d².
TEST(Stress, OfLatticesUnderIsotropicStrain) {
  const double strain = -0.01;
  for (const auto& [lattice, factor] :
       {std::pair(simple_cubic(), 1.0), std::pair(face_centred(), 2 * std::sqrt(2.0))}) {
    SceneBuilder builder = strained(lattice, Vec3::Constant(strain));
    const assembly::Model model = builder.build();
    const double d = 2 * touching * (1 + strain);
    const Mat3 wanted = -factor * (2 - d) / (d * d) * Mat3::Identity();
    for (const Measure& m : measures::measure(model, cells_of(builder.scene())))
      // Overlaps of 0.02 from positions of 20, an ulp of which is 4e-15; the parts sum up some 100 lines.
      expect_near(m.stress, wanted, 1e-11 * std::abs(wanted(0, 0)));
  }
}

// Lines in the faces of a box count in one of the boxes side by side. All numbers here are exact in binary.
TEST(Stress, OfCellsWithBodiesInTheirFaces) {
  constexpr double d = 2 - 1 / 64.0;
  SceneBuilder builder({.kn = 1, .tension = false});
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j)
      for (int k = 0; k < 3; ++k) builder.ball(d * Vec3(i, j, k));
  builder.periodic(Vec3::Constant(3 * d));
  const assembly::Model model = builder.build();
  for (const double corner : {0.0, d, 2 * d, -d}) {
    const Measure m = measured(model, {"", BoxRegion{Vec3::Constant(corner), Vec3::Constant(corner + d)}});
    expect_near(m.stress, -1 / 64.0 / (d * d) * Mat3::Identity(), 1e-17);
    EXPECT_EQ(m.fabric.bodies, 1);
    EXPECT_EQ(m.fabric.coordination, 6);
  }
}

// Along z alone. SC: the contacts along z only. FCC: (±1, 0, 1) and (0, ±1, 1), F = 2 - ℓ, ℓ their length.
TEST(Stress, OfLatticesUnderUniaxialStrain) {
  const double strain = -0.02;
  const double stretch = 1 + strain;
  const double d = 2 * touching;
  {
    SceneBuilder builder = strained(simple_cubic(), {0, 0, strain});
    Mat3 wanted = Mat3::Zero();
    wanted(2, 2) = -(2 - d * stretch) / (d * d);
    for (const Measure& m : measures::measure(builder.build(), cells_of(builder.scene())))
      expect_near(m.stress, wanted, 2e-12);  // contacts across z have an overlap of 2e-12
  }
  SceneBuilder builder = strained(face_centred(), {0, 0, strain});
  const double a = d / std::sqrt(2.0);
  const double length = a * std::sqrt(1 + stretch * stretch);
  const double force = 2 - length;
  const double volume = d * d * d / std::sqrt(2.0) * stretch;
  const double across = -2 * force * a * a / length / volume;
  const Mat3 wanted =
      Vec3(across, across, -4 * force * a * a * stretch * stretch / length / volume).asDiagonal();
  for (const Measure& m : measures::measure(builder.build(), cells_of(builder.scene())))
    expect_near(m.stress, wanted, 4e-12);
}

// A column at rest: each layer carries what stands above it, σ_zz = -N(z)/A between two centres.
TEST(Stress, InAColumnIsTheWeightAboveOverTheArea) {
  constexpr double kn = 1000;
  constexpr int balls = 5;
  SceneBuilder builder({.kn = kn, .tension = false});
  double z = 0;
  for (int i = 0; i < balls; ++i) {
    // n-th contact from below: with the floor 1 - U, between balls 2 - U.
    z += (i == 0 ? 1 : 2) - (balls - i) / kn;
    builder.ball({0.5, 0.5, z});
  }
  builder.plane(Vec3::Zero(), Vec3::UnitZ()).gravity({0, 0, -1});
  const assembly::Model model = builder.build();
  const auto slab = [&](double low, double high) {
    return measured(model, {"slab", BoxRegion{{-1, -1, low}, {2, 1, high}}}).stress(2, 2);
  };
  const double area = 6;
  EXPECT_NEAR(slab(0, 0.1), -5 / area, 1e-12);
  EXPECT_NEAR(slab(1.2, 2.8), -4 / area, 1e-12);
  // Half of the way above the ball and half below it.
  EXPECT_NEAR(slab(model.bodies.position[1].z() - 0.1, model.bodies.position[1].z() + 0.1), -3.5 / area,
              1e-12);
  // Of bodies: f ⊗ R over the ball's volume, with what stands above and the weight itself.
  const std::vector<Mat3> bodies = measures::body_stresses(model);
  for (std::size_t i = 0; i < balls; ++i) {
    const double below = balls - static_cast<double>(model.bodies.identity[i]);
    const double above = below - 1;
    EXPECT_NEAR(bodies[i](2, 2), -(below * (1 - 0.5 * below / kn) + above * (1 - 0.5 * above / kn)) / ball,
                1e-12);
  }
}

// V σ is what boundary forces do: shared out over boxes side by side, and over the bodies, nothing is lost.
TEST(Stress, SumsUpOverBoxesAndBodies) {
  std::mt19937_64 random(4);
  SceneBuilder builder = random_cluster(random, 40, {.kn = 1, .ks = 0.4, .tension = false});
  assembly::Model model = builder.build();
  model.contacts.for_each_group([&](auto& group) {
    if constexpr (requires { group.states.front().shear; })
      for (auto& state : group.states) state.shear = 1e-3 * state.normal.unitOrthogonal();
  });
  const BoxRegion all{Vec3::Constant(-60), Vec3::Constant(60)};
  const Mat3 whole = measured(model, {"", all}).stress * std::pow(120, 3);
  Mat3 sum = Mat3::Zero();
  for (const double low : {-60.0, 0.25})
    for (const double left : {-60.0, -1.0}) {
      const BoxRegion part{{left, -60, low}, {left < -30 ? -1.0 : 60, 60, low < -30 ? 0.25 : 60}};
      sum += measured(model, {"", part}).stress * (part.max - part.min).prod();
    }
  EXPECT_GT(whole.norm(), 1);
  EXPECT_GT((whole - whole.transpose()).norm(), 1e-4);  // shear without equilibrium
  expect_near(sum, whole, 1e-13 * whole.norm());
  Mat3 bodies = Mat3::Zero();
  const std::vector<Mat3> of_bodies = measures::body_stresses(model);
  for (std::size_t i = 0; i < of_bodies.size(); ++i)
    bodies += ball * std::pow(model.bodies.radius[i], 3) * of_bodies[i];
  expect_near(bodies, whole, 1e-13 * whole.norm());
}

TEST(Strain, OfAnAffineVelocityFieldIsItsGradient) {
  std::mt19937_64 random(5);
  SceneBuilder builder = random_cluster(random, 60, {});
  Mat3 gradient;
  gradient << 0.3, -2, 1, 0.5, 0.1, 0, 7, 0.01, -0.4;
  for (const Vec3& x : builder.scene().bodies.position)
    builder.scene().bodies.velocity.emplace_back(Vec3(5, 6, 7) + gradient * x);
  const assembly::Model model = builder.build();
  for (const Region& region : {Region{}, Region{"", SphereRegion{Vec3::Zero(), 5}}}) {
    const Measure m = measured(model, region);
    ASSERT_TRUE(m.velocity_gradient.has_value());
    expect_near(*m.velocity_gradient, gradient, 1e-13);
    expect_near(*m.strain_rate(), 0.5 * (gradient + gradient.transpose()), 1e-13);
  }
}

TEST(Strain, IsOpenWhereTheCentresLieInAPlane) {
  SceneBuilder builder;
  builder.ball({0, 0, 1}).ball({3, 0, 1}).ball({0, 3, 1}).ball({4, 4, 1});
  EXPECT_FALSE(measured(builder.build()).velocity_gradient.has_value());
  builder.ball({1, 1, 4});
  EXPECT_TRUE(measured(builder.build()).velocity_gradient.has_value());
}

TEST(Porosity, OfLatticesAndOfACutBall) {
  for (const auto& [lattice, solid] :
       {std::pair(simple_cubic(), pi / 6), std::pair(face_centred(), pi / std::sqrt(18.0))}) {
    SceneBuilder builder = make_lattice(lattice, {}, {3, 3, 3});
    // 1e-12 is the relative overlap of `touching`, thrice in the volume.
    for (const Measure& m : measures::measure(builder.build(), cells_of(builder.scene())))
      EXPECT_NEAR(m.porosity, 1 - solid, 4e-12);
  }
  SceneBuilder one;
  one.ball({0.5, 0, 0});
  const assembly::Model model = one.build();
  EXPECT_NEAR(measured(model, {"", BoxRegion{{0.5, 0, 0}, {2.5, 2, 2}}}).porosity, 1 - ball / 8 / 8,
              rounding);
  EXPECT_NEAR(measured(model, {"", SphereRegion{{0.5, 0, 0}, 2}}).porosity, 1 - 1 / 8.0, rounding);
  // Two equal spheres a radius apart: the lens is 5π/12.
  EXPECT_NEAR(measured(model, {"", SphereRegion{{1.5, 0, 0}, 1}}).porosity, 1 - 5 / 16.0, rounding);
  // All of it: the box that the balls reach.
  EXPECT_NEAR(measured(model).porosity, 1 - pi / 6, rounding);
}

TEST(Fabric, OfLattices) {
  for (const auto& [lattice, contacts] : {std::pair(simple_cubic(), 6), std::pair(face_centred(), 12)}) {
    SceneBuilder builder = make_lattice(lattice, {.kn = 1, .tension = false}, {3, 3, 3});
    for (const Measure& m : measures::measure(builder.build(), cells_of(builder.scene()))) {
      EXPECT_EQ(m.fabric.coordination, contacts);
      EXPECT_EQ(m.fabric.without_rattlers, contacts);
      EXPECT_EQ(m.fabric.rattlers, 0);
      EXPECT_EQ(m.fabric.sliding, 0);
      expect_near(m.fabric.tensor, Mat3::Identity() / 3, 1e-14);
    }
  }
}

TEST(Fabric, OfOneContactIsItsNormalAndOfNoneIsOpen) {
  SceneBuilder builder({.kn = 1, .tension = false});
  builder.ball({0, 0, 0}).ball({1.9 * 0.6, 0, 1.9 * 0.8}).ball({9, 9, 9});
  const assembly::Model model = builder.build();
  const Vec3 n(0.6, 0, 0.8);
  const Measure m = measured(model);
  expect_near(m.fabric.tensor, n * n.transpose(), rounding);
  EXPECT_DOUBLE_EQ(m.fabric.coordination, 2 / 3.0);
  EXPECT_EQ(m.fabric.rattlers, 3);
  EXPECT_TRUE(std::isnan(m.fabric.without_rattlers));
  const Measure none = measured(model, {"", SphereRegion{{9, 9, 9}, 0.5}});
  EXPECT_EQ(none.fabric.bodies, 1);
  EXPECT_EQ(none.fabric.coordination, 0);
  EXPECT_TRUE(std::isnan(none.fabric.sliding));
  const Measure empty = measured(model, {"", SphereRegion{{19, 9, 9}, 0.5}});
  EXPECT_EQ(empty.fabric.bodies, 0);
  EXPECT_TRUE(std::isnan(empty.fabric.coordination));
  EXPECT_EQ(empty.porosity, 1);
  EXPECT_FALSE(empty.velocity_gradient.has_value());
}

// A ring of three with a chain of three on it: with friction the chain goes link by link, the ring stays.
TEST(Rattlers, AreRemovedUntilNoneIsLeft) {
  const auto ring_and_chain = [](double ks, model::FixedComponents end) {
    SceneBuilder builder({.kn = 1, .ks = ks, .tension = false});
    const double d = 1.99;
    builder.ball({0, 0, 0}).ball({d, 0, 0}).ball({d / 2, d * std::sqrt(0.75), 0});
    for (int k = 1; k <= 3; ++k)
      builder.ball({d + k * d, 0, 0}, 1, 1, k == 3 ? end : model::FixedComponents{});
    return measured(builder.build()).fabric;
  };
  const measures::Fabric frictional = ring_and_chain(0.5, {});
  EXPECT_EQ(frictional.rattlers, 3);
  EXPECT_DOUBLE_EQ(frictional.coordination, 2);
  EXPECT_EQ(frictional.without_rattlers, 2);
  // Held at its end the chain is loaded as the ring is: three balls of two contacts and one of three, the
  // end of one.
  EXPECT_EQ(ring_and_chain(0.5, fix_all).rattlers, 0);
  // Without friction two contacts hold nothing.
  EXPECT_EQ(ring_and_chain(0, {}).rattlers, 6);
}

TEST(Rattlers, NeedFourContactsWithoutFrictionOrThreeAndTheirWeight) {
  SceneBuilder builder({.kn = 1, .tension = false});
  builder.ball({0.99, 0.99, 0.99});
  for (int k = 0; k < 3; ++k) builder.plane(Vec3::Zero(), Vec3::Unit(k));
  EXPECT_EQ(measured(builder.build()).fabric.rattlers, 1);
  EXPECT_EQ(measured(builder.gravity({-1, -1, -1}).build()).fabric.rattlers, 0);
}

TEST(Rattlers, NeedOneContactLessInAPlane) {
  constexpr model::FixedComponents in_plane{0b011100};
  SceneBuilder builder({.kn = 1, .tension = false});
  builder.ball(Vec3::Zero(), 1, 1, in_plane);
  for (const double degrees : {0.0, 120.0, 240.0}) {
    const double angle = degrees * std::numbers::pi / 180;
    const Vec3 n(std::cos(angle), std::sin(angle), 0);
    builder.plane(-0.99 * n, n);
  }
  EXPECT_EQ(measured(builder.build()).fabric.rattlers, 0);
}

TEST(Sliding, IsSeenAtTheLimitAndNotBelow) {
  SceneBuilder builder({.kn = 1, .ks = 0.5, .tension = false, .friction = 0.5});
  for (int k = 0; k < 4; ++k) builder.ball({3.0 * k, 0, 0.9});
  builder.plane(Vec3::Zero(), Vec3::UnitZ());
  assembly::Model model = builder.build();
  const double limit = 0.5 * 0.1;
  model.contacts.for_each_group([&](auto& group) {
    if constexpr (requires { group.states.front().shear; }) {
      ASSERT_EQ(group.size(), 4);
      group.states[0].shear = {limit, 0, 0};
      group.states[1].shear = {0.6 * limit * (1 + 1e-15), 0.8 * limit, 0};
      group.states[2].shear = {0.99 * limit, 0, 0};  // and the last has none
    }
  });
  EXPECT_EQ(measured(model).fabric.sliding, 0.5);
}

// Without shear the part of F across n is rounding, of which nothing can be said; springs with tension never
// slide.
TEST(Sliding, IsNotSeenInTheRoundingOfTheNormalForce) {
  std::mt19937_64 random(3);
  for (const bool tension : {true, false}) {
    SceneBuilder builder({.kn = 1, .ks = 0.5, .tension = tension, .friction = 0.5});
    for (int k = 0; k < 200; ++k) {
      const Vec3 centre(10.0 * k, 0, 0);
      builder.ball(centre).ball(centre + 1.99 * random_vector(random).normalized());
    }
    EXPECT_EQ(measured(builder.build()).fabric.sliding, 0) << tension;
  }
}

}  // namespace
}  // namespace eigengrain::test
