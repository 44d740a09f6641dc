// Lanczos' method with a fixed number of steps: what its numbers prove, and with which probability.
#include "eigengrain/base/parallel.hpp"

#include "support/bits.hpp"
#include "support/estimates.hpp"
#include "timestep/estimates/lanczos.hpp"

#include <gtest/gtest.h>

#include <cstdio>

namespace eigengrain::test {
namespace {

using timestep::gaussian_start;
using timestep::lanczos;
using timestep::LanczosRun;

/// A frictionless chain of unequal balls: n - 1 eigenvalues that are not zero, dense at the top.
SceneBuilder long_chain(int balls) {
  SceneBuilder builder({.kn = 1, .ks = 0});
  std::mt19937_64 random(5);
  std::uniform_real_distribution<double> uniform(1, 1.2);
  for (int k = 0; k < balls; ++k) builder.ball({2.0 * (1 - 1e-9) * k, 0, 0}, 1, uniform(random));
  return builder;
}

double largest(const System& system) {
  const Eigen::VectorXd spectrum = system.spectrum();
  return spectrum[spectrum.size() - 1];
}

TEST(Lanczos, StopsWhereItsSpaceIsWhole) {
  // Two eigenvalues, 0 and 2: two steps find both.
  const System system(pair_along(Vec3::UnitX(), {.kn = 1, .ks = 0}));
  const LanczosRun run = lanczos(system, 20, gaussian_start(system, 1));
  EXPECT_EQ(run.alpha.size(), 2U);
  EXPECT_NEAR(run.ritz, 2, 1e-14);
  EXPECT_LT(run.residual, 1e-12);
  EXPECT_NEAR(probable_bound(run, 1e-6), 2, 1e-7);
  EXPECT_GE(probable_bound(run, 1e-6), 2);
  EXPECT_EQ(run.components, 6);
}

TEST(Lanczos, VectorHasTheResidualThatItSays) {
  const System system(long_chain(60));
  const LanczosRun run = lanczos(system, 12, gaussian_start(system, 2), true);
  const Eigen::MatrixXd a = assembly::dense_scaled_stiffness(system);
  const Eigen::Map<const Eigen::VectorXd> x(run.vector.data(), a.rows());
  ASSERT_EQ(static_cast<Eigen::Index>(run.vector.size()), a.rows());
  EXPECT_NEAR(x.norm(), 1, 1e-12);
  EXPECT_NEAR(x.dot(a * x), run.ritz, 1e-12);
  EXPECT_NEAR((a * x - run.ritz * x).norm(), run.residual, 1e-12);
  EXPECT_LT(run.ritz, largest(system));
}

TEST(Lanczos, GivesTheSameBitsOnAnyNumberOfThreads) {
  const System system(long_chain(20000));
  const auto run_on = [&](int count) {
    const Threads threads(count);
    return lanczos(system, 10, gaussian_start(system, 1));
  };
  const LanczosRun one = run_on(1);
  const LanczosRun two = run_on(2);
  EXPECT_EQ(one.alpha, two.alpha);
  EXPECT_EQ(one.beta, two.beta);
}

// The probabilities are what they claim to be: over many starts each bound fails at most as often as it may,
// and the sharp one does fail where it is allowed to.
TEST(ProbableBounds, FailNoMoreOftenThanTheySay) {
  const System system(long_chain(60));
  const double lambda = largest(system);
  constexpr int starts = 4000;
  for (const int steps : {4, 8, 16}) {
    for (const double failure : {0.5, 0.1, 0.01}) {
      int sharp = 0;
      int gap_free = 0;
      double mean_sharp = 0;
      double mean_gap_free = 0;
      for (int seed = 0; seed < starts; ++seed) {
        const LanczosRun run =
            lanczos(system, steps, gaussian_start(system, 100U + static_cast<unsigned>(seed)));
        const double a = probable_bound(run, failure);
        const double b = gap_free_bound(run, failure);
        sharp += a < lambda * (1 - 1e-12) ? 1 : 0;
        gap_free += b < lambda * (1 - 1e-12) ? 1 : 0;
        mean_sharp += a / starts / lambda;
        mean_gap_free += b / starts / lambda;
      }
      std::printf("%2d steps, may fail %.2f: polynomial %.4f (mean bound %.4f), gap-free %.4f (%.4f)\n",
                  steps, failure, sharp / double{starts}, mean_sharp, gap_free / double{starts},
                  mean_gap_free);
      // Four standard deviations of so many draws.
      const double most = starts * failure + 4 * std::sqrt(starts * failure * (1 - failure));
      EXPECT_LE(sharp, most);
      EXPECT_LE(gap_free, most);
      if (failure == 0.5 && steps == 16) {
        EXPECT_GT(sharp, 0);
      }
    }
  }
}

// The constant of the gap-free bound: p = √(2(n-1)/π) / sinh((2k - 1) artanh √ε), for p << 1 at most
// 2√(2/π) √n e^-(2k-1)√ε, 2√(2/π) = 1.596.
TEST(ProbableBounds, HaveTheConstantOfTheProof) {
  const double n = 60000;
  for (const double steps : {20.0, 40.0, 80.0}) {
    LanczosRun run;
    run.alpha.resize(static_cast<std::size_t>(steps));
    run.ritz = 1;
    run.components = static_cast<std::int64_t>(n);
    const double epsilon = 1 - 1 / gap_free_bound(run, 1e-6);
    const double of_theorem = 1.596 * std::sqrt(n) * std::exp(-std::sqrt(epsilon) * (2 * steps - 1));
    EXPECT_GE(of_theorem, 1e-6);  // by artanh √ε >= √ε the theorem's form asks for a little more
    EXPECT_LT(of_theorem, 1e-6 * 6.0);
  }
}

/// 200 balls in a row with two places of light ones, either of which may hold the top mode.
SceneBuilder two_soft_places(double first, double second) {
  SceneBuilder builder({.kn = 1, .ks = 0});
  for (int k = 0; k < 200; ++k) {
    const double mass = k == 50 || k == 51 ? first : (k == 150 || k == 151 ? second : 1.0);
    builder.ball({2.0 * (1 - 1e-9) * k, 0, 0}, 1, mass);
  }
  return builder;
}

// A vector that was the top mode before a change: its Rayleigh quotient, and what iterations from it find,
// are below the present λ_max without any sign of it.
TEST(WarmStart, IsUnsafeAfterTheTopModeHasGoneElsewhere) {
  const System before(two_soft_places(0.50, 0.55));
  const System after(two_soft_places(0.50, 0.40));
  const LanczosRun cold = lanczos(before, 60, gaussian_start(before, 1), true);
  ASSERT_NEAR(cold.ritz / largest(before), 1, 1e-8);
  const double lambda = largest(after);
  for (const int steps : {1, 5, 20}) {
    const LanczosRun warm = lanczos(after, steps, cold.vector);
    std::printf("warm, %2d steps: step %.4f of the truth, residual %.1e\n", steps,
                std::sqrt(lambda / warm.ritz), warm.residual / warm.ritz);
    EXPECT_GT(std::sqrt(lambda / warm.ritz), 1.05);  // the step is 5% and more too long
    // Its residual vouches for nothing, and it is no random start for the probable bound.
    EXPECT_LT(warm.ritz + warm.residual, lambda);
    EXPECT_LT(probable_bound(warm, 1e-6), lambda);
  }
  // A random start sees the new place at once.
  EXPECT_GT(probable_bound(lanczos(after, 20, gaussian_start(after, 1)), 1e-6), lambda);
}

TEST(WarmStart, SavesProductsWhileTheTopModeStays) {
  const System before(two_soft_places(0.50, 0.55));
  const System after(two_soft_places(0.50001, 0.55));
  const LanczosRun old = lanczos(before, 60, gaussian_start(before, 1), true);
  const double lambda = largest(after);
  const double warm = lanczos(after, 1, old.vector).ritz;
  const double cold = lanczos(after, 5, gaussian_start(after, 1)).ritz;
  EXPECT_LT(1 - warm / lambda, 1e-8);
  EXPECT_GT(1 - cold / lambda, 1e-5);
}

}  // namespace
}  // namespace eigengrain::test
