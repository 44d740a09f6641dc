// Policy `tracked`: what it keeps over a file, when it looks again, and what it is where proofs of its kind
// are not made. That it is never above the truth is in tests/verification/tracked_step_test.cpp.
#include "eigengrain/assembly/local_damping.hpp"
#include "eigengrain/assembly/within_rooms.hpp"
#include "eigengrain/cycle/bounds.hpp"
#include "eigengrain/cycle/policy.hpp"
#include "eigengrain/cycle/step_prover.hpp"
#include "eigengrain/io/scene_reader.hpp"

#include "support/dense.hpp"
#include "support/motion.hpp"
#include "support/restart.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdio>
#include <optional>
#include <set>
#include <string>
#include <utility>
#include <vector>

namespace eigengrain::test {
namespace {

using cycle::Cycle;

model::Scene scene_of(const std::string& more) {
  return io::read_scene_text(R"(
gravity: [1, 0, -9.81]
materials: [{name: grain, density: 2500}]
contacts: [{between: [grain, grain], law: linear, kn: 1e5, ks: 5e4, friction: 0.5}]
balls: [{fill: random, fraction: 0.25, radius: 5 mm, box: {min: [0, 0, 0], max: [0.08, 0.08, 0.3]}, seed: 2, material: grain}]
walls: [{box: {min: [0, 0, 0], max: [0.08, 0.08, 0.3], open: [+z]}, material: grain}]
damping: {local: 0.5}
)" + more,
                             ".", "scene.yaml");
}

/// A dense bed on which gravity begins to act: hardly anybody moves far.
model::Scene bed_of(const std::string& law) {
  return io::read_scene_text(R"(
gravity: [1.7, 0, -9.66]
materials: [{name: grain, density: 2500}]
contacts: [{between: [grain, grain], )" +
                                 law +
                                 R"(}]
balls: [{fill: dense, mean_overlap: 3e-4, radius: 5 mm, box: {min: [0, 0, 0], max: [0.06, 0.06, 0.06]}, seed: 2, material: grain}]
walls: [{box: {min: [0, 0, 0], max: [0.06, 0.06, 0.2], open: [+z]}, material: grain}]
damping: {local: 0.7}
timestep: {policy: tracked}
)",
                             ".", "scene.yaml");
}

const std::string linear = "law: linear, kn: 1e5, ks: 5e4, friction: 0.5";
const std::string tracked = "timestep: {policy: tracked}\n";

TEST(Tracked, GoesOnToTheBitFromAFile) {
  expect_to_continue(scene_of(tracked), 1500, {0, 1, 700});
}

TEST(Tracked, GoesOnToTheBitWhereSomeBodiesGotOtherRooms) {
  expect_to_continue(bed_of(linear), 900, {300, 450, 777});
}

TEST(Tracked, IsTheSameOnAnyNumberOfThreads) {
  const std::vector<std::string> overrides{"gravity=[1.7, 0, -9.66]", "timestep.policy=tracked"};
  const model::Scene scene = io::read_scene(EIGENGRAIN_EXAMPLES "/scenes/packing_10k.yaml", overrides);
  const auto run = [&](int count) {
    const Threads with(count);
    Cycle cycle(cycle::start(scene), cycle::policy_of(scene));
    cycle.run(150);
    return bits_of(cycle.state());
  };
  EXPECT_EQ(run(1), run(2));
}

TEST(Tracked, HasAGuardThatHoldsTheListToo) {
  Cycle cycle(cycle::start(scene_of(tracked)), cycle::policy_of(scene_of(tracked)));
  for (int k = 0; k < 2000; ++k) {
    cycle.step();
    const assembly::State& state = cycle.state();
    if (!state.guard) continue;
    for (std::size_t i = 0; i < state.guard->room.size(); ++i) {
      const Vec3& x = state.model.bodies.position[i];
      ASSERT_LE((x - state.guard->position[i]).norm(), state.guard->room[i] * (1 + 1e-12)) << "step " << k;
      ASSERT_LE((x - state.list.position[i]).norm(), 0.5 * state.list.skin * (1 + 1e-12)) << "step " << k;
    }
  }
  EXPECT_TRUE(cycle.state().guard.has_value());
}

/// Whether a prover that knows nothing but the guard finds that its weights prove its step, for all that can
/// touch within the rooms. Not where walls move.
bool is_proven(const assembly::State& state) {
  const assembly::StepGuard& guard = *state.guard;
  const assembly::WithinRooms contacts(state.model, guard.position, guard.room, 0);
  std::vector<double> alpha;
  for (const double growth : contacts.growth())
    alpha.push_back((1 + assembly::largest_damping(state.model)) * growth - 1);
  cycle::StepProver prover(contacts.system(), alpha);
  prover.set_weights(guard.weight);
  return prover.prove(guard.dt) && prover.weights() == guard.weight;
}

/// How often all was proven anew, and how often single bodies alone got other rooms.
struct Proofs {
  int of_all = 0;
  int of_some = 0;
  int failed = 0;  ///< that is_proven() does not confirm
};

template <class AfterStep>
Proofs count_proofs(const model::Scene& scene, int steps, const AfterStep& after_step) {
  Cycle cycle(cycle::start(scene), cycle::policy_of(scene));
  Proofs proofs;
  std::optional<assembly::StepGuard> before;
  for (int k = 0; k < steps; ++k) {
    cycle.step();
    const assembly::State& state = cycle.state();
    after_step(state);
    if (!state.guard) continue;
    const bool all = !before || before->step != state.guard->step;
    if (!all && before->position == state.guard->position && before->room == state.guard->room) continue;
    ++(all ? proofs.of_all : proofs.of_some);
    if (!is_proven(state)) ++proofs.failed;
    before = state.guard;
  }
  return proofs;
}

// What is kept between proofs, and changed where bodies left, says what a system made anew says.
TEST(Tracked, IsProvenByASystemMadeAnewAfterSomeBodiesGotOtherRooms) {
  for (const std::string& law :
       {linear, linear + ", beta_n: 0.2, beta_s: 0.1",
        std::string("law: hertz, effective_young: 1e7, effective_shear: 3e6, friction: 0.3")}) {
    const Proofs proofs = count_proofs(bed_of(law), 1000, [](const assembly::State&) {});
    std::printf("%s: all bodies %d times, some %d times\n", law.c_str(), proofs.of_all, proofs.of_some);
    EXPECT_EQ(proofs.failed, 0) << law;
    EXPECT_GT(proofs.of_some, 10) << law;
  }
}

// A ball is drawn over a row of others, which it touches one after the other.
TEST(Tracked, FollowsABallThatChangesItsNeighbours) {
  const model::Scene scene = io::read_scene_text(R"(
gravity: [0, 0, -9.81]
materials: [{name: grain, density: 2500}]
contacts: [{between: [grain, grain], law: linear, kn: 1e5, ks: 5e4, friction: 0.3}]
balls:
  - {lattice: square, radius: 5 mm, material: grain, box: {min: [0, 0, 0], max: [0.2, 0.01, 0.01]}}
  - {position: [7 mm, 5 mm, 15 mm], radius: 5 mm, material: grain, velocity: [0.1, 0, 0], fix: [x]}
walls: [{box: {min: [0, 0, 0], max: [0.2, 0.01, 0.1], open: [+z]}, material: grain}]
damping: {local: 0.5}
timestep: {policy: tracked}
)",
                                                 ".");
  constexpr std::int64_t drawn = 20;  // behind the row
  std::set<std::int64_t> neighbours;
  double largest = 0;
  std::int64_t step = 0;
  const Proofs proofs = count_proofs(scene, 25000, [&](const assembly::State& state) {
    const assembly::LinearSystem system(state.model);
    const std::vector<std::int64_t>& identity = state.model.bodies.identity;
    for (const contact::ContactElement& element : system.elements)
      for (const auto& [one, other] : {std::pair(element.a, element.b), std::pair(element.b, element.a)})
        if (one != contact::no_body && other != contact::no_body &&
            identity[static_cast<std::size_t>(one)] == drawn)
          neighbours.insert(identity[static_cast<std::size_t>(other)]);
    if (++step % 50 == 0)
      largest = std::max(largest, state.next_dt / cycle::damped_timestep(dense_truth(system), 0.5));
  });
  std::printf("%zu neighbours, step at most %.4f of the limit; all bodies %d times, some %d times\n",
              neighbours.size(), largest, proofs.of_all, proofs.of_some);
  EXPECT_EQ(proofs.failed, 0);
  EXPECT_LE(largest, 1);
  EXPECT_GE(neighbours.size(), 8U);
  EXPECT_GT(proofs.of_some, proofs.of_all);
}

// Radii that have grown have used up a part of the near list when the first guard is made.
TEST(Tracked, LosesNoContactAfterGrowth) {
  const auto energy = [](const std::string& policy) {
    const model::Scene scene = io::read_scene_text(R"(
materials: [{name: grain, density: 2500}]
contacts: [{between: [any, any], law: linear, kn: 1e5}]
balls:
  - {position: [0, 0, 0], radius: 5 mm, material: grain, velocity: [0.01, 0, 0], growth: {factor: 1.02, over: 1 ms}}
  - {position: [10.26 mm, 0, 0], radius: 5 mm, material: grain, velocity: [-0.01, 0, 0], growth: {factor: 1.02, over: 1 ms}}
damping: {local: 0}
timestep: {safety: 0.5, policy: )" + policy + "}\n",
                                                   ".");
    Cycle cycle(cycle::start(scene), cycle::policy_of(scene));
    while (cycle.state().time < 0.02) cycle.step();
    return cycle.state().model.bodies.velocity[0].norm();
  };
  EXPECT_NEAR(energy("tracked"), energy("bound"), 0.002);
}

TEST(Tracked, TakesLargerStepsThanTheBoundOfAllNearPairs) {
  const auto step_after = [](const std::string& policy) {
    const model::Scene scene = scene_of(policy);
    Cycle cycle(cycle::start(scene), cycle::policy_of(scene));
    cycle.run(8000);
    return cycle.state().next_dt;
  };
  const double bound = step_after("timestep: {policy: bound, safety: 0.98}\n");
  EXPECT_GT(step_after(tracked), 1.05 * bound);
}

// A cell that deforms and radii that change have no guard; the step is then the one of policy `bound`.
TEST(Tracked, IsTheBoundWhereItCannotTrack) {
  const std::string balls = R"(
materials: [{name: grain, density: 2500}]
contacts: [{between: [grain, grain], law: linear, kn: 1e5}]
timestep: {policy: tracked}
)";
  for (const char* const more : {
           "periodic: {box: [0.2, 0.2, 0.4], velocity_gradient: [[0, 0.1, 0], [0, 0, 0], [0, 0, 0]]}\n"
           "balls: [{position: [0, 0, 0], radius: 5 mm, material: grain}, {position: [0, 0, 9.9e-3], radius: "
           "5 mm, material: grain}]\n",
           "balls: [{position: [0, 0, 0], radius: 5 mm, material: grain, growth: {factor: 1.1, over: 1 s}}, "
           "{position: [0, 0, 9.9e-3], radius: 5 mm, material: grain}]\n",
       }) {
    model::Scene scene = io::read_scene_text(balls + more, ".");
    const assembly::State state = cycle::start(scene);
    const double step = cycle::policy_of(scene).dt(state);
    scene.timestep.policy = model::TimestepPolicy::bound;
    EXPECT_EQ(step, cycle::policy_of(scene).dt(state));
    EXPECT_TRUE(std::isfinite(step) && step > 0);
  }
}

// Nothing touches at first: the step is that of a first contact, as with policy `bound`.
TEST(Tracked, HasAStepBeforeAnythingTouches) {
  model::Scene scene = io::read_scene_text(R"(
gravity: [0, 0, -9.81]
materials: [{name: grain, density: 2500}]
contacts: [{between: [grain, grain], law: linear, kn: 1e5}]
balls: [{position: [0, 0, 0.05], radius: 5 mm, material: grain}]
walls: [{plane: {point: [0, 0, 0], normal: [0, 0, 1]}, material: grain}]
timestep: {policy: tracked}
)",
                                           ".");
  Cycle cycle(cycle::start(scene), cycle::policy_of(scene));
  const double first = cycle.state().next_dt;
  EXPECT_TRUE(std::isfinite(first));
  double highest = 0;
  for (int k = 0; k < 200000 && cycle.state().time < 0.5; ++k) {
    cycle.step();
    highest = std::max(highest, cycle.state().model.bodies.position[0].z());
  }
  EXPECT_LT(highest, 0.05);
  EXPECT_LT(cycle.state().model.bodies.velocity[0].norm(), 0.01);
}

TEST(Tracked, SaysWhatItTakesOfEvery) {
  const auto message = [](const std::string& timestep) {
    try {
      scene_of("timestep: " + timestep + "\n");
    } catch (const InputError& error) {
      return std::string(error.what());
    }
    return std::string();
  };
  EXPECT_EQ(message("{policy: tracked, every: auto}"), "");
  EXPECT_EQ(message("{policy: tracked, every: 200}"), "");
  EXPECT_EQ(message("{policy: bound, every: 200}"), "");
  EXPECT_NE(message("{policy: tracked, every: often}").find("neither auto nor a whole number"),
            std::string::npos);
  EXPECT_NE(message("{policy: tracked, every: 0}").find("neither auto nor a whole number"),
            std::string::npos);
  EXPECT_NE(message("{policy: fixed, dt: 1e-5, every: 200}").find("policy: tracked"), std::string::npos);
}

TEST(Tracked, HasItsOwnSafety) {
  EXPECT_EQ(scene_of("timestep: {policy: tracked}\n").timestep.safety, 0.98);
  EXPECT_EQ(scene_of("timestep: {policy: tracked, safety: 0.9}\n").timestep.safety, 0.9);
  EXPECT_EQ(scene_of("timestep: {policy: tracked}\n").timestep.every, 0);
  EXPECT_EQ(scene_of("timestep: {policy: bound, every: 50}\n").timestep.every, 50);
}

}  // namespace
}  // namespace eigengrain::test
