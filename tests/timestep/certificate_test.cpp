// What is said to be proven, against spectra that are known.
#include "timestep/certificate.hpp"

#include "eigengrain/base/error.hpp"
#include "eigengrain/io/scene_reader.hpp"
#include "eigengrain/timestep/comparison.hpp"
#include "eigengrain/timestep/truth.hpp"

#include "support/clumps.hpp"
#include "support/lattices.hpp"
#include "timestep/memory.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <random>

namespace eigengrain::test {
namespace {

using timestep::Certify;
using timestep::critical_timestep;
using timestep::ProofBy;
using timestep::prove_below;
using timestep::Truth;

std::optional<double> proven(const System& s, double sigma) {
  return prove_below(s.unknowns, s.elements, s.inverse_sqrt_mass(), sigma);
}

// 1e-10 of λ is a hundred times what rounding leaves of the factors of these sizes, and a thousandth of the
// margin.
TEST(Certificate, TellsOnWhichSideOfTheLargestEigenvalueItIs) {
  std::mt19937_64 random(5);
  int scenes = 0;
  for (int scene = 0; scene < 100; ++scene) {
    const System s(random_cluster(random, 3 + scene % 20, {.kn = 1, .ks = 0.01 * scene}, 3, 0.2));
    if (s.elements.empty() || s.unknowns.free_components().empty()) continue;
    const Eigen::VectorXd spectrum = s.spectrum();
    const double lambda = spectrum.maxCoeff();
    if (!(lambda > 0)) continue;
    ++scenes;
    const std::optional<double> above = proven(s, lambda * (1 + 1e-10));
    ASSERT_TRUE(above) << scene;
    EXPECT_GE(*above, lambda);
    EXPECT_LT(*above, lambda * (1 + 2e-10));
    EXPECT_FALSE(proven(s, lambda * (1 - 1e-10))) << scene;
    EXPECT_FALSE(proven(s, 0.5 * lambda)) << scene;
    // The one before the largest: an eigensolver that missed the largest would ask this.
    const double second = spectrum[spectrum.size() - 2];
    if (second * (1 + 1e-6) < lambda * (1 - 1e-10)) {
      EXPECT_FALSE(proven(s, second * (1 + 1e-6))) << scene;
    }
  }
  EXPECT_GT(scenes, 80);
}

TEST(Certificate, CountsClumpsAlongTheirAxes) {
  std::mt19937_64 random(6);
  for (int scene = 0; scene < 20; ++scene) {
    const System s(touching_pair({.kn = 1, .ks = 0.5}, random));
    const double lambda = s.spectrum().maxCoeff();
    EXPECT_TRUE(proven(s, lambda * (1 + 1e-10)));
    EXPECT_FALSE(proven(s, lambda * (1 - 1e-10)));
  }
}

TEST(Truth, IsProvenToItsMarginInRandomClusters) {
  std::mt19937_64 random(7);
  for (int scene = 0; scene < 100; ++scene) {
    const System s(random_cluster(random, 3 + scene, {.kn = 1, .ks = 0.5}, 2, 0.1));
    const Truth truth = critical_timestep(s);
    if (!std::isfinite(truth.dt)) continue;
    const double dense = 2 / std::sqrt(s.spectrum().maxCoeff());
    EXPECT_NEAR(truth.dt / dense, 1, 1e-12) << scene;
    EXPECT_TRUE(truth.certified);
    EXPECT_NE(truth.proof.by, ProofBy::none);
    EXPECT_LE(truth.proof.dt, dense);
    EXPECT_GE(truth.proof.dt, dense * (1 - 6e-7));
    EXPECT_NEAR(truth.proof.sigma * truth.proof.dt * truth.proof.dt, 4, 1e-13);
  }
}

TEST(Truth, IsProvenByTheBoundWhereThatReachesIt) {
  const System s(make_lattice(face_centred(), {.kn = 1, .ks = 0.5}, {4, 4, 4}));
  const Truth truth = critical_timestep(s, 0.7);
  EXPECT_EQ(truth.proof.by, ProofBy::bound);
  EXPECT_TRUE(truth.certified);
  EXPECT_NEAR(truth.proof.dt, 2 / std::sqrt(20), 1e-11);
  EXPECT_NEAR(truth.limit_proof.dt, 2 / std::sqrt(20 * 1.7), 1e-11);
}

TEST(Truth, IsNotProvenWhereThatIsNotAskedFor) {
  std::mt19937_64 random(8);
  const System s(random_cluster(random, 10, {.kn = 1, .ks = 0.5}));
  const Truth truth = critical_timestep(s, 0.0, {.certify = Certify::never});
  EXPECT_FALSE(truth.certified);
  EXPECT_EQ(truth.proof.by, ProofBy::none);
  EXPECT_EQ(truth.proof.dt, 0.0);
  EXPECT_EQ(truth.lambda_max, critical_timestep(s).lambda_max);
}

TEST(Truth, OfTenThousandBallsIsProvenOnDemand) {
  const assembly::Model model =
      assembly::build_model(io::read_scene(EIGENGRAIN_EXAMPLES "/scenes/packing_10k.yaml"));
  const Truth truth = timestep::compare(model, {.certify = Certify::always}).truth;
  EXPECT_TRUE(truth.certified);
  EXPECT_EQ(truth.proof.by, ProofBy::cholesky);
  EXPECT_LT(truth.proof.dt, truth.dt);
  EXPECT_GT(truth.proof.dt, truth.dt * (1 - 6e-7));
}

// λ and the mode belong together, in the normalisation that is promised.
TEST(Truth, ComesWithItsMode) {
  std::mt19937_64 random(9);
  const System s(random_cluster(random, 40, {.kn = 1, .ks = 0.5}, 2, 0.1));
  const Truth truth = critical_timestep(s);
  const Eigen::Map<const Eigen::VectorXd> x(truth.mode.data(), static_cast<Eigen::Index>(truth.mode.size()));
  const Eigen::Map<const Eigen::VectorXd> m(s.mass.data(), x.size());
  EXPECT_NEAR(x.dot(m.cwiseProduct(x)), 1, 1e-12);
  const Eigen::VectorXd residual = assembly::stiffness_matrix(s) * x - truth.lambda_max * m.cwiseProduct(x);
  double force = 0;
  for (const std::int32_t k : s.unknowns.free_components()) force = std::max(force, std::abs(residual[k]));
  EXPECT_LT(force, 1e-8 * truth.lambda_max * m.cwiseProduct(x).cwiseAbs().maxCoeff());
}

TEST(Certificate, SaysWhenItsFactorDoesNotFit) {
  timestep::require_memory(1e9, 1e10);
  try {
    timestep::require_memory(1e9, 2e9);
    FAIL() << "a factor of 8 GB in 2";
  } catch (const SolverError& error) {
    EXPECT_THAT(error.what(), ::testing::HasSubstr("9.6 GB"));
    EXPECT_THAT(error.what(), ::testing::HasSubstr("2.0 GB of memory are free"));
    EXPECT_THAT(error.what(), ::testing::HasSubstr("--certify"));
  }
}

}  // namespace
}  // namespace eigengrain::test
