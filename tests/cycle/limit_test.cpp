// The true limit by running: bounded below, growing above, as the linear theory says to the number.
//
// One mode, started with the velocity v₀ at rest, has at the half steps (sin(θ/2) = ½ωΔt)
//   below the limit   v_{n+½} = v₀ cos((n + ½)θ)/cos(θ/2)        <= v₀/cos(θ/2): 22.4 at 0.999 of the limit
//   above it          v_{n+½} = (-1)ⁿ v₀ sinh((n + ½)η)/sinh(η/2), cosh(η/2) = ½ωΔt: η = 0.0894 at 1.001
// With local damping and z near -1 the velocity changes its sign at every step, so that the damping force is
// on the side of the resultant at every step, (1 + α)F, in all components alike as long as the mode is alone:
// the same with ω√(1 + α). A velocity along the mode starts in that state (F opposes it from the first step
// on).
#include "eigengrain/cycle/bounds.hpp"

#include "support/clusters.hpp"
#include "support/lattices.hpp"
#include "support/motion.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>

namespace eigengrain::test {
namespace {

using cycle::Cycle;

constexpr double amplitude = 1e-9;  // way of the first step over the radius

/// Largest |part| of the critical mode in the velocity over some steps, over that of the start; the step is
/// `of_limit` times the limit 2/√(λ_max(1 + α)).
double growth(const SceneBuilder& unmoved, const Modes& modes, double of_limit, int steps) {
  SceneBuilder builder = unmoved;
  const double alpha = builder.scene().local_damping;
  const double dt = of_limit * cycle::damped_timestep(2 / std::sqrt(modes.lambda_max()), alpha);
  const Eigen::Index mode = modes.critical();
  const double start = amplitude / dt / modes.largest(mode);
  modes.add_velocity(builder.scene(), mode, start);
  Cycle cycle = cycle_of(builder, dt);
  double most = 0;
  for (int k = 0; k < steps; ++k) {
    cycle.step();
    most = std::max(most, std::abs(modes.part(cycle.state(), mode)));
  }
  return most / start;
}

/// sinh((n - ½)η)/sinh(η/2) after n steps.
double growth_above(double of_limit, int steps) {
  const double eta = 2 * std::acosh(of_limit);
  return std::sinh((steps - 0.5) * eta) / std::sinh(eta / 2);
}

double bound_below(double of_limit) {
  return 1 / std::sqrt(1 - of_limit * of_limit);
}

void expect_limit(const SceneBuilder& builder, const char* what) {
  const System system(builder);
  const Modes modes(system);
  const double below = growth(builder, modes, 0.999, 1500);
  const double above = growth(builder, modes, 1.001, 120);
  const double barely_above = growth(builder, modes, 1.0001, 300);
  std::printf(
      "%s, alpha %.1f: %.3f at 0.999 (bound %.3f), %.4e at 1.001 (theory %.4e), %.4e at 1.0001 (%.4e)\n",
      what, SceneBuilder(builder).scene().local_damping, below, bound_below(0.999), above,
      growth_above(1.001, 120), barely_above, growth_above(1.0001, 300));
  // Rounding of positions, 1e-16 against ways of 1e-10, and overlaps of 1e-9 leave the theory some 1e-5,
  // grown as the mode itself grows.
  EXPECT_LT(below, bound_below(0.999) * 1.001) << what;
  EXPECT_GT(below, bound_below(0.999) * 0.98)
      << what;  // it does come that far: the step is not short of 0.999
  EXPECT_NEAR(above / growth_above(1.001, 120), 1, 0.01) << what;
  EXPECT_NEAR(barely_above / growth_above(1.0001, 300), 1, 0.01) << what;
}

TEST(Limit, OfRandomClustersIsWhereTheSpectrumSays) {
  for (const double alpha : {0.0, 0.2, 0.7})
    for (const int balls : {10, 25, 40}) {
      const SceneBuilder builder =
          unstressed_cluster(100 + static_cast<std::uint64_t>(balls), balls, {.kn = 1, .ks = 0.6}, alpha);
      expect_limit(builder, balls == 10 ? "10 balls" : balls == 25 ? "25 balls" : "40 balls");
    }
}

TEST(Limit, OfAFrictionlessClusterIsWhereTheSpectrumSays) {
  for (const double alpha : {0.0, 0.7})
    expect_limit(unstressed_cluster(7, 20, {.kn = 1, .ks = 0}, alpha), "20 balls without shear");
}

// At 1.001 the growth is e^0.0894 a step; after 300 steps a velocity of 1e-9 R a step would be 1e-9 · e^27.
TEST(Limit, IsLeftByAThousandthWithE0089AStep) {
  EXPECT_NEAR(2 * std::acosh(1.001), 0.0894, 1e-4);
  const SceneBuilder builder = unstressed_cluster(100, 12, {.kn = 1, .ks = 0.6}, 0.7);
  const System system(builder);
  const Modes modes(system);
  // By then far out of the linear range, where only that it has grown without bound can be said.
  EXPECT_FALSE(growth(builder, modes, 1.001, 300) < 1e7);
}

/// Largest velocity or surface velocity of any ball over some steps, over that of the start.
double lattice_growth(SceneBuilder lattice, double dt, int steps) {
  Cycle cycle = cycle_of(std::move(lattice), dt);
  const auto largest = [&] {
    double most = 0;
    for (const Vec3& v : cycle.state().model.bodies.velocity) most = std::max(most, v.norm());
    if (cycle.state().turns())
      for (const Vec3& w : cycle.state().model.bodies.spin) most = std::max(most, w.norm());
    return most;
  };
  const double start = largest();
  double most = 0;
  for (int k = 0; k < steps; ++k) {
    cycle.step();
    most = std::max(most, largest());
  }
  return most / start;
}

// 256 spheres in the periodic FCC lattice. Without shear λ_max = 8 k_n/m, of layers that move against each
// other along their normal; with k_s = ½ k_n it is 40 k_s/m, of all spheres turning alike (docs/theory.md).
TEST(Limit, OfThePeriodicFccLatticeIsItsClosedForm) {
  for (const double alpha : {0.0, 0.2, 0.7})
    for (const double ks : {0.0, 0.5}) {
      SceneBuilder lattice = make_lattice(face_centred(), {.kn = 1, .ks = ks}, {4, 4, 4});
      lattice.damped(alpha);
      const double lambda = ks > 0 ? 40 * ks : 8;
      const double limit = 2 / std::sqrt(lambda * (1 + alpha));
      model::Bodies& bodies = lattice.scene().bodies;
      const std::size_t count = bodies.position.size();
      const double start = amplitude / limit;
      bodies.velocity.assign(count, Vec3::Zero());
      bodies.spin.assign(count, ks > 0 ? Vec3(0, 0, start) : Vec3(Vec3::Zero()));
      const double layer = face_centred().cell.x() / 2;
      for (std::size_t i = 0; ks == 0 && i < count; ++i) {
        const bool even = std::lround(std::floor(bodies.position[i].x() / layer)) % 2 == 0;
        bodies.velocity[i].x() = even ? start : -start;
      }
      const double below = lattice_growth(lattice, 0.999 * limit, 1000);
      const double above = lattice_growth(lattice, 1.001 * limit, 120);
      const double barely_above = lattice_growth(lattice, 1.0001 * limit, 300);
      std::printf(
          "FCC, ks %.1f, alpha %.1f: %.3f at 0.999, %.4e at 1.001 (theory %.4e), %.4e at 1.0001 (%.4e)\n", ks,
          alpha, below, above, growth_above(1.001, 120), barely_above, growth_above(1.0001, 300));
      EXPECT_LT(below, bound_below(0.999) * 1.001);
      EXPECT_GT(below, bound_below(0.999) * 0.98);
      EXPECT_NEAR(above / growth_above(1.001, 120), 1, 0.01);
      EXPECT_NEAR(barely_above / growth_above(1.0001, 300), 1, 0.01);
    }
}

}  // namespace
}  // namespace eigengrain::test
