// A few bodies of a packing cycled by themselves.
#include "eigengrain/assembly/forces.hpp"
#include "eigengrain/cycle/cycle.hpp"
#include "eigengrain/cycle/policy.hpp"
#include "eigengrain/io/scene_reader.hpp"
#include "eigengrain/relaxation/relax.hpp"

#include "relaxation/part.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <vector>

namespace eigengrain::test {
namespace {

/// A settled bed of 1,000 balls, the highest of them lifted by this many of its radii.
assembly::State lifted(double radii) {
  model::Scene scene = io::read_scene_text(R"(
gravity: [0, 0, -9.81]
materials: [{name: grain, density: 2500}]
contacts: [{between: [grain, grain], law: linear, kn: 1.0e5, ks: 5.0e4, friction: 0.5}]
balls: [{file: packing_1k.txt, material: grain}]
walls: [{box: {min: [0, 0, 0], max: [0.1, 0.1, 0.2], open: [+z]}, material: grain}]
damping: {local: 0.7}
)",
                                           EIGENGRAIN_TEST_DATA "/../peers", "bed");
  model::Bodies& balls = scene.bodies;
  const auto highest = std::max_element(balls.position.begin(), balls.position.end(),
                                        [](const Vec3& l, const Vec3& r) { return l.z() < r.z(); });
  highest->z() += radii * balls.radius[highest - balls.position.begin()];
  return cycle::start(scene);
}

double largest_difference(const std::vector<Vec3>& left, const std::vector<Vec3>& right) {
  double most = 0;
  for (std::size_t i = 0; i < left.size(); ++i) most = std::max(most, (left[i] - right[i]).norm());
  return most;
}

std::vector<std::int32_t> highest_of(const assembly::State& state) {
  const std::vector<Vec3>& x = state.model.bodies.position;
  return {static_cast<std::int32_t>(
      std::max_element(x.begin(), x.end(), [](const Vec3& l, const Vec3& r) { return l.z() < r.z(); }) -
      x.begin())};
}

TEST(Part, ThatDoesNothingLeavesTheWholeAsItWas) {
  assembly::State state = lifted(0);
  const cycle::TimestepPolicy policy = cycle::policy_of(state.settings);
  cycle::Cycle cycle(std::move(state), policy);
  cycle.run(50);  // for a history of shear
  state = cycle.release();
  for (Vec3& v : state.model.bodies.velocity) v.setZero();
  for (Vec3& w : state.model.bodies.spin) w.setZero();
  const assembly::State before = state;
  relaxation::Part part(state, highest_of(state));
  EXPECT_LT(part.state().model.bodies.size(), 300);
  const assembly::State untouched = part.state();
  EXPECT_TRUE(part.has_room(untouched));
  part.put_back(untouched, state);
  EXPECT_EQ(state.model.bodies.position, before.model.bodies.position);
  // Forces are found anew, and carrying a shear force nowhere rounds it: contacts bear up to some newtons.
  EXPECT_LT(largest_difference(state.force, before.force), 1e-14);
  EXPECT_LT(largest_difference(state.moment, before.moment), 1e-16);
}

TEST(Part, HoldsAllButTheMoversAndTheirNeighbours) {
  assembly::State state = lifted(3);
  const std::vector<std::int32_t> mover = highest_of(state);
  const std::vector<Vec3> before = state.model.bodies.position;
  relaxation::Part part(state, mover);
  cycle::Cycle cycle(std::move(part.state()), cycle::policy_of(state.settings));
  cycle.run(20);
  part.put_back(cycle.state(), state);
  const std::vector<Vec3>& after = state.model.bodies.position;
  EXPECT_LT(after[mover[0]].z(), before[mover[0]].z());
  std::size_t moved = 0;
  for (std::size_t i = 0; i < after.size(); ++i) moved += after[i] != before[i] ? 1 : 0;
  EXPECT_GE(moved, 1U);
  EXPECT_LT(moved, 30U);
}

TEST(Relax, LetsABallThatFallsComeToRestByItself) {
  assembly::State state = lifted(3);
  const relaxation::RelaxResult result = relaxation::relax(state);
  EXPECT_TRUE(result.converged);
  EXPECT_EQ(result.end.unsupported, 0);
  EXPECT_LE(assembly::balance_of(state).mean, 1e-10);
  EXPECT_GT(result.part_steps, 0);
}

}  // namespace
}  // namespace eigengrain::test
