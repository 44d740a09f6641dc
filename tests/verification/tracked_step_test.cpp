// The step that is tracked in runs against the true limit of the contacts of the moment: at every 100th step
// it is not above, and in dense packings not far below.
#include "eigengrain/assembly/local_damping.hpp"
#include "eigengrain/cycle/policy.hpp"
#include "eigengrain/io/scene_reader.hpp"
#include "eigengrain/timestep/truth.hpp"

#include <fmt/format.h>
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

struct Poured {
  const char* what;
  const char* law;     ///< of all contacts
  double damping;      ///< α
  double floor_speed;  ///< m/s, upwards
  std::int64_t steps = 4001;
  double at_end = 0;  ///< step over limit, at least
};

TEST(TrackedStep, OfBallsThatFallAndSettleIsNeverAbove) {
  for (const Poured& poured :
       {Poured{"linear", "law: linear, kn: 1e5, ks: 5e4, friction: 0.5", 0.5, 0, 6001, 0.85},
        Poured{"Hertz", "law: hertz, effective_young: 1e7, effective_shear: 3e6, friction: 0.3", 0.3, 0},
        Poured{"dashpots", "law: linear, kn: 1e5, ks: 5e4, friction: 0.5, beta_n: 0.3, beta_s: 0.1", 0, 0},
        Poured{"a floor that rises", "law: linear, kn: 1e5, ks: 5e4, friction: 0.5", 0.5, 0.3}}) {
    model::Scene scene = pour(fmt::format(
        "contacts: [{{between: [grain, grain], {}}}]\ndamping: {{local: {}}}\n", poured.law, poured.damping));
    if (poured.floor_speed > 0)
      scene.wall_motions.push_back({.wall = 4,
                                    .start = scene.walls[4].point,
                                    .time = {0},
                                    .velocity = {{.translation = {0, 0, poured.floor_speed}}}});
    const Course run = track(scene, poured.steps);
    print(poured.what, run);
    EXPECT_LE(run.largest, 1) << poured.what;
    EXPECT_LE(run.proven, 1) << poured.what;
    EXPECT_GT(run.last, poured.at_end) << poured.what;
    EXPECT_GT(run.looks, 30) << poured.what;
  }
}

}  // namespace
}  // namespace eigengrain::test
