// Modes against dense eigenvalues, closed forms and what they must obey.
#include "eigengrain/spectrum/modes.hpp"

#include "eigengrain/base/error.hpp"
#include "eigengrain/base/parallel.hpp"

#include "spectrum/packings.hpp"
#include "support/lattices.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

namespace eigengrain::test {
namespace {

using spectrum::all_modes;
using spectrum::character_of;
using spectrum::highest_modes;
using spectrum::lowest_modes;
using spectrum::Modes;

/// |x·M x' - 1 or 0|, the largest.
double orthonormality(const System& system, const Modes& modes) {
  double worst = 0;
  for (std::size_t i = 0; i < modes.shape.size(); ++i)
    for (std::size_t j = 0; j <= i; ++j) {
      double product = i == j ? -1 : 0;
      for (std::size_t k = 0; k < system.mass.size(); ++k)
        product += modes.shape[i][k] * system.mass[k] * modes.shape[j][k];
      worst = std::max(worst, std::abs(product));
    }
  return worst;
}

/// Of eigenvalues by dense methods, which are exact for a matrix that differs by p(n) ulps of the norm, p
/// growing at most as n (Anderson et al., LAPACK Users' Guide, §4.7).
double dense_error(const Eigen::VectorXd& spectrum) {
  return static_cast<double>(spectrum.size()) * std::numeric_limits<double>::epsilon() * spectrum.maxCoeff();
}

TEST(Modes, HighestAndLowestAreTheEndsOfTheDenseSpectrum) {
  const System system = pressed_packing();
  const Eigen::VectorXd all = system.spectrum();
  const double largest = all.maxCoeff();
  const Modes high = highest_modes(system, 20);
  const Modes low = lowest_modes(system, 20);
  ASSERT_EQ(high.lambda.size(), 20U);
  ASSERT_EQ(low.lambda.size(), 20U);
  const auto resisted = std::ranges::find_if(all, [&](double x) { return x > 1e-10 * largest; });
  EXPECT_GE(resisted - all.begin(), 3);  // translations of the whole, and rattlers
  const double error = dense_error(all);
  for (std::size_t k = 0; k < 20; ++k) {
    EXPECT_NEAR(high.lambda[k], all[all.size() - 1 - static_cast<Eigen::Index>(k)], error) << k;
    EXPECT_NEAR(low.lambda[k], resisted[static_cast<std::ptrdiff_t>(k)], error) << k;
    EXPECT_LT(high.residual[k], 1e-8);
    EXPECT_LT(low.residual[k], 1e-5);
  }
  EXPECT_LT(orthonormality(system, high), 1e-9);
  EXPECT_LT(orthonormality(system, low), 1e-7);  // rounding over the shift: 1e-16 over 1e-8
}

TEST(Modes, AllOfThemByLapack) {
  const System system = pressed_packing();
  const Modes all = all_modes(system, true);
  const Eigen::VectorXd expected = system.spectrum();
  ASSERT_EQ(std::ssize(all.lambda), expected.size());
  double sum = 0;
  const double error = dense_error(expected);
  for (Eigen::Index k = 0; k < expected.size(); ++k) {
    EXPECT_NEAR(all.lambda[static_cast<std::size_t>(k)], expected[k], error) << k;
    sum += all.lambda[static_cast<std::size_t>(k)];
  }
  EXPECT_NEAR(sum, assembly::dense_scaled_stiffness(system).trace(), 1e-12 * sum);
  EXPECT_LT(*std::ranges::max_element(all.residual), 1e-6);
  EXPECT_LT(orthonormality(system, all), 1e-12);
  EXPECT_EQ(all_modes(system, false).lambda.size(), all.lambda.size());
}

TEST(Modes, OfAChainHeldAtItsEndsAreWaves) {
  constexpr int balls = 150;  // between two that are fixed
  SceneBuilder builder({.kn = 1});
  for (int i = 0; i <= balls + 1; ++i)
    builder.ball({(2 - 1e-12) * i, 0, 0}, 1, 1,
                 i == 0 || i == balls + 1 ? fix_all : model::FixedComponents{});
  const System system(builder);
  const Modes low = lowest_modes(system, 5);
  const Modes high = highest_modes(system, 5);
  ASSERT_EQ(low.lambda.size(), 5U);
  for (int k = 0; k < 5; ++k) {
    const auto wave = [&](int j) {
      return 4 * std::pow(std::sin(j * std::numbers::pi / (2 * (balls + 1))), 2);
    };
    EXPECT_NEAR(low.lambda[static_cast<std::size_t>(k)], wave(k + 1), 1e-11) << k;
    EXPECT_NEAR(high.lambda[static_cast<std::size_t>(k)], wave(balls - k), 1e-11) << k;
  }
  // Energies are sin² of arcs: (Σ e)²/Σ e² = ⅔ (N + 1).
  const auto character = character_of(system, low.shape[0]);
  EXPECT_NEAR(character.participation, 2.0 / 3 * (balls + 1) / balls, 1e-8);
  EXPECT_NEAR(character.translation, 1, 1e-12);
}

// λ = 20 k_s/m of spheres that spin alike (4a²k_s for each contact across the axis, four of them over 2 for
// its two ends, I = 2ma²/5). Along the axis nothing turns, so each of the three layers across it may do so
// by itself: nine modes.
TEST(Modes, OfSpheresThatSpinAlikeDoNotTranslate) {
  const System system(make_lattice(simple_cubic(), {.kn = 1, .ks = 1}, {3, 3, 3}));
  const Modes high = highest_modes(system, 10);
  ASSERT_EQ(high.lambda.size(), 10U);
  for (std::size_t k = 0; k < 9; ++k) {
    EXPECT_NEAR(high.lambda[k], 20, 1e-9) << k;
    const auto character = character_of(system, high.shape[k]);
    EXPECT_NEAR(character.translation, 0, 1e-12) << k;
    EXPECT_GT(character.participation, 1.0 / 9) << k;  // at least a layer's spheres turn
  }
  EXPECT_LT(high.lambda[9], 19);
}

TEST(Modes, AreTheSameOnAnyNumberOfThreads) {
  const System system = pressed_packing();
  const int before = threads();
  set_threads(1);
  const Modes one = lowest_modes(system, 4);
  set_threads(3);
  const Modes three = lowest_modes(system, 4);
  set_threads(before);
  EXPECT_EQ(one.lambda, three.lambda);
  EXPECT_EQ(one.shape, three.shape);
}

TEST(Modes, SayNothingOfNothingAndRefuseWhatMakesNoSense) {
  const System apart(SceneBuilder({.kn = 1}).ball({0, 0, 0}).ball({5, 0, 0}));
  EXPECT_TRUE(highest_modes(apart, 3).lambda.empty());
  EXPECT_TRUE(lowest_modes(apart, 3).lambda.empty());
  EXPECT_TRUE(all_modes(apart, true).lambda.empty());
  EXPECT_THROW(highest_modes(apart, 0), InputError);
  EXPECT_THROW(lowest_modes(apart, -1), InputError);
}

}  // namespace
}  // namespace eigengrain::test
