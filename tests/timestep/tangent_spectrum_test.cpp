// What K leaves out: columns under load have closed forms, and contacts that slip in a run are met as they
// are.
#include "eigengrain/timestep/tangent_spectrum.hpp"

#include "eigengrain/timestep/truth.hpp"

#include "support/motion.hpp"
#include "support/tangents.hpp"

#include <Eigen/Eigenvalues>
#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>
#include <numbers>
#include <random>

namespace eigengrain::test {
namespace {

using cycle::Cycle;
using timestep::growth_per_step;
using timestep::tangent_spectrum;
using timestep::TangentSpectrum;

double sine_squared(double angle) {
  return std::sin(angle) * std::sin(angle);
}

// Balls in a row between two flat walls, pressed by U everywhere, without friction: across the row each
// contact of two balls has -F/d, a wall has nothing, so that λ_j = -4 F/(d m) sin²(jπ/2N), j = 0..N-1.
TEST(TangentSpectrum, OfAColumnBetweenWallsHasTheNegativeStiffnessOfItsForce) {
  for (const double overlap : {1e-6, 1e-3, 0.1}) {
    constexpr int n = 7;
    const double d = 2 - overlap;
    SceneBuilder builder({.kn = 1, .ks = 0, .tension = false});
    for (int i = 0; i < n; ++i) builder.ball({i * d, 0, 0});
    builder.plane({overlap - 1, 0, 0}, Vec3::UnitX())
        .plane({(n - 1) * d + 1 - overlap, 0, 0}, -Vec3::UnitX());
    const TangentSpectrum s = tangent_spectrum(builder.build());
    const double force = overlap;  // k_n = 1
    const double expected = -4 * force / d * sine_squared((n - 1) * std::numbers::pi / (2 * n));
    EXPECT_NEAR(s.sticking.least.value.real(), expected, 1e-13);
    EXPECT_NEAR(s.elastic.least.value.real(), 0, 1e-13);
    // Along the row nothing turns.
    EXPECT_NEAR(s.sticking.largest.value.real(), s.elastic.largest.value.real(), 1e-13);
    EXPECT_NEAR(s.elastic.largest.value.real() / System(builder).spectrum().maxCoeff(), 1, 1e-13);
    EXPECT_EQ(s.sliding, 0);
    EXPECT_EQ(s.complex_pairs, 0);
    EXPECT_GT(growth_per_step(s.sticking.least.value, 1.0), 1);  // it buckles at any step
  }
}

// Held at both ends and without rotations the row is a string with the stiffness k_s - F/d: it buckles at F =
// k_s d.
TEST(TangentSpectrum, OfAHeldColumnPassesZeroWhereItBuckles) {
  constexpr int n = 5;
  constexpr double ks = 0.01;
  for (const double of_load : {0.5, 0.99, 1.01}) {
    const double overlap = 2 * of_load * ks / (1 + of_load * ks);  // k_n U/(2 - U) = of_load k_s
    SceneBuilder builder({.kn = 1, .ks = ks, .tension = false});
    for (int i = 0; i < n + 2; ++i)
      builder.ball({0, 0, i * (2 - overlap)}, 1, 1, i == 0 || i == n + 1 ? fix_all : fix_rotations);
    const TangentSpectrum s = tangent_spectrum(builder.build());
    const double across = 4 * ks * (1 - of_load);
    const double expected = across * sine_squared((across > 0 ? 1 : n) * std::numbers::pi / (2 * (n + 1)));
    EXPECT_NEAR(s.sticking.least.value.real() / expected, 1, 1e-9) << of_load;
    EXPECT_NEAR(s.elastic.least.value.real(), 4 * ks * sine_squared(std::numbers::pi / (2 * (n + 1))), 1e-13);
    EXPECT_NEAR(s.sticking.largest.value.real(), 4 * sine_squared(n * std::numbers::pi / (2 * (n + 1))),
                1e-12);
  }
}

/// Grains that slide over each other on a floor that is shaken.
assembly::Model sliding_bed(int balls) {
  std::mt19937_64 random(3);
  std::uniform_real_distribution<double> uniform(-1, 1);
  SceneBuilder builder({.kn = 1000, .ks = 700, .tension = false, .friction = 0.2});
  const int edge = static_cast<int>(std::ceil(std::cbrt(balls)));
  for (int i = 0; i < balls; ++i)
    builder
        .ball({2.05 * (i % edge) + 0.02 * uniform(random), 2.05 * (i / edge % edge) + 0.02 * uniform(random),
               1 + 2.02 * (i / (edge * edge))})
        .moving({uniform(random), uniform(random), 0});
  builder.plane(Vec3::Zero(), Vec3::UnitZ()).gravity({0.3, 0, -1});
  const double width = 2.05 * (edge - 1) + 1.05;
  builder.plane({-1.05, 0, 0}, Vec3::UnitX()).plane({width, 0, 0}, -Vec3::UnitX());
  builder.plane({0, -1.05, 0}, Vec3::UnitY()).plane({0, width, 0}, -Vec3::UnitY());
  Cycle cycle = cycle_of(builder, 0.005);
  cycle.run(1500);
  return cycle.state().model;
}

TEST(TangentSpectrum, OfABedThatSlidesIsThatOfItsForces) {
  const assembly::Model model = sliding_bed(27);
  const TangentSpectrum s = tangent_spectrum(model);
  std::printf(
      "%ld of %ld contacts slide; largest elastic %.6e, sticking %.6e, slipping %.6e; %ld complex pairs, "
      "widest "
      "%.4e%+.4ei, least %.4e\n",
      static_cast<long>(s.sliding), static_cast<long>(s.contacts), s.elastic.largest.value.real(),
      s.sticking.largest.value.real(), s.slipping.largest.value.real(), static_cast<long>(s.complex_pairs),
      s.widest.value.real(), s.widest.value.imag(), s.slipping.least.value.real());
  ASSERT_GT(s.sliding, 3);
  EXPECT_GT(s.contacts, s.sliding);
  EXPECT_NEAR(s.elastic.largest.value.real(),
              timestep::critical_timestep(assembly::LinearSystem(model)).lambda_max,
              1e-9 * s.elastic.largest.value.real());
  // What turns is of the size of the overlaps, 1e-3 of the radius.
  EXPECT_NEAR(s.sticking.largest.value.real() / s.elastic.largest.value.real(), 1, 1e-2);
  EXPECT_NE(s.sticking.largest.value.real(), s.elastic.largest.value.real());

  // The matrix itself, against forces: M⁻¹ of them along the fastest direction of slip is what the law does.
  DenseTangent slipping(model);
  const std::vector<Vec3> still(model.bodies.position.size(), Vec3::Zero());
  const assembly::Trial here{model.bodies.position, still, still, 1.0};
  assembly::assemble_tangent(model, here, slipping, assembly::Slip::continuing);
  DenseTangent sticking(model);
  assembly::assemble_tangent(model, here, sticking, assembly::Slip::none);
  EXPECT_GT((slipping.k - slipping.k.transpose()).norm(), 1e-2 * slipping.k.norm());
  EXPECT_GT((slipping.k - sticking.k).norm(), 1e-2 * slipping.k.norm());
}

TEST(TangentSpectrum, IterationFindsTheEndsThatTheDenseOneHas) {
  const assembly::Model model = sliding_bed(64);
  const TangentSpectrum s = tangent_spectrum(model);
  EXPECT_EQ(s.complex_pairs, -1);
  ASSERT_GT(s.sliding, 3);
  DenseTangent tangent(model);
  const std::vector<Vec3> still(model.bodies.position.size(), Vec3::Zero());
  assembly::assemble_tangent(model, assembly::Trial{model.bodies.position, still, still, 1.0}, tangent,
                             assembly::Slip::continuing);
  const Eigen::VectorXd mass = [&] {
    Eigen::VectorXd m(6 * model.bodies.size());
    for (Eigen::Index i = 0; i < model.bodies.size(); ++i) {
      m.segment<3>(6 * i).setConstant(model.bodies.mass[static_cast<std::size_t>(i)]);
      m.segment<3>(6 * i + 3).setConstant(model.bodies.inertia[static_cast<std::size_t>(i)]);
    }
    return m;
  }();
  const Eigen::VectorXcd all =
      Eigen::EigenSolver<Eigen::MatrixXd>(mass.cwiseInverse().asDiagonal() * tangent.k, false).eigenvalues();
  const double largest = all.real().maxCoeff();
  EXPECT_NEAR(s.slipping.largest.value.real() / largest, 1, 1e-7);
  EXPECT_LT(s.slipping.largest.residual, 1e-7);
  if (s.widest.found()) {
    EXPECT_NEAR(s.widest.value.imag(), all.imag().maxCoeff(), 1e-6 * largest);
  }
  if (s.slipping.least.found()) {
    EXPECT_NEAR(s.slipping.least.value.real(), all.real().minCoeff(), 1e-6 * largest);
  }
}

TEST(TangentSpectrum, GrowthOfAStep) {
  EXPECT_NEAR(growth_per_step(3.9, 1), 1, 1e-12);
  EXPECT_NEAR(growth_per_step(4 * 1.001 * 1.001, 1), std::exp(2 * std::acosh(1.001)), 1e-12);
  // Flutter: z = e^{±iωΔt} with ω = √λ complex, at small steps e^{Im ω Δt}.
  const std::complex<double> lambda(1, 0.1);
  EXPECT_NEAR(std::log(growth_per_step(lambda, 1e-3)) / 1e-3, std::abs(std::sqrt(lambda).imag()), 1e-6);
  EXPECT_NEAR(std::log(growth_per_step(-1, 1e-3)) / 1e-3, 1, 1e-6);
}

}  // namespace
}  // namespace eigengrain::test
