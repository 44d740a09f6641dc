// Estimates on the packing of 10,000 balls, beside what YADE and independent programs gave.
#include "eigengrain/io/scene_reader.hpp"
#include "eigengrain/timestep/comparison.hpp"

#include <gtest/gtest.h>

#include <string>

namespace eigengrain::test {
namespace {

const timestep::Comparison& packing_10k() {
  static const timestep::Comparison comparison = timestep::compare(
      assembly::build_model(io::read_scene(EIGENGRAIN_EXAMPLES "/scenes/packing_10k.yaml")));
  return comparison;
}

double ratio_of(const char* name) {
  const timestep::Estimate* estimate = timestep::find_estimate(packing_10k(), name);
  return estimate == nullptr ? 0 : estimate->ratio_to_true;
}

TEST(EstimatesOfPacking10k, HaveYadesStep) {
  // YADE 2023.02a (Debian), GlobalStiffnessTimeStepper with timestepSafetyCoefficient 0.8, first step on this
  // packing with k_n = 1e5, k_s = 5e4 for all pairs and walls, 27,440 interactions.
  const timestep::Estimate* yade = timestep::find_estimate(packing_10k(), "yade-global-stiffness");
  ASSERT_NE(yade, nullptr);
  EXPECT_NEAR(0.8 * yade->dt / 3.94252982062484e-05, 1, 1e-12);
}

TEST(EstimatesOfPacking10k, AreAsFarFromTheTruthAsDocumented) {
  for (const timestep::Estimate& e : packing_10k().estimates) {
    if (e.claim != timestep::Claim::none) {
      EXPECT_TRUE(e.safe) << e.name;
    }
  }
  // The table of docs/user-guide.md.
  EXPECT_NEAR(ratio_of("diagonal"), 0.5815, 5e-5);
  EXPECT_NEAR(ratio_of("yade-global-stiffness"), 0.8201, 5e-5);
  EXPECT_NEAR(ratio_of("nodal"), 0.7685, 5e-5);
  EXPECT_NEAR(ratio_of("mass-over-stiffness"), 1.6256, 5e-5);
  EXPECT_NEAR(ratio_of("gershgorin"), 0.5686, 5e-5);
  EXPECT_NEAR(ratio_of("gershgorin-symmetric"), 0.6388, 5e-5);
  EXPECT_NEAR(ratio_of("element-equal"), 0.5911, 5e-5);
  EXPECT_GT(ratio_of("element-best"), 0.73);
  EXPECT_NEAR(ratio_of("block-bound"), 0.8042, 5e-5);
  EXPECT_GT(ratio_of("scaled-block-bound"), 0.93);
  EXPECT_GT(ratio_of("scaled-block-bound-10"), 0.95);
  EXPECT_GT(ratio_of("contact-space-scaled"), 0.77);
  EXPECT_GT(ratio_of("lanczos-gap-free-40"), 0.96);
  EXPECT_GT(ratio_of("lanczos-probable-20"), 0.90);
  EXPECT_GT(ratio_of("lanczos-probable-40"), 0.98);
  EXPECT_GT(ratio_of("lanczos-10"), 1.001);
}

TEST(EstimatesOfPacking10k, CostTheProductsThatTheySay) {
  for (const timestep::Estimate& e : packing_10k().estimates) {
    const bool lanczos = e.name.starts_with("lanczos");
    EXPECT_EQ(e.products, lanczos ? std::stoi(e.name.substr(e.name.rfind('-') + 1)) : 0) << e.name;
  }
}

}  // namespace
}  // namespace eigengrain::test
