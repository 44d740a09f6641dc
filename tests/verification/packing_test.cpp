// The main job on real packings: examples/data/README.md says where the figures come from.
#include "eigengrain/base/parallel.hpp"
#include "eigengrain/io/scene_reader.hpp"
#include "eigengrain/timestep/comparison.hpp"

#include <gtest/gtest.h>

namespace eigengrain::test {
namespace {

timestep::Comparison compare(const char* scene) {
  return timestep::compare(
      assembly::build_model(io::read_scene(std::string(EIGENGRAIN_EXAMPLES "/scenes/") + scene)));
}

TEST(Packing10k, HasTheFiguresOfAnIndependentProgram) {
  const timestep::Comparison c = compare("packing_10k.yaml");
  EXPECT_EQ(c.bodies, 10000);
  EXPECT_EQ(c.contacts, 27440);
  EXPECT_EQ(c.unknowns, 60000);
  EXPECT_LT(c.truth.residual, 1e-8);
  EXPECT_NEAR(c.truth.lambda_max / 1.1076739277883823e9, 1, 1e-8);
  EXPECT_NEAR(c.truth.dt / 6.009301982060347e-5, 1, 1e-8);
  ASSERT_EQ(c.estimates.at(0).name, "diagonal");
  EXPECT_NEAR(c.estimates[0].dt / 3.494575352889191e-5, 1, 1e-8);
  // Three sweeps prove 0.93 and more of the true step in dense packings.
  EXPECT_TRUE(timestep::find_estimate(c, "scaled-block-bound")->safe);
  EXPECT_GT(timestep::find_estimate(c, "scaled-block-bound")->ratio_to_true, 0.93);
  EXPECT_FALSE(c.truth.certified);
}

TEST(Packing10k, GivesTheSameBitsOnOneAndTwoThreads) {
  set_threads(1);
  const timestep::Comparison one = compare("packing_10k.yaml");
  set_threads(2);
  const timestep::Comparison two = compare("packing_10k.yaml");
  EXPECT_EQ(one.truth.lambda_max, two.truth.lambda_max);
  EXPECT_EQ(one.truth.residual, two.truth.residual);
  for (std::size_t k = 0; k < one.estimates.size(); ++k) EXPECT_EQ(one.estimates[k].dt, two.estimates[k].dt);
}

TEST(Packing100k, IsCompared) {
  const timestep::Comparison c = compare("packing_100k.yaml");
  EXPECT_EQ(c.bodies, 100000);
  EXPECT_LT(c.truth.residual, 1e-8);
  EXPECT_EQ(c.set_aside, 1);
  for (const timestep::Estimate& e : c.estimates) {
    if (e.claim != timestep::Claim::none) {
      EXPECT_TRUE(e.safe) << e.name;
    }
    EXPECT_GT(e.ratio_to_true, 0.55) << e.name;
  }
}

}  // namespace
}  // namespace eigengrain::test
