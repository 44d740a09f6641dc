// Every scene of examples/scenes/hard_cases: the truth against its closed form, every estimate against the
// truth, and the limit that runs of the cycle find.
#include "hard_cases/expectations.hpp"

#include "hard_cases/hard_case.hpp"

#include <gtest/gtest.h>

#include <cstdio>
#include <filesystem>
#include <set>
#include <string>

namespace eigengrain::test {
namespace {

TEST(HardCases, HaveAnExpectationEach) {
  std::set<std::string> scenes;
  for (const auto& entry : std::filesystem::directory_iterator(hard_case_folder()))
    if (entry.path().extension() == ".yaml") scenes.insert(entry.path().stem().string());
  std::set<std::string> expected(without_contacts_at_first().begin(), without_contacts_at_first().end());
  for (const Expectation& e : expectations()) expected.emplace(e.scene);
  EXPECT_EQ(scenes, expected);
}

class HardCase : public testing::TestWithParam<Expectation> {};

TEST_P(HardCase, IsAsExpected) {
  const Expectation& expected = GetParam();
  const assembly::State state = start_of(expected.scene);
  const timestep::Comparison found = timestep::compare(state.model);

  // An eigenvalue errs by about the square of its residual, 1e-16; LAPACK by some hundred ulps.
  EXPECT_NEAR(found.truth.dt / dense_truth(assembly::LinearSystem(state.model)), 1, 1e-11);
  if (expected.critical > 0) {
    EXPECT_NEAR(found.truth.dt / expected.critical, 1, expected.error);
  }

  for (const timestep::Estimate& e : found.estimates)
    EXPECT_TRUE(e.safe || e.claim != timestep::Claim::proven) << e.name << " " << e.ratio_to_true;
  const timestep::Estimate& diagonal = (*timestep::find_estimate(found, "diagonal"));
  EXPECT_NEAR(diagonal.ratio_to_true, expected.diagonal, 1e-4);
  EXPECT_EQ(diagonal.safe, expected.diagonal < 1);
  EXPECT_EQ(0.8 * diagonal.dt > found.truth.limit, expected.standard == Default::above_the_limit);

  const timestep::EmpiricalLimit runs = timestep::empirical_limit(state, found.truth);
  EXPECT_NEAR(runs.dt / found.truth.limit, expected.cycle, expected.by_running);
  EXPECT_EQ(runs.linear(), expected.linear);
  std::printf("%-24s true %.6e, limit by running %.6f of it\n", std::string(expected.scene).c_str(),
              found.truth.dt, runs.dt / found.truth.dt);
  for (const std::string& text : runs.reservations) std::printf("  %s\n", text.c_str());
}

INSTANTIATE_TEST_SUITE_P(Scenes, HardCase, testing::ValuesIn(expectations()),
                         [](const auto& test) { return std::string(test.param.scene); });

// What the scenes are there for, in one place: who fails, and by how much.
TEST(HardCases, AreUnsafeForTheDiagonalEstimateByUpToRootThree) {
  double worst = 0;
  int unsafe = 0;
  for (const Expectation& e : expectations()) {
    worst = std::max(worst, e.diagonal);
    unsafe += e.diagonal > 1 ? 1 : 0;
  }
  EXPECT_NEAR(worst, std::sqrt(3.0), 1e-12);
  EXPECT_EQ(unsafe, 5);
}

// The limit of a state is looked for by running it, so a linear scene has to be told from one that is not.
TEST(EmpiricalLimit, SaysWhatIsNotLinear) {
  const auto reservations = [](std::string_view scene) {
    const assembly::State state = start_of(scene);
    const timestep::EmpiricalLimit found =
        timestep::empirical_limit(state, timestep::compare(state.model).truth);
    std::string all;
    for (const std::string& text : found.reservations) all += text + "; ";
    return all;
  };
  EXPECT_NE(reservations("taut_chain").find("contacts bear up to 2.0e-01 of k_n R"), std::string::npos);
  EXPECT_NE(reservations("breaking_bonds").find("opened or formed"), std::string::npos);
  EXPECT_EQ(reservations("oblique_pair"), "");
}

// With k_s = 0.95 k_n the axial mode is critical for K, and with the pull the transverse one for the cycle.
TEST(EmpiricalLimit, FindsAModeThatKPutsSecond) {
  const std::vector<std::string> overrides{"contacts.0.ks=0.95"};
  const assembly::State state = start_of("taut_chain", overrides);
  const timestep::Comparison found = timestep::compare(state.model);
  EXPECT_NEAR(timestep::empirical_limit(state, found.truth).dt / found.truth.dt,
              1 / std::sqrt(0.95 + 0.2 / 2.2), 2e-4);
}

// With k_s below F/d the column buckles, whatever the step. That is smooth, and the limit stays what it is.
TEST(EmpiricalLimit, TellsBucklingFromAStepThatIsTooLong) {
  const std::vector<std::string> overrides{"contacts.0.ks=0.05"};
  const assembly::State state = start_of("prestressed_column", overrides);
  const timestep::Comparison found = timestep::compare(state.model);
  const timestep::EmpiricalLimit runs = timestep::empirical_limit(state, found.truth);
  EXPECT_NEAR(runs.dt / found.truth.dt, 1, 2e-4);
  EXPECT_TRUE(std::any_of(runs.reservations.begin(), runs.reservations.end(), [](const std::string& text) {
    return text.find("unstable by itself") != std::string::npos;
  }));
}

TEST(EmpiricalLimit, OfNothingThatResistsIsInfinite) {
  const assembly::State state = start_of("ten_contacts_at_once");
  const timestep::Comparison found = timestep::compare(state.model);
  const timestep::EmpiricalLimit runs = timestep::empirical_limit(state, found.truth);
  EXPECT_TRUE(std::isinf(runs.dt));
  EXPECT_EQ(runs.runs, 0);
}

// The search does not depend on where it begins: a truth that is off is put right.
TEST(EmpiricalLimit, DoesNotRestOnTheTruthThatItIsToldOf) {
  const assembly::State state = start_of("oblique_chain");
  timestep::Truth truth = timestep::compare(state.model).truth;
  for (const double part : {0.3, 0.9, 1.2, 4.0}) {
    timestep::Truth told = truth;
    told.limit = part * truth.limit;
    EXPECT_NEAR(timestep::empirical_limit(state, told).dt / truth.limit, 1, 1e-4) << part;
  }
}

}  // namespace
}  // namespace eigengrain::test
