// The bounds against the dense spectrum of thousands of random scenes: they may never exceed the truth.
#include "eigengrain/cycle/bounds.hpp"

#include "eigengrain/base/largest_eigenvalue.hpp"

#include "support/scenes.hpp"

#include <gtest/gtest.h>

#include <random>

namespace eigengrain::test {
namespace {

/// A random scene of 2 to 8 balls: sizes up to 10:1, any ks, some with a wall, with fixed bodies or
/// components, or in a cell so small that bodies touch several images and themselves.
SceneBuilder random_scene(std::mt19937_64& random) {
  std::uniform_real_distribution<double> uniform(0, 1);
  const int balls = 2 + static_cast<int>(random() % 7);
  const double ks = uniform(random) < 0.3 ? 0.0 : 2 * uniform(random);
  const double fixed = uniform(random) < 0.3 ? 0.3 : 0.0;
  SceneBuilder builder =
      random_cluster(random, balls, {.kn = 1, .ks = ks}, uniform(random) < 0.5 ? 1.0 : 10.0, fixed);
  if (uniform(random) < 0.3) builder.plane({0, 0, -0.9}, {0, 0, 1});
  if (uniform(random) < 0.2) builder.periodic(Vec3::Constant(1.5 + 4 * uniform(random)));
  return builder;
}

TEST(Bounds, AreNeverAboveTheTruthInTenThousandScenes) {
  std::mt19937_64 random(31);
  int scenes = 0;
  double unsafe_estimate = 0;
  while (scenes < 10000) {
    const System s(random_scene(random));
    if (s.unknowns.free_components().empty()) continue;
    const Eigen::VectorXd spectrum = s.spectrum();
    const double lambda = spectrum[spectrum.size() - 1];
    if (lambda < 1e-12) continue;  // only fixed bodies touch
    ++scenes;
    const double truth = 2 / std::sqrt(lambda);
    // The dense eigenvalue itself errs by some 1e-14.
    const double most = truth * (1 + 1e-13);
    cycle::BlockBound bound(s);
    double before = bound.timestep();
    EXPECT_LE(before, most);
    for (int sweep = 0; sweep < 4; ++sweep) {
      bound.sweep();
      const double after = bound.timestep();
      EXPECT_LE(after, most);
      EXPECT_GE(after, before * (1 - 1e-11));  // Collatz-Wielandt: never worse
      before = after;
    }
    const double estimate = cycle::diagonal_estimate(s) / truth;
    EXPECT_LE(estimate, std::sqrt(3.0) * (1 + 1e-12));
    unsafe_estimate = std::max(unsafe_estimate, estimate);
    if (HasFailure()) FAIL() << "scene " << scenes;
  }
  EXPECT_GT(unsafe_estimate, 1.0);  // PFC3D's estimate is not a bound
}

TEST(Bounds, AreSafeForNearlyIsotropicBlocks) {
  // A spread of eigenvalues that vanishes in the variance of the block: ball 0 has six equal ones, ball 1 one
  // that is larger by 3a and five that are smaller by a.
  for (const double a : {1e-10, 1e-9, 3e-9, 1e-8, 3e-8}) {
    System s(
        SceneBuilder({.kn = 1, .ks = 1}).ball({0, 0, 0.9}).ball({9, 0, 0.9}).plane({0, 0, 0}, {0, 0, 1}));
    ASSERT_EQ(s.elements.size(), 2U);
    for (contact::ContactElement& e : s.elements) {
      const double along = e.a == 0 ? 1 : 1 + 3 * a;
      const double across = e.a == 0 ? 1 : 1 - a;
      e.lever_a.setZero();
      e.stiffness = {along, across, across, across};
    }
    std::fill(s.mass.begin(), s.mass.end(), 1.0);
    EXPECT_LE(cycle::block_bound(s), 2 / std::sqrt(1 + 3 * a)) << a;
  }
}

TEST(LargestEigenvalue, IsAnUpperBoundToRounding) {
  std::mt19937_64 random(32);
  std::normal_distribution<double> gaussian;
  for (int k = 0; k < 20000; ++k) {
    // Spectra with clusters and multiplicities: those are where a polynomial loses digits.
    Vec6 d;
    for (int i = 0; i < 6; ++i) d[i] = std::abs(gaussian(random));
    if (k % 4 == 1) d.tail<3>().setConstant(d[5]);
    if (k % 4 == 2) d[4] = d[5] * (1 + 1e-9);
    if (k % 4 == 3) d.setConstant(d[0]);
    Mat6 basis;
    for (int i = 0; i < 36; ++i) basis(i) = gaussian(random);
    const Mat6 q = Eigen::HouseholderQR<Mat6>(basis).householderQ();
    const double size = std::pow(10.0, 10 * gaussian(random));
    Mat6 matrix = size * (q * d.asDiagonal() * q.transpose());
    matrix = 0.5 * (matrix + matrix.transpose()).eval();
    const double found = largest_eigenvalue(matrix) / (size * d.maxCoeff());
    EXPECT_GT(found, 1 - 4e-15);
    EXPECT_LT(found, 1 + 1e-12);
  }
  EXPECT_EQ(largest_eigenvalue(Mat6::Zero()), 0.0);
  EXPECT_NEAR(largest_eigenvalue(Mat6::Identity()), 1.0, 1e-14);
}

}  // namespace
}  // namespace eigengrain::test
