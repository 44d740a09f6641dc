// Who carries the modes of the largest eigenvalues, against closed forms and against what a little more mass
// or stiffness does.
#include "eigengrain/timestep/limiting_modes.hpp"

#include "eigengrain/cycle/lift.hpp"

#include "support/clumps.hpp"
#include "support/lattices.hpp"

#include <Eigen/Eigenvalues>
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <numeric>
#include <random>

namespace eigengrain::test {
namespace {

using timestep::limiting_modes;
using timestep::LimitingMode;
using timestep::LimitingModes;

TEST(LimitingModes, OfTwoBallsAreKnown) {
  SceneBuilder builder({.kn = 1});
  builder.ball({0, 0, 0}).ball({2 - 1e-9, 0, 0}, 1, 3);
  const assembly::Model model = builder.build();
  const LimitingModes limits = limiting_modes(model, 4);
  ASSERT_EQ(limits.modes.size(), 1U);  // the five other motions of three unknowns each are free
  const LimitingMode& mode = limits.modes[0];
  EXPECT_NEAR(mode.lambda, 4.0 / 3, 1e-14);
  EXPECT_NEAR(mode.participation, 1 / (9.0 / 16 + 1.0 / 16), 1e-13);
  EXPECT_NEAR(mode.translation, 1, 1e-14);
  ASSERT_EQ(mode.bodies.size(), 2U);
  EXPECT_EQ(model.bodies.identity[static_cast<std::size_t>(mode.bodies[0].row)], 0);
  EXPECT_NEAR(mode.bodies[0].share, 0.75, 1e-14);
  ASSERT_EQ(mode.contacts.size(), 1U);
  EXPECT_NEAR(mode.contacts[0].share, 1, 1e-14);
  EXPECT_NEAR(limits.dt_heavier / mode.dt, std::sqrt(2), 1e-13);
  EXPECT_NEAR(limits.dt_softer / mode.dt, std::sqrt(2), 1e-13);
}

TEST(LimitingModes, OfAFreeChainAreItsShortestWaves) {
  constexpr int balls = 40;  // beyond what is solved as a dense matrix
  SceneBuilder builder({.kn = 1});
  for (int i = 0; i < balls; ++i) builder.ball({(2 - 1e-12) * i, 0, 0});
  const LimitingModes limits = limiting_modes(builder.build(), 5);
  ASSERT_EQ(limits.modes.size(), 5U);
  for (int k = 0; k < 5; ++k) {
    const double sine = std::sin(0.5 * std::numbers::pi * (balls - 1 - k) / balls);
    EXPECT_NEAR(limits.modes[static_cast<std::size_t>(k)].lambda, 4 * sine * sine, 1e-11) << k;
    EXPECT_LT(limits.modes[static_cast<std::size_t>(k)].residual, 1e-9);
  }
  // Energies are cos² of arcs that are shared out evenly: (Σ e)² / Σ e² = (N/2)² / (3N/8).
  EXPECT_NEAR(limits.modes[0].participation, 2.0 / 3 * balls, 1e-6);
}

TEST(LimitingModes, OfABallOnAWallNameTheWall) {
  SceneBuilder builder({.kn = 2, .ks = 1});
  constexpr double lever = 1 - 0.5e-9;
  builder.ball({0, 0, 1 - 1e-9}).plane({0, 0, 0}, {0, 0, 1});
  const LimitingModes limits = limiting_modes(builder.build(), 3);
  ASSERT_EQ(limits.modes.size(), 3U);
  EXPECT_NEAR(limits.modes[0].lambda, 1 + 2.5 * lever * lever, 1e-13);
  EXPECT_NEAR(limits.modes[0].translation, 1.0 / 3.5, 1e-8);  // u = I/mR θ of a rolling mode
  EXPECT_NEAR(limits.modes[2].lambda, 2, 1e-12);
  EXPECT_EQ(limits.modes[0].contacts[0].b, contact::no_body);
  EXPECT_EQ(limits.modes[0].contacts[0].wall, 0);
}

TEST(LimitingModes, SayNothingWhereNothingResists) {
  SceneBuilder builder({.kn = 1});
  builder.ball({0, 0, 0}).ball({5, 0, 0});
  EXPECT_TRUE(limiting_modes(builder.build(), 3).modes.empty());
}

double largest(const assembly::LinearSystem& system) {
  return Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd>(assembly::dense_scaled_stiffness(system),
                                                        Eigen::EigenvaluesOnly)
      .eigenvalues()
      .maxCoeff();
}

/// -d ln λ/d ln m of a body, and d ln λ/d ln k of a contact, by central differences.
double gain_by_mass(const assembly::LinearSystem& system, std::int32_t row, double h) {
  std::vector<double> factor(static_cast<std::size_t>(system.unknowns.bodies()), 1.0);
  factor[static_cast<std::size_t>(row)] = std::exp(h);
  const double heavier = largest(cycle::lifted(system, factor));
  factor[static_cast<std::size_t>(row)] = std::exp(-h);
  return -std::log(heavier / largest(cycle::lifted(system, factor))) / (2 * h);
}
double loss_by_stiffness(assembly::LinearSystem system, std::int32_t contact, double h) {
  contact::ContactStiffness& k = system.elements[static_cast<std::size_t>(contact)].stiffness;
  const contact::ContactStiffness before = k;
  k = std::exp(h) * before;
  const double stiffer = largest(system);
  k = std::exp(-h) * before;
  return std::log(stiffer / largest(system)) / (2 * h);
}

// h = 1e-4 errs by h² over the gap to the next eigenvalue, which the scenes are chosen for, and rounding by
// 1e-15/h.
TEST(LimitingModes, SharesAreWhatMassAndStiffnessDoToTheEigenvalue) {
  constexpr double h = 1e-4;
  std::mt19937_64 random(3);
  int judged = 0;
  for (int scene = 0; scene < 40; ++scene) {
    const bool clumps = scene % 4 == 0;
    SceneBuilder builder = clumps ? touching_pair({.kn = 1, .ks = 0.5}, random)
                                  : random_cluster(random, 5 + scene, {.kn = 1, .ks = 0.5}, 3, 0.1);
    if (scene % 4 == 1) builder.plane({-1, 0, 0}, {1, 0, 0});
    const System system(builder);
    if (system.elements.empty()) continue;
    const Eigen::VectorXd spectrum = system.spectrum();
    const Eigen::Index n = spectrum.size();
    if (n < 2 || spectrum[n - 1] - spectrum[n - 2] < 0.01 * spectrum[n - 1]) continue;
    ++judged;
    const LimitingMode mode = limiting_modes(system.model, 1).modes.at(0);
    EXPECT_NEAR(mode.lambda / spectrum[n - 1], 1, 1e-12);
    EXPECT_NEAR(std::accumulate(mode.energy.begin(), mode.energy.end(), 0.0), 1, 1e-12);
    for (const auto& body : mode.bodies) EXPECT_NEAR(gain_by_mass(system, body.row, h), body.share, 1e-5);
    for (const auto& c : mode.contacts) EXPECT_NEAR(loss_by_stiffness(system, c.index, h), c.share, 1e-5);
    double bodies = 0;
    for (const auto& body : mode.bodies) bodies += body.share;
    EXPECT_GE(bodies, timestep::carried_part - 1e-12);
  }
  EXPECT_GT(judged, 15);
}

}  // namespace
}  // namespace eigengrain::test
