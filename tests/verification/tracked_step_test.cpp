// The step that is tracked in runs against the true limit of the contacts of the moment: at every 100th step
// it is not above, and in dense packings not far below.
#include "eigengrain/assembly/local_damping.hpp"
#include "eigengrain/cycle/policy.hpp"
#include "eigengrain/io/scene_reader.hpp"
#include "eigengrain/timestep/truth.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <limits>
#include <string>

namespace eigengrain::test {
namespace {

struct Course {
  double largest = 0;  ///< step over the limit
  double proven = 0;   ///< what was proven over the limit, at most
  double mean = 0;
  double last = 0;
  int looks = 0;
};

Course track(const model::Scene& scene, std::int64_t steps, std::int64_t every = 100) {
  cycle::Cycle cycle(cycle::start(scene), cycle::policy_of(scene));
  Course run;
  for (std::int64_t k = 0; k < steps; ++k) {
    cycle.step();
    if (k % every != 0) continue;
    const assembly::State& state = cycle.state();
    const assembly::LinearSystem system(state.model);
    const double limit = timestep::critical_timestep(system, assembly::largest_damping(state.model)).limit;
    if (!std::isfinite(limit)) continue;
    run.last = state.next_dt / limit;
    run.largest = std::max(run.largest, run.last);
    if (state.guard) run.proven = std::max(run.proven, state.guard->dt / limit);
    run.mean += run.last;
    ++run.looks;
  }
  run.mean /= std::max(1, run.looks);
  return run;
}

void print(const char* what, const Course& run) {
  std::printf("%s: step over limit %.4f in the mean, %.4f at most, %.4f at the end; proven at most %.4f\n",
              what, run.mean, run.largest, run.last, run.proven);
}

TEST(TrackedStep, OfAPackingThatTiltsIsCloseToTheLimitAndNeverAbove) {
  const std::vector<std::string> tilted{"gravity=[1.7, 0, -9.66]", "timestep.policy=tracked"};
  const Course run = track(io::read_scene(EIGENGRAIN_EXAMPLES "/scenes/packing_10k.yaml", tilted), 1501);
  print("10,000 balls, tilted", run);
  EXPECT_LE(run.largest, 1);
  EXPECT_LE(run.proven, 1);
  EXPECT_GT(run.mean, 0.90);
}

model::Scene pour(const std::string& more) {
  return io::read_scene_text(R"(
gravity: [0, 0, -9.81]
materials: [{name: grain, density: 2500}]
balls: [{fill: random, fraction: 0.2, sizes: {distribution: uniform, min: 3 mm, max: 6 mm}, box: {min: [0, 0, 0], max: [0.1, 0.1, 0.3]}, seed: 2, material: grain}]
walls: [{box: {min: [0, 0, 0], max: [0.1, 0.1, 0.5], open: [+z]}, material: grain}]
timestep: {policy: tracked}
)" + more,
                             ".");
}

TEST(TrackedStep, OfBallsThatFallAndSettleIsNeverAbove) {
  const Course run = track(pour(R"(
contacts: [{between: [grain, grain], law: linear, kn: 1e5, ks: 5e4, friction: 0.5}]
damping: {local: 0.5}
)"),
                           6001);
  print("balls that fall", run);
  EXPECT_LE(run.largest, 1);
  EXPECT_LE(run.proven, 1);
  EXPECT_GT(run.last, 0.8);
}

TEST(TrackedStep, OfHertzContactsIsNeverAbove) {
  const Course run = track(pour(R"(
contacts: [{between: [grain, grain], law: hertz, effective_young: 1e7, effective_shear: 3e6, friction: 0.3}]
damping: {local: 0.3}
)"),
                           4001);
  print("Hertz", run);
  EXPECT_LE(run.largest, 1);
  EXPECT_LE(run.proven, 1);
}

TEST(TrackedStep, WithDashpotsIsNeverAbove) {
  const Course run = track(pour(R"(
contacts: [{between: [grain, grain], law: linear, kn: 1e5, ks: 5e4, friction: 0.5, beta_n: 0.3, beta_s: 0.1}]
damping: {local: 0}
)"),
                           4001);
  print("dashpots", run);
  EXPECT_LE(run.largest, 1);
  EXPECT_LE(run.proven, 1);
}

TEST(TrackedStep, WithAWallThatMovesIsNeverAbove) {
  model::Scene scene = pour(R"(
contacts: [{between: [grain, grain], law: linear, kn: 1e5, ks: 5e4, friction: 0.5}]
damping: {local: 0.5}
)");
  const Vec3 floor = scene.walls[4].point;
  scene.wall_motions.push_back(
      {.wall = 4, .start = floor, .time = {0}, .velocity = {{.translation = {0, 0, 0.3}}}});
  const Course run = track(scene, 4001);
  print("a floor that rises", run);
  EXPECT_LE(run.largest, 1);
  EXPECT_LE(run.proven, 1);
}

}  // namespace
}  // namespace eigengrain::test
