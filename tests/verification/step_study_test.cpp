#include "eigengrain/timestep/step_study.hpp"

#include "eigengrain/base/error.hpp"
#include "eigengrain/cycle/cycle.hpp"

#include "support/bonds.hpp"
#include "support/lattices.hpp"
#include "support/laws.hpp"
#include "support/motion.hpp"
#include "support/scenes.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <cstddef>
#include <limits>
#include <numbers>
#include <string>

namespace eigengrain::test {
namespace {

using testing::HasSubstr;
using timestep::StepRun;
using timestep::StepStudy;
using timestep::StepStudyOptions;
using timestep::study_steps;

/// A ball of mass 1 on a spring of stiffness 1 to one that is fixed, started along it with a velocity: ω = 1,
/// and the limit of the step is 2.
assembly::State oscillator() {
  SceneBuilder builder;
  builder.ball(Vec3::Zero(), 1, 1, fix_all).ball({2 * touching, 0, 0}).moving({1e-3, 0, 0});
  return cycle::start(builder.scene());
}

/// √(mean over samples and the two balls of |x_dt(t) - x(t)|²) of the oscillator: leapfrog moves it as
/// v₀ Δt/sin θ · sin(nθ) with sin(θ/2) = Δt/2, time as v₀ sin t.
double exact_error(const StepRun& run, const StepStudy& study) {
  const double theta = 2 * std::asin(0.5 * run.dt);
  double sum = 0;
  for (std::int64_t sample = 1; sample <= study.samples; ++sample) {
    const double time = study.time * static_cast<double>(sample) / static_cast<double>(study.samples);
    const double found = 1e-3 * run.dt / std::sin(theta) * std::sin(time / run.dt * theta);
    sum += std::pow(found - 1e-3 * std::sin(time), 2);
  }
  return std::sqrt(sum / (2 * static_cast<double>(study.samples)));
}

TEST(StepStudy, OfAnOscillatorHasTheErrorsOfItsDiscreteFrequency) {
  const StepStudy study = study_steps(oscillator(), {.limit = 2, .time = 170});
  EXPECT_EQ(study.samples, 4);
  EXPECT_EQ(study.reference.extrapolated_order, 2);
  ASSERT_EQ(study.runs.size(), 11U);
  for (const StepRun& run : study.runs) {
    // The reference errs by its own uncertainty; the overlap that makes the contact is 2e-12.
    EXPECT_NEAR(run.trajectory, exact_error(run, study), study.reference.uncertainty + 1e-11) << run.fraction;
    // The ledger of a linear system closes to rounding: an ulp of a position near 2, over 1e-3, each step.
    EXPECT_LT(run.energy, 1e-10 * study.energy) << run.fraction;
  }
  EXPECT_NEAR(study.reference.order, 2, 0.02);
  EXPECT_LT(study.reference.uncertainty, 1e-3 * study.runs.front().trajectory);
  EXPECT_LT(study.sensitivity.growth, 10);
}

TEST(StepStudy, CountsStepsSoThatAllRunsEndTogether) {
  const StepStudy study = study_steps(oscillator(), {.fractions = {1.0, 0.25, 0.5}, .limit = 2, .time = 170});
  ASSERT_EQ(study.runs.size(), 3U);
  for (const StepRun& run : study.runs) {
    EXPECT_NEAR(run.dt * static_cast<double>(run.steps), 170, 1e-10);
    EXPECT_EQ(run.steps % study.samples, 0);
  }
  EXPECT_LE(study.runs[0].fraction, 0.25);
  EXPECT_GT(study.runs[2].fraction, 0.9);
  EXPECT_LT(study.runs[0].dt, study.runs[1].dt);
}

/// Six balls that are cemented into a cantilever and set swinging across: bending, shear and rotation in
/// total form, a smooth motion.
TEST(StepStudy, OfABondedBeamIsOfSecondOrder) {
  SceneBuilder builder;
  builder.ball(Vec3::Zero(), 1, 1, fix_all);
  for (int k = 1; k < 6; ++k) builder.ball({2.0 * k, 0, 0}).moving({0, 1e-3 * k * k, 0});
  builder.without_law().bonded(Cemented().rule());
  const assembly::State beam = cycle::start(builder.scene());
  const double limit = 2 / std::sqrt(System(builder).spectrum().maxCoeff());
  const StepStudy study =
      study_steps(beam, {.fractions = {0.025, 0.05, 0.1, 0.2}, .limit = limit, .time = 60 * limit});
  EXPECT_EQ(study.reference.extrapolated_order, 2);
  for (std::size_t k = 1; k < study.runs.size(); ++k) {
    ASSERT_TRUE(study.runs[k].trajectory_order.has_value()) << k;
    EXPECT_NEAR(*study.runs[k].trajectory_order, 2, 0.1) << study.runs[k].fraction;
    ASSERT_TRUE(study.runs[k].energy_order.has_value()) << k;
    EXPECT_NEAR(*study.runs[k].energy_order, 2, 0.25) << study.runs[k].fraction;
  }
}

/// A ball of mass 1 above a floor, ω = 100, dropped from a height of 0.5 at g = 1.
assembly::State dropped() {
  SceneBuilder builder({.kn = 1e4, .tension = false});
  builder.ball({0, 0, 1.5}).plane(Vec3::Zero(), {0, 0, 1}).gravity({0, 0, -1});
  return cycle::start(builder.scene());
}

/// The same thrown at it without gravity, with a dashpot.
assembly::State thrown(double beta) {
  SceneBuilder builder({.kn = 1e4, .tension = false});
  builder.ball({0, 0, 1.01}).moving({0, 0, -1}).plane(Vec3::Zero(), {0, 0, 1});
  builder.scene().contacts.back().parameters = values_of("linear", {{"kn", 1e4}, {"beta_n", beta}});
  return cycle::start(builder.scene());
}

TEST(StepStudy, FindsEveryImpactOfABouncingBall) {
  // Falls for √(2h/g) = 1 s and is up again 2 s and a contact time of π/100 later.
  const StepStudy study = study_steps(dropped(), {.fractions = {0.02, 0.04}, .limit = 0.02, .time = 8});
  EXPECT_EQ(study.impacts, 4);  // at 1, 3.03, 5.06 and 7.09 s
  // Where a contact begins and ends within a step changes the energy by ¼Δt²k/m of it at most, and its root
  // by half of that.
  EXPECT_NEAR(study.reference.mean_restitution, 1, 0.125 * std::pow(study.reference.dt, 2) * 1e4);
  for (const StepRun& run : study.runs)
    EXPECT_LT(run.restitution, 0.25 * run.dt * run.dt * 1e4) << run.fraction;
}

TEST(StepStudy, MeasuresTheRestitutionOfADashpot) {
  constexpr double beta = 0.1;
  const StepStudy study =
      study_steps(thrown(beta), {.fractions = {0.02, 0.04, 0.08}, .limit = 0.018, .time = 0.4});
  const double exact = std::exp(-std::numbers::pi * beta / std::sqrt(1 - beta * beta));
  EXPECT_EQ(study.impacts, 1);
  // e errs in the first order: the dashpot's velocity is half a step old over the impact (½πβωΔt), and its
  // force, which sets in with a jump of 2βωv, begins and ends within a step (2βωΔt at each end).
  const auto bound = [&](double dt) { return (0.5 * std::numbers::pi + 4) * beta * 100 * dt; };
  EXPECT_NEAR(study.reference.mean_restitution, exact, bound(study.reference.dt));
  for (const StepRun& run : study.runs)
    EXPECT_NEAR(run.mean_restitution, exact, bound(run.dt)) << run.fraction;
}

TEST(StepStudy, RefusesWhatHasNoMeaning) {
  const auto message = [](const StepStudyOptions& options) {
    try {
      study_steps(oscillator(), options);
    } catch (const InputError& error) {
      return std::string(error.what());
    }
    return std::string();
  };
  EXPECT_THAT(message({.fractions = {}, .limit = 2, .time = 10}), HasSubstr("at least one"));
  EXPECT_THAT(message({.fractions = {0.1, -0.5}, .limit = 2, .time = 10}), HasSubstr("-0.5 of the limit"));
  EXPECT_THAT(message({.fractions = {3}, .limit = 2, .time = 10}), HasSubstr("up to 2"));
  EXPECT_THAT(message({.limit = 2, .time = 1}), HasSubstr("less than one critical step"));
  EXPECT_THAT(message({.limit = std::numeric_limits<double>::infinity(), .time = 1}),
              HasSubstr("no critical step"));
}

TEST(StepStudy, SaysWhichStepsBlowUp) {
  const StepStudy study = study_steps(oscillator(), {.fractions = {0.1, 1.05}, .limit = 2, .time = 1000});
  EXPECT_TRUE(study.runs[0].trouble.empty());
  EXPECT_THAT(study.runs[1].trouble, testing::Not(testing::IsEmpty()));
  EXPECT_TRUE(std::isnan(study.runs[1].trajectory));
}

TEST(StepStudy, KnowsChaosFromError) {
  // Balls that fly about in a box of planes and scatter each other.
  SceneBuilder builder({.kn = 1e4, .tension = false});
  std::mt19937_64 random(5);
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j)
      builder.ball({2.5 * i + 1.5, 2.5 * j + 1.5, 1.5}).moving(random_vector(random));
  for (int k = 0; k < 3; ++k) {
    builder.plane(Vec3::Zero(), Vec3::Unit(k));
    builder.plane(Vec3::Constant(8), -Vec3::Unit(k));
  }
  const StepStudy study =
      study_steps(cycle::start(builder.scene()), {.fractions = {0.2, 0.4}, .limit = 0.0141, .time = 60});
  EXPECT_TRUE(study.sensitivity.chaotic()) << study.sensitivity.growth;
  EXPECT_FALSE(study.runs[1].trajectory_order.has_value());
  // Nothing takes energy: nearly all of it is kinetic at any moment, whatever the paths.
  EXPECT_NEAR(study.runs[0].statistics.kinetic / study.reference.statistics.kinetic, 1, 0.1);
}

}  // namespace
}  // namespace eigengrain::test
