// Equilibrium of a real packing: found, deep, and kept by the explicit cycle.
#include "eigengrain/base/error.hpp"
#include "eigengrain/base/parallel.hpp"
#include "eigengrain/cycle/cycle.hpp"
#include "eigengrain/cycle/policy.hpp"
#include "eigengrain/io/scene_reader.hpp"
#include "eigengrain/relaxation/relax.hpp"

#include "support/clumps.hpp"
#include "support/laws.hpp"
#include "support/motion.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

namespace eigengrain::test {
namespace {

assembly::State tilted(const char* scene_file, double degrees) {
  model::Scene scene = io::read_scene(std::string(EIGENGRAIN_EXAMPLES "/scenes/") + scene_file);
  const double angle = degrees * std::numbers::pi / 180;
  scene.gravity = scene.gravity.norm() * Vec3(std::sin(angle), 0, -std::cos(angle));
  return cycle::start(scene);
}

/// The greatest mean ratio while the explicit cycle runs on.
double kept(assembly::State state, std::int64_t steps) {
  const cycle::TimestepPolicy policy = cycle::policy_of(state.settings);
  cycle::Cycle cycle(std::move(state), policy);
  double worst = 0;
  for (std::int64_t done = 0; done < steps; done += 100) {
    cycle.run(100);
    worst = std::max(worst, assembly::balance_of(cycle.state()).mean);
  }
  return worst;
}

TEST(Relax, Tilted10kEndsAtTheRoundingOfPositionsAndStaysThere) {
  assembly::State state = tilted("packing_10k.yaml", 10);
  const relaxation::RelaxResult result = relaxation::relax(state);
  EXPECT_TRUE(result.converged);
  EXPECT_NE(result.method.find("newton"), std::string::npos) << result.method;
  EXPECT_GT(result.start.mean, 1e-2);
  EXPECT_LE(result.end.mean, 1e-10);
  EXPECT_EQ(result.end.unsupported, 0);
  // As the explicit code evaluates it, now and later.
  EXPECT_LE(assembly::balance_of(state).mean, 1e-10);
  EXPECT_LE(kept(std::move(state), 1000), 1e-10);
}

// A dumbbell lies on both its balls, 1.4 apart: N_2 - N_1 = M/0.7, N_1 + N_2 = F. A ball beside it is pulled
// down.
TEST(Relax, BearsAppliedForcesAndMoments) {
  constexpr double k = 1e4;
  SceneBuilder builder({.kn = k, .tension = false});
  builder.plane({0, 0, 0}, {0, 0, 1});
  builder.ball({9, 0, 1}).loaded({0, 0, -20});
  model::ClumpShape shape = dumbbell();
  builder.clump(shape, {.position = {0, 0, 1}, .force = {0, 0, -50}, .moment = {0, 7, 0}});
  assembly::State state = cycle::start(builder.scene());
  const relaxation::RelaxResult result = relaxation::relax(state);
  EXPECT_TRUE(result.converged);
  const auto overlap = [&](std::int64_t identity) {
    return 1 - state.model.bodies.position[row_of(state, identity)].z();
  };
  // To rounding of places of order one, but that the lever is 0.7 cos of a tilt of 1e-3/1.4.
  EXPECT_NEAR(overlap(0), 20 / k, 1e-13);
  const double right = state.model.bodies.position[row_of(state, 1)].x() > 0 ? overlap(1) : overlap(2);
  const double left = state.model.bodies.position[row_of(state, 1)].x() > 0 ? overlap(2) : overlap(1);
  EXPECT_NEAR(right, 30 / k, 5e-7 * 7 / 1.4 / k + 1e-13);
  EXPECT_NEAR(left, 20 / k, 5e-7 * 7 / 1.4 / k + 1e-13);
  EXPECT_LE(kept(std::move(state), 300), 1e-10);
}

TEST(Relax, FindsTheWeightOfAColumn) {
  SceneBuilder builder({.kn = 1e4, .ks = 5e3, .tension = false});
  builder.plane({0, 0, 0}, {0, 0, 1});
  for (int k = 0; k < 5; ++k) builder.ball({0, 0, 1 + 2.0 * k});
  builder.scene().gravity = Vec3(0, 0, -10);
  assembly::State state = cycle::start(builder.scene());
  const relaxation::RelaxResult result = relaxation::relax(state);
  EXPECT_TRUE(result.converged);
  // The contact below ball k carries 5 - k balls of mass 1; positions are of order 10.
  double height = 0;
  for (int k = 0; k < 5; ++k) {
    height += (k == 0 ? 1.0 : 2.0) - (5 - k) * 10.0 / 1e4;
    for (std::size_t i = 0; i < 5; ++i) {
      if (state.model.bodies.identity[i] != k) continue;
      EXPECT_NEAR(state.model.bodies.position[i].z(), height, 1e-11);
    }
  }
  for (const Vec3& v : state.model.bodies.velocity) EXPECT_EQ(v, Vec3(Vec3::Zero()));
  EXPECT_EQ(state.step, 0);
}

// An equilibrium is one of springs: what dashpots did in the last step before is none of it.
TEST(Relax, ForgetsTheDashpotsOfTheStepBefore) {
  SceneBuilder builder = with_law("linear", {{"kn", 1e4}, {"beta_n", 5}});
  builder.ball({0, 0, 1 - 1e-3}).moving({0, 0, 1}).plane({0, 0, 0}, {0, 0, 1}).gravity({0, 0, -10});
  cycle::Cycle cycle(cycle::start(builder.scene()), {[](const assembly::State&) { return 1e-6; }, 0});
  cycle.run(2);
  assembly::State state = cycle.release();
  EXPECT_LT(state.force[0].z(), 0);  // the dashpot pulls more than the spring pushes
  relaxation::RelaxOptions options;
  options.tolerance = 10;
  EXPECT_TRUE(relaxation::relax(state, options).converged);
  EXPECT_EQ(state.force, assembly::contact_forces(state.model).force);
}

TEST(Relax, GivesTheSameBitsOnOneAndTwoThreads) {
  const auto relaxed = [](int count) {
    set_threads(count);
    assembly::State state = tilted("packing_10k.yaml", 0);
    relaxation::RelaxOptions options;
    options.tolerance = 1e-5;
    relaxation::relax(state, options);
    return state.model.bodies.position;
  };
  EXPECT_EQ(relaxed(1), relaxed(2));
}

TEST(Relax, SaysThatBallsFallForEver) {
  SceneBuilder builder({.kn = 1e4, .ks = 0, .tension = false});
  builder.ball({0, 0, 1e6}).ball({0, 0, 1e6 + 2});
  builder.plane({0, 0, 0}, {0, 0, 1});
  builder.scene().gravity = Vec3(0, 0, -10);
  assembly::State state = cycle::start(builder.scene());
  relaxation::RelaxOptions options;
  options.max_steps = 500;
  const relaxation::RelaxResult result = relaxation::relax(state, options);
  EXPECT_FALSE(result.converged);
  EXPECT_EQ(result.end.unsupported, 2);
}

}  // namespace
}  // namespace eigengrain::test
