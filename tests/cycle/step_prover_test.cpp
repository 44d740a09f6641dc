// Steps proven by raising weights where they have to be: against the truth of dense systems and closed forms.
#include "eigengrain/cycle/step_prover.hpp"

#include "eigengrain/cycle/bounds.hpp"
#include "eigengrain/io/scene_reader.hpp"

#include "support/dense.hpp"
#include "support/lattices.hpp"
#include "support/laws.hpp"
#include "support/motion.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>
#include <vector>

namespace eigengrain::test {
namespace {

using cycle::StepProver;

constexpr double any = std::numeric_limits<double>::infinity();

TEST(StepProver, ProvesNothingAboveTheTruthInRandomClusters) {
  std::mt19937_64 random(11);
  std::uniform_real_distribution<double> uniform(0, 1);
  double worst = 1;
  int judged = 0;
  for (int scene = 0; scene < 200; ++scene) {
    SceneBuilder builder = random_cluster(random, 4 + scene % 9, {}, scene % 3 == 0 ? 10 : 2, 0.2);
    const bool dashpots = scene % 2 == 0;
    builder.scene().contacts = {
        {.law = "linear",
         .parameters = values_of("linear", {{"kn", 1},
                                            {"ks", 0.9 * uniform(random)},
                                            {"friction", 1},
                                            {"beta_n", dashpots ? 2 * uniform(random) : 0},
                                            {"beta_s", dashpots ? uniform(random) : 0}})}};
    const System system(builder);
    if (system.elements.empty() || system.unknowns.free_components().empty()) continue;
    std::vector<double> alpha;
    if (scene % 4 > 1)
      for (std::int32_t i = 0; i < system.unknowns.bodies(); ++i) alpha.push_back(0.8 * uniform(random));
    const double truth = dense_limit(system, alpha);
    if (!std::isfinite(truth)) continue;
    ++judged;
    StepProver prover(system, alpha);
    const double block = prover.bound();
    const double proven = prover.sharpen(any);
    ASSERT_LE(block, truth * (1 + 1e-9)) << "scene " << scene;
    ASSERT_LE(proven, truth * (1 + 1e-9)) << "scene " << scene;
    EXPECT_GE(proven, block);
    EXPECT_FALSE(prover.prove(truth * (1 + 1e-6)));
    worst = std::min(worst, proven / truth);
  }
  std::printf("%d clusters: at least %.3f of the truth proven\n", judged, worst);
  EXPECT_GT(judged, 150);
  EXPECT_GT(worst, 0.8);
}

// A few contacts with far stronger dashpots than springs, among others without: what counted as proven for a
// larger step may not for a smaller one, whose blocks have more of C.
TEST(StepProver, ProvesNothingAboveTheTruthWithDashpotsHereAndThere) {
  std::mt19937_64 random(12);
  std::uniform_real_distribution<double> uniform(0, 1);
  int judged = 0;
  for (int scene = 0; scene < 200; ++scene) {
    SceneBuilder builder = random_cluster(random, 6 + scene % 12, {}, 3, 0.2);
    builder.scene().contacts = {
        {.law = "linear",
         .parameters =
             values_of("linear", {{"kn", 1}, {"ks", 0.5}, {"friction", 1}, {"beta_n", 1}, {"beta_s", 1}})}};
    System system(builder);
    if (system.elements.empty() || system.unknowns.free_components().empty()) continue;
    for (contact::ContactDamping& dashpot : system.damping) {
      const double part = uniform(random) < 0.7 ? 0.0 : 10 * uniform(random);
      dashpot.normal *= part;
      dashpot.shear *= part;
    }
    const double truth = dense_limit(system, {});
    if (!std::isfinite(truth)) continue;
    ++judged;
    StepProver prover(system);
    ASSERT_LE(prover.sharpen(any), truth * (1 + 1e-9)) << "scene " << scene;
    EXPECT_FALSE(prover.prove(truth * (1 + 1e-6))) << "scene " << scene;
  }
  EXPECT_GT(judged, 150);
}

TEST(StepProver, ProvesTheBlockBoundWithItsFirstWeights) {
  std::mt19937_64 random(3);
  const System system(random_cluster(random, 30, {.kn = 1, .ks = 0.5}));
  StepProver prover(system);
  EXPECT_NEAR(prover.bound() / cycle::block_bound(system), 1, 1e-14);
  EXPECT_EQ(prover.weights(), std::vector<double>(30, 1.0));
  EXPECT_TRUE(prover.prove(prover.bound() * (1 - 1e-9)));
}

TEST(StepProver, WithOneAlphaIsTheUndampedOneOverItsRoot) {
  std::mt19937_64 random(2);
  const System system(random_cluster(random, 10, {.kn = 1, .ks = 0.5}));
  EXPECT_NEAR(StepProver(system, 0.7).bound() / cycle::damped_timestep(StepProver(system).bound(), 0.7), 1,
              1e-14);
  EXPECT_NEAR(
      StepProver(system, 0.7).sharpen(any) / cycle::damped_timestep(StepProver(system).sharpen(any), 0.7), 1,
      1e-12);
}

// One ball on a wall: (2/ω)(√(ξ² + 1/(1 + α)) - ξ).
TEST(StepProver, IsExactForOneBallWithDashpots) {
  for (const double beta : {0.0, 0.1, 1.0, 3.0})
    for (const double alpha : {0.0, 0.2, 0.8}) {
      SceneBuilder builder = with_law("linear", {{"kn", 1}, {"tension", 1}, {"beta_n", beta}});
      const System system(builder.ball({0, 0, 1 - 1e-9}).plane({0, 0, 0}, {0, 0, 1}));
      StepProver prover(system, std::vector<double>{alpha});
      EXPECT_NEAR(prover.bound() / (2 * (std::sqrt(beta * beta + 1 / (1 + alpha)) - beta)), 1, 1e-11)
          << beta << " " << alpha;
    }
}

// The bound of a chain of equal spheres is its truth; of one in which sizes alternate only with the right
// weights.
TEST(StepProver, FindsTheWeightsOfAChainOfTwoSizes) {
  SceneBuilder builder({.kn = 1});
  double x = 0;
  for (int k = 0; k < 60; ++k) {
    const double radius = k % 2 == 0 ? 1 : 2;
    builder.ball({x, 0, 0}, radius, radius * radius * radius);
    x += 3 * (1 - 1e-9);
  }
  const System system(builder);
  const double truth = dense_truth(system);
  StepProver prover(system);
  EXPECT_LT(prover.bound() / truth, 0.8);
  EXPECT_GT(prover.sharpen(any) / truth, 0.99);
}

System dense_packing() {
  return System(assembly::build_model(io::read_scene_text(R"(
materials: [{name: grain, density: 2500}]
contacts: [{between: [grain, grain], law: linear, kn: 1e5, ks: 5e4, friction: 0.5}]
periodic: {box: [0.05, 0.05, 0.05]}
balls:
  - fill: dense
    mean_overlap: 1e-3
    sizes: {distribution: lognormal, mean: 4.6 mm, deviation: 0.5 mm, min: 3 mm, max: 7 mm}
    seed: 1
    material: grain
)",
                                                          ".")));
}

TEST(StepProver, GoesFartherThanSweepsInADensePacking) {
  const System system = dense_packing();
  const double truth = dense_truth(system);
  StepProver prover(system);
  const double proven = prover.sharpen(any);
  std::printf("block %.4f, 3 sweeps %.4f, raised where needed %.4f of the truth\n",
              cycle::block_bound(system) / truth, cycle::scaled_block_bound(system, 3) / truth,
              proven / truth);
  EXPECT_GT(proven, cycle::scaled_block_bound(system, 3));
  EXPECT_LE(proven, truth);
  EXPECT_GT(proven / truth, 0.95);
}

TEST(StepProver, LeavesItsWeightsWhereAProofFails) {
  const System system = dense_packing();
  StepProver prover(system);
  const double proven = prover.sharpen(1.1 * prover.bound());
  const std::vector<double> before = prover.weights();
  EXPECT_FALSE(prover.prove(2 * proven));
  EXPECT_EQ(prover.weights(), before);
  EXPECT_TRUE(prover.prove(proven));
}

// Contacts that become stiffer and softer: what is told to update() is proven as by a new prover.
TEST(StepProver, LooksAgainWhereContactsChanged) {
  System system = dense_packing();
  StepProver prover(system);
  const double before = prover.sharpen(1.1 * prover.bound());
  ASSERT_TRUE(prover.prove(before));
  std::vector<std::int32_t> changed;
  for (std::int32_t c = 0; c < 20; ++c) {
    const std::int32_t contact = 7 * c;
    system.elements[static_cast<std::size_t>(contact)].stiffness.normal *= 20;
    changed.push_back(contact);
  }
  const std::int64_t looked = prover.blocks_looked_at();
  prover.update(changed);
  EXPECT_LE(prover.blocks_looked_at() - looked, 40);  // no more than the bodies of the contacts
  const double truth = dense_truth(system);
  ASSERT_LT(truth, before);
  EXPECT_FALSE(prover.prove(before));
  EXPECT_FALSE(prover.prove(truth * 1.0001));
  EXPECT_TRUE(prover.prove(0.9 * truth));
}

}  // namespace
}  // namespace eigengrain::test
