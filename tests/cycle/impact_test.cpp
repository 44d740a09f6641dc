// Impacts against closed forms: restitution of dashpots and of the hysteretic spring, and tests 1 to 5 of
// Chung and Ooi (Granular Matter 13:643, 2011; 7 and 8: spinning_impact_test.cpp). Planes are rigid. Steps
// are parts of the time of the impact.
#include "eigengrain/assembly/forces.hpp"
#include "eigengrain/measures/measure.hpp"

#include "support/laws.hpp"
#include "support/motion.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>
#include <numbers>

namespace eigengrain::test {
namespace {

using cycle::Cycle;

/// What is left of an impact, and what it went through.
struct Impact {
  Vec3 velocity;  ///< of ball 0 at the end
  Vec3 spin = Vec3::Zero();
  double overlap = 0;  ///< the largest
  double force = 0;    ///< the largest along the first normal, N
  double duration = 0;
};

/// Runs ball 0 from just before it touches a floor (or ball 1) until it is free again.
Impact run_impact(SceneBuilder builder, double dt) {
  Cycle cycle = cycle_of(std::move(builder), dt);
  const auto overlap = [&] {
    const auto& state = cycle.state();
    const double radius = state.model.bodies.radius[row_of(state, 0)];
    if (!state.model.walls.empty()) return radius - position_of(state, 0).z();
    return radius + state.model.bodies.radius[row_of(state, 1)] -
           (position_of(state, 1) - position_of(state, 0)).norm();
  };
  const auto closing = [&] {  // speed of the two sides along their normal
    const auto& state = cycle.state();
    if (!state.model.walls.empty()) return std::abs(velocity_of(state, 0).z());
    return std::abs((velocity_of(state, 1) - velocity_of(state, 0)).z());
  };
  while (overlap() <= 0) cycle.step();
  Impact impact;
  const double start = cycle.state().time - overlap() / closing();
  while (overlap() > 0) {
    impact.overlap = std::max(impact.overlap, overlap());
    impact.force = std::max(impact.force, std::abs(cycle.state().force[row_of(cycle.state(), 0)].z()));
    cycle.step();
  }
  impact.duration = cycle.state().time + overlap() / closing() - start;
  impact.velocity = velocity_of(cycle.state(), 0);
  if (cycle.state().turns()) impact.spin = spin_of(cycle.state(), 0);
  return impact;
}

/// A ball that falls on a floor, a third of a step before it touches.
SceneBuilder ball_on_floor(SceneBuilder builder, double radius, double mass, const Vec3& velocity,
                           double dt) {
  return builder.ball({0, 0, radius - 0.3 * dt * velocity.z()}, radius, mass)
      .moving(velocity)
      .plane({0, 0, 0}, {0, 0, 1});
}

double restitution_of(std::string_view law, Named named, double dt) {
  return run_impact(ball_on_floor(with_law(law, named), 1, 1, {0, 0, -1e-3}, dt), dt).velocity.z() / 1e-3;
}

/// The error of a restitution at this step and whether it is of first order in it.
void expect_restitution(std::string_view law, Named named, double expected, double dt, double tolerance) {
  const double coarse = restitution_of(law, named, 4 * dt);
  const double fine = restitution_of(law, named, dt);
  std::printf("%s: e %.7f, closed form %.7f, error %.1e; %.1e at four times the step\n",
              std::string(law).c_str(), fine, expected, fine - expected, coarse - expected);
  EXPECT_NEAR(fine, expected, tolerance);
  EXPECT_LT(std::abs(coarse - expected), 6 * tolerance);
}

// One contact, k = m = 1, of duration about π: 30,000 steps.
TEST(Restitution, OfLinearDashpotsWithTension) {
  for (const double beta : {0.05, 0.2, 0.5}) {
    const double e = std::exp(-std::numbers::pi * beta / std::sqrt(1 - beta * beta));
    expect_restitution("linear", {{"kn", 1}, {"beta_n", beta}}, e, 1e-4, 1e-4);
  }
}

TEST(Restitution, OfLinearDashpotsWithoutTension) {
  for (const double beta : {0.05, 0.2, 0.5}) {
    const double root = std::sqrt(1 - beta * beta);
    const double e =
        std::exp(-beta / root * (std::numbers::pi - std::atan2(2 * beta * root, 1 - 2 * beta * beta)));
    expect_restitution("linear", {{"kn", 1}, {"beta_n", beta}, {"no_tension", 1}}, e, 1e-4, 1e-4);
  }
}

TEST(Restitution, IsWhatTheLinearLawIsAskedFor) {
  for (const double e : {0.2, 0.6, 0.9})
    expect_restitution("linear", {{"kn", 1}, {"restitution", e}}, e, 1e-4, 1e-4);
}

TEST(Restitution, IsWhatHertzsLawIsAskedFor) {
  // E* such that the impact lasts about 3: 2.94 (15/16 m/(E*√R))^(2/5) v^(-1/5).
  for (const double e : {0.2, 0.4, 0.6, 0.8, 0.98})
    expect_restitution("hertz", {{"effective_young", 30}, {"restitution", e}}, e, 1e-4, 1e-4);
}

TEST(Restitution, OfHertzsDashpotIsTheSameAtAnyVelocity) {
  const double b = 0.3 * std::sqrt(1.2);
  const double e = std::exp(-std::numbers::pi * b / std::sqrt(1 - b * b));
  expect_restitution("hertz", {{"effective_young", 30}, {"beta_n", 0.3}}, e, 1e-4, 1e-4);
  expect_restitution("hertz", {{"effective_young", 3000}, {"beta_n", 0.3}}, e, 1e-5, 1e-4);
}

// No dashpot, no lag: the springs err only at the corners of their lines.
TEST(Restitution, OfTheHystereticSpringIsExact) {
  for (const double e : {0.3, 0.5, 0.9})
    expect_restitution("hysteretic", {{"kn", 1}, {"restitution", e}}, e, 1e-4, 1e-4);
}

// Two balls have the reduced mass: e of the relative velocity is the same.
TEST(Restitution, OfTwoUnequalBalls) {
  constexpr double dt = 1e-4;
  SceneBuilder builder = with_law("linear", {{"kn", 1}, {"beta_n", 0.2}});
  builder.ball({0, 0, 0}, 1, 2).moving({0, 0, 1e-3});
  builder.ball({0, 0, 1.5 + 0.4e-7}, 0.5, 0.25).moving({0, 0, -3e-3});
  Cycle cycle = cycle_of(std::move(builder), dt);
  cycle.run(20000);
  const double e = std::exp(-std::numbers::pi * 0.2 / std::sqrt(0.96));
  EXPECT_NEAR((velocity_of(cycle.state(), 1).z() - velocity_of(cycle.state(), 0).z()) / 4e-3, e, 1e-4);
}

/// E* and G* of two sides of one material, or of one with a rigid plane.
struct Elastic {
  double young;
  double poisson;
  double density;
  double effective_young(int sides) const { return young / (1 - poisson * poisson) / sides; }
  double effective_shear(int sides) const { return young / (2 * (1 + poisson) * (2 - poisson)) / sides; }
  double mass(double radius) const { return model::sphere_mass(radius, density); }
};

/// Largest overlap, largest force and duration of an elastic impact: numbers of Hertz's theory, for which
/// t = 2.9432752 δ/v.
void expect_hertz(const char* what, const Impact& found, double overlap, double force, double duration) {
  std::printf("%s: delta %.4f um, F %.5g N, t %.5f us\n", what, 1e6 * found.overlap, found.force,
              1e6 * found.duration);
  // The largest value among steps misses the top by (π/2 of a step over the duration)²/2, 1e-8; leapfrog errs
  // by (ωΔt)²/24. The rest is the rounding of the table.
  EXPECT_NEAR(found.overlap / (1e-6 * overlap), 1, 1e-5) << what;
  EXPECT_NEAR(found.force / force, 1, 1e-5) << what;
  EXPECT_NEAR(found.duration / (1e-6 * duration), 1, 1e-4) << what;
}

// Chung and Ooi, test 1: two equal spheres, R 10 mm, 10 m/s each.
TEST(ChungAndOoi, Test1TwoSpheres) {
  const auto collide = [](const Elastic& m, double duration) {
    const double dt = 1e-6 * duration / 10000;
    SceneBuilder builder = with_law("hertz", {{"effective_young", m.effective_young(2)}});
    builder.ball({0, 0, 0}, 0.01, m.mass(0.01)).moving({0, 0, 10});
    builder.ball({0, 0, 0.02 + 6 * dt}, 0.01, m.mass(0.01)).moving({0, 0, -10});
    return run_impact(std::move(builder), dt);
  };
  expect_hertz("glass", collide({48e9, 0.20, 2800}, 40.33946), 274.1127, 10696.9, 40.33946);
  expect_hertz("limestone", collide({20e9, 0.25, 2500}, 54.20100), 368.3040, 7108.24, 54.20100);
}

Impact on_plane(const Elastic& m, double radius, const Vec3& velocity, double duration, Named more = {}) {
  const double dt = 1e-6 * duration / 10000;
  SceneBuilder builder = with_law("hertz", more);
  builder.scene().contacts[0].parameters[0] = m.effective_young(1);
  builder.scene().contacts[0].parameters[1] = m.effective_shear(1);
  return run_impact(ball_on_floor(std::move(builder), radius, m.mass(radius), velocity, dt), dt);
}

// Tests 2 and 3: a sphere on a rigid plane.
TEST(ChungAndOoi, Test2And3SphereOnAPlane) {
  expect_hertz("Al alloy", on_plane({70e9, 0.30, 2699}, 0.1, {0, 0, -0.2}, 731.65664), 49.71718, 11369.9,
               731.65664);
  expect_hertz("Mg alloy", on_plane({40e9, 0.35, 1800}, 0.1, {0, 0, -0.2}, 767.06591), 52.12329, 7232.68,
               767.06591);
  const Elastic oxide{380e9, 0.23, 4000};
  const Elastic iron{100e9, 0.25, 7000};
  expect_hertz("Al oxide", on_plane(oxide, 2.5e-3, {0, 0, -3.9}, 6.10451), 8.08881, 615.352, 6.10451);
  expect_hertz("cast iron", on_plane(iron, 2.5e-3, {0, 0, -3.9}, 12.97208), 17.18871, 506.760, 12.97208);
  for (const double e : {0.2, 0.4, 0.6, 0.8}) {
    // Lag of the velocity: first order, 1e-4 of the duration.
    EXPECT_NEAR(on_plane(oxide, 2.5e-3, {0, 0, -3.9}, 6.10451, {{"restitution", e}}).velocity.z() / 3.9, e,
                1e-4);
    EXPECT_NEAR(on_plane(iron, 2.5e-3, {0, 0, -3.9}, 12.97208, {{"restitution", e}}).velocity.z() / 3.9, e,
                1e-4);
  }
}

/// Mean lever of friction over R. The closed forms take R; the contact point lies half an overlap nearer, R -
/// U/2, and over an elastic impact ∫F U dt/∫F dt = ½ B(7/5, 1/2) δ = 0.81757 δ (substitute z = (U/δ)^(5/2)).
double lever(const Impact& impact, double radius) {
  const double beta = std::tgamma(1.4) * std::tgamma(0.5) / std::tgamma(1.9);
  return 1 - 0.5 * (0.5 * beta) * impact.overlap / radius;
}

// Test 4: oblique, e 0.98, μ 0.092. Where it slides all the time, friction has the impulse μ(1 + e) m v_n
// (the dashpot's own impulse is zero: its c is a function of the overlap).
TEST(ChungAndOoi, Test4ObliqueWithFullSliding) {
  const Elastic oxide{380e9, 0.23, 4000};
  for (const double degrees : {40.0, 60.0, 80.0}) {
    const double angle = degrees * std::numbers::pi / 180;
    const Vec3 velocity(3.9 * std::sin(angle), 0, -3.9 * std::cos(angle));
    const double duration = 6.10451 * std::pow(std::cos(angle), -0.2);
    const Impact found =
        on_plane(oxide, 2.5e-3, velocity, duration, {{"restitution", 0.98}, {"friction", 0.092}});
    // First order in the step, as e; measured at 1e-4 of the duration.
    EXPECT_NEAR(found.velocity.x() / velocity.x(), 1 - 0.18216 / std::tan(angle), 1e-4) << degrees;
    EXPECT_NEAR(found.spin.y() / (710.42 * std::cos(angle)), lever(found, 2.5e-3), 1e-4) << degrees;
  }
}

// Test 5: R 10 µm, v_n 5 m/s, μ 0.3, e 1; sliding for v_t/(μ v_n) >= 7: Rω/(μ v_n) = 5 and v_t' = v_t - 2μ
// v_n.
TEST(ChungAndOoi, Test5TangentialImpactThatSlides) {
  for (const Elastic& m : {Elastic{208e9, 0.30, 7850}, Elastic{1e9, 0.40, 1400}}) {
    const double radius = 1e-5;
    const double delta =
        std::pow(15.0 / 16 * m.mass(radius) * 25 / (m.effective_young(1) * std::sqrt(radius)), 0.4);
    for (const double ratio : {8.0, 14.0, 40.0}) {
      const Vec3 velocity(ratio * 0.3 * 5, 0, -5);
      const Impact found = on_plane(m, radius, velocity, 1e6 * 2.9432752 * delta / 5, {{"friction", 0.3}});
      EXPECT_NEAR(radius * found.spin.y() / (0.3 * 5), 5 * lever(found, radius), 5e-6) << ratio;
      EXPECT_NEAR((velocity.x() - found.velocity.x()) / (0.3 * 5), 2, 2e-6) << ratio;
    }
  }
}

// What a floor feels of a dashpot: all that the ball feels, opposite.
TEST(Dashpots, AreAPartOfTheForceOnAWall) {
  constexpr double dt = 1e-3;
  Cycle cycle =
      cycle_of(ball_on_floor(with_law("linear", {{"kn", 1}, {"beta_n", 0.5}}), 1, 1, {0, 0, -1e-3}, dt), dt);
  for (int k = 0; k < 1000; ++k) {
    cycle.step();
    ASSERT_EQ(assembly::wall_forces(cycle.state().model)[0], Vec3(-cycle.state().force[0]));
  }
  // It is not the spring's alone: c v = 1e-3 is far more than k U in the beginning.
  EXPECT_GT(std::abs(cycle.state().force[0].z()), 1.1 * (1 - position_of(cycle.state(), 0).z()));
}

// A ball between two plates that near each other: the mean stress times the area is what the plates feel,
// dashpots included.
TEST(Dashpots, AreAPartOfTheStress) {
  constexpr double dt = 1e-3;
  SceneBuilder builder = with_law("linear", {{"kn", 1}, {"beta_n", 0.5}});
  builder.ball({0, 0, 0.999}).plane({0, 0, 0}, {0, 0, 1}).carried({0, 0, 1e-3});
  builder.plane({0, 0, 1.998}, {0, 0, -1}).carried({0, 0, -1e-3});
  Cycle cycle = cycle_of(std::move(builder), dt);
  cycle.run(10);
  const assembly::Model& model = cycle.state().model;
  const double felt = assembly::wall_forces(model)[1].z();
  const double overlap = 1 - 0.999 + 10 * dt * 1e-3;
  EXPECT_GT(felt, 1.5 * overlap);  // the spring has less than half of it
  // Inside the region, which the planes of the walls do not cut off from z = 0.2 to 1.8.
  const model::Region middle{"", model::BoxRegion{{-1, -1, 0.2}, {1, 1, 1.8}}};
  const Mat3 stress = measures::measure(model, std::vector{middle}).front().stress;
  EXPECT_NEAR(stress(2, 2), -felt / 4, 1e-14);
}

// Rolling on a floor, R* = R: the moment μ_r R F_n brakes the ball by 5/7 μ_r g.
TEST(Rolling, ResistanceBrakesABallByFiveSeventhsOfItsCoefficient) {
  constexpr double g = 0x1p-20;
  constexpr double mu_r = 0.01;
  constexpr double u0 = 1e-3;
  SceneBuilder builder = with_law(
      "linear",
      {{"kn", 1}, {"ks", 0.5}, {"friction", 0.5}, {"kr", 0.1}, {"rolling_friction", mu_r}, {"beta_s", 0.2}});
  builder.ball({0, 0, 1 - g}).moving({u0, 0, 0}, {0, u0, 0}).plane({0, 0, 0}, {0, 0, 1}).gravity({0, 0, -g});
  Cycle cycle = cycle_of(std::move(builder), 0.2);
  cycle.run(2000);  // until the shear spring has come to rest under the steady deceleration
  const double before = velocity_of(cycle.state(), 0).x();
  const double spin_before = spin_of(cycle.state(), 0).y();
  constexpr int steps = 5000;
  cycle.run(steps);
  const double braked = 5.0 / 7 * mu_r * g * steps * 0.2;
  // The contact point lies half an overlap behind the surface: U/2R = 5e-7 of the lever.
  EXPECT_NEAR((before - velocity_of(cycle.state(), 0).x()) / braked, 1, 1e-5);
  EXPECT_NEAR((spin_before - spin_of(cycle.state(), 0).y()) / braked, 1, 1e-5);
}

}  // namespace
}  // namespace eigengrain::test
