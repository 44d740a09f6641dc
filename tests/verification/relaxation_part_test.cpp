// A few bodies of a packing cycled by themselves.
#include "eigengrain/assembly/bonds.hpp"
#include "eigengrain/assembly/contact_list.hpp"
#include "eigengrain/assembly/forces.hpp"
#include "eigengrain/cycle/cycle.hpp"
#include "eigengrain/cycle/policy.hpp"
#include "eigengrain/io/scene_reader.hpp"
#include "eigengrain/relaxation/relax.hpp"

#include "relaxation/part.hpp"
#include "support/motion.hpp"
#include "support/scenes.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <iterator>
#include <limits>
#include <string>
#include <vector>

namespace eigengrain::test {
namespace {

constexpr const char* box =
    "walls: [{box: {min: [0, 0, 0], max: [0.1, 0.1, 0.2], open: [+z]}, material: grain}]";
constexpr const char* mesh =
    "walls:\n"
    "  - {box: {min: [0, 0, 0], max: [0.1, 0.1, 0.2], open: [+z, -z]}, material: grain}\n"
    "  - {polygon: {corners: [[0, 0, 0], [0.1, 0, 0], [0.1, 0.1, 0], [0, 0.1, 0]]}, material: grain}";
constexpr const char* cell =
    "periodic: {box: [0.1, 0.1, 0.2], axes: [x, y]}\n"
    "walls: [{plane: {point: [0, 0, 0], normal: [0, 0, 1]}, material: grain}]";

/// A bed of 1,000 balls that settled in the box, the highest of them lifted by this many of its radii.
assembly::State lifted(double radii, const std::string& surroundings = box) {
  model::Scene scene = io::read_scene_text(R"(
gravity: [0, 0, -9.81]
materials: [{name: grain, density: 2500}]
contacts: [{between: [grain, grain], law: linear, kn: 1.0e5, ks: 5.0e4, friction: 0.5}]
balls: [{file: packing_1k.txt, material: grain}]
damping: {local: 0.7}
)" + surroundings,
                                           EIGENGRAIN_TEST_DATA "/../peers", "bed");
  model::Bodies& balls = scene.bodies;
  const auto highest = std::max_element(balls.position.begin(), balls.position.end(),
                                        [](const Vec3& l, const Vec3& r) { return l.z() < r.z(); });
  highest->z() += radii * balls.radius[highest - balls.position.begin()];
  return cycle::start(scene);
}

std::int32_t lowest_of(const assembly::State& state) {
  const std::vector<Vec3>& x = state.model.bodies.position;
  return static_cast<std::int32_t>(
      std::min_element(x.begin(), x.end(), [](const Vec3& l, const Vec3& r) { return l.z() < r.z(); }) -
      x.begin());
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

/// The row of the ball in the middle of bonded_row.
std::size_t middle_of(const assembly::State& state) {
  const std::vector<std::int64_t>& identity = state.model.bodies.identity;
  return static_cast<std::size_t>(std::find(identity.begin(), identity.end(), 4) - identity.begin());
}

/// Force or moment of the contacts on a body.
Vec3 total_on(const assembly::State& state, std::size_t row, bool moment) {
  return moment ? state.moment[row] : state.force[row];
}

TEST(Part, ThatDoesNothingLeavesTheWholeAsItWas) {
  for (const char* surroundings : {box, mesh, cell}) {
    SCOPED_TRACE(surroundings);
    assembly::State state = lifted(0, surroundings);
    const cycle::TimestepPolicy policy = cycle::policy_of(state.settings);
    cycle::Cycle cycle(std::move(state), policy);
    cycle.run(50);  // for a history of shear
    state = cycle.release();
    for (Vec3& v : state.model.bodies.velocity) v.setZero();
    for (Vec3& w : state.model.bodies.spin) w.setZero();
    // The highest, and one that touches the floor: with walls in its part.
    for (const std::int32_t mover : {highest_of(state)[0], lowest_of(state)}) {
      assembly::renew_list(state, state.list.skin);
      const assembly::State before = state;
      relaxation::Part part(state, std::vector{mover});
      EXPECT_LT(part.state().model.bodies.size(), 300);
      const assembly::State untouched = part.state();
      EXPECT_TRUE(part.has_room(untouched));
      part.put_back(untouched, state);
      EXPECT_EQ(state.model.bodies.position, before.model.bodies.position);
      EXPECT_EQ(state.model.contacts.size(), before.model.contacts.size());
      // Forces are found anew, and carrying a shear force nowhere rounds it: contacts bear up to some
      // newtons.
      EXPECT_LT(largest_difference(state.force, before.force), 1e-14);
      EXPECT_LT(largest_difference(state.moment, before.moment), 1e-16);
    }
  }
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

/// A row of nine bonded balls in the air, the middle one moving.
assembly::State bonded_row(const std::string& kind, double tension) {
  const double infinity = std::numeric_limits<double>::infinity();
  SceneBuilder builder(Springs{.kn = 1, .ks = 0.5, .tension = false});
  for (int k = 0; k < 9; ++k) builder.ball({2.0 * k, 0, 0});
  builder.bonded(kind == "contact" ? model::BondRule{kind, {tension, infinity}, 0.5}
                                   : model::BondRule{kind, {1, 1, 0.5, tension, infinity, 0}, 0.5});
  assembly::State state = cycle::start(builder.scene());
  state.model.bodies.velocity[middle_of(state)] = {0, 0.02, 0.01};
  if (state.turns()) state.model.bodies.spin[middle_of(state)] = {0.01, 0, 0.02};
  return state;
}

TEST(Part, TakesBondsAndOrientationsWithIt) {
  for (const std::string kind : {"parallel", "contact"}) {
    assembly::State state = bonded_row(kind, std::numeric_limits<double>::infinity());
    const auto middle = static_cast<std::int32_t>(middle_of(state));
    const std::vector<std::int32_t> movers{middle};
    ASSERT_EQ(assembly::count_bonds(state.model), 8);
    relaxation::Part part(state, movers);
    // The mover, its two neighbours, and one held ball on each side: four bonds hang on free balls.
    EXPECT_EQ(part.state().model.bodies.size(), 5);
    EXPECT_EQ(assembly::count_bonds(part.state().model), 4);
    cycle::Cycle cycle(std::move(part.state()), fixed_step(0.1));
    cycle.run(20);
    const assembly::State& end = cycle.state();
    part.put_back(end, state);
    EXPECT_EQ(assembly::count_bonds(state.model), 8) << kind;
    std::size_t turned = 0;
    for (const Quat& q : state.model.bodies.orientation) turned += q.coeffs() != Quat::Identity().coeffs();
    EXPECT_EQ(turned, kind == "parallel" ? 3U : 0U);
    // The whole feels what the part felt: a bond that was lost, or found another place, would pull otherwise.
    for (const bool moment : {false, true}) {
      const Vec3 of_part = total_on(end, middle_of(end), moment);
      EXPECT_GT(of_part.norm(), 1e-4);
      EXPECT_LT((total_on(state, middle_of(state), moment) - of_part).norm(), 1e-14) << kind;
    }
  }
}

TEST(Part, TellsTheWholeWhichBondsBroke) {
  for (const std::string kind : {"parallel", "contact"}) {
    assembly::State state = bonded_row(kind, 1e-9);
    const std::vector<std::int32_t> movers{static_cast<std::int32_t>(middle_of(state))};
    relaxation::Part part(state, movers);
    cycle::Cycle cycle(std::move(part.state()), fixed_step(0.1));
    cycle.run(20);
    part.put_back(cycle.state(), state);
    EXPECT_GT(state.breaks.size(), 0U) << kind;
    EXPECT_EQ(std::ssize(state.breaks) + assembly::count_bonds(state.model), 8) << kind;
  }
}

// A body that was free in one part, and has a velocity from there, may be held in the next.
TEST(Part, HoldsBodiesThatWereFreeInAnother) {
  assembly::State state = lifted(0);
  for (Vec3& v : state.model.bodies.velocity) v = Vec3(1, 2, 3);
  for (Vec3& w : state.model.bodies.spin) w = Vec3(4, 5, 6);
  relaxation::Part part(state, highest_of(state));
  const model::Bodies& bodies = part.state().model.bodies;
  int held = 0;
  for (std::size_t i = 0; i < bodies.position.size(); ++i) {
    if (!bodies.fixed[i].all()) continue;
    ++held;
    EXPECT_EQ(bodies.velocity[i], Vec3::Zero());
    EXPECT_EQ(bodies.spin[i], Vec3::Zero());
  }
  EXPECT_GT(held, 0);
}

// So fast that it would cross the rings of its part between two looks at the ratio.
TEST(Relax, LetsABallFallFromHigh) {
  assembly::State state = lifted(100);
  const relaxation::RelaxResult result = relaxation::relax(state);
  EXPECT_TRUE(result.converged);
  EXPECT_GT(result.part_steps, 0);
}

TEST(Relax, LetsABallThatFallsComeToRestByItself) {
  for (const char* surroundings : {box, mesh}) {
    SCOPED_TRACE(surroundings);
    assembly::State state = lifted(3, surroundings);
    const relaxation::RelaxResult result = relaxation::relax(state);
    EXPECT_TRUE(result.converged);
    EXPECT_EQ(result.end.unsupported, 0);
    EXPECT_LE(assembly::balance_of(state).mean, 1e-10);
    EXPECT_GT(result.part_steps, 0);
  }
}

}  // namespace
}  // namespace eigengrain::test
