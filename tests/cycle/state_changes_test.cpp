// What stages do to a state between two moments, against closed forms.
#include "eigengrain/assembly/add_balls.hpp"
#include "eigengrain/assembly/change_bodies.hpp"
#include "eigengrain/assembly/choose_contacts.hpp"
#include "eigengrain/assembly/contact_list.hpp"
#include "eigengrain/assembly/selection.hpp"
#include "eigengrain/base/error.hpp"

#include "support/clumps.hpp"
#include "support/motion.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <map>
#include <numbers>

namespace eigengrain::test {
namespace {

using assembly::State;
using cycle::Cycle;
using model::BodyChange;
using testing::ElementsAre;

constexpr double g = 9.81;

model::Selection ball(std::int64_t identity) {
  return {.region = {}, .material = {}, .balls = std::vector{identity}, .group = {}};
}

SceneBuilder falling_balls() {
  SceneBuilder builder;
  builder.ball({0, 0, 10}).ball({5, 0, 10}).ball({10, 0, 20});
  builder.scene().gravity = {0, 0, -g};
  return builder;
}

/// The state after some steps, with a change, and the cycle that goes on from there.
Cycle changed(Cycle cycle, const BodyChange& change, double dt) {
  State state = cycle.release();
  assembly::change_bodies(state, change, "test");
  return Cycle(std::move(state), fixed_step(dt));
}

// Leapfrog is exact under a constant force, if a velocity of time t becomes one of t - Δt/2 by half a step of
// the force; taken as it is, it would err by ½ g Δt = 5e-2 in the velocity.
TEST(StateChanges, AVelocityIsThatOfTheMoment) {
  constexpr double dt = 0.01;
  Cycle cycle = cycle_of(falling_balls(), dt);
  cycle.run(7);
  const Vec3 start = position_of(cycle.state(), 0);
  const Vec3 v0{1, 2, 3};
  cycle = changed(std::move(cycle), {.of = ball(0), .velocity = v0}, dt);
  for (int n = 1; n <= 100; ++n) {
    cycle.step();
    const double t = n * dt;
    const Vec3 exact = start + t * v0 - 0.5 * t * t * g * Vec3(0, 0, 1);
    EXPECT_LT((position_of(cycle.state(), 0) - exact).norm(), 1e-12 * n) << n;  // some ulps of 10 a step
  }
  // The others have not been touched: x = 10 - ½ g t².
  const double t = 107 * dt;
  EXPECT_NEAR(position_of(cycle.state(), 1).z(), 10 - 0.5 * g * t * t, 1e-11);
}

TEST(StateChanges, FixesAndFreesComponents) {
  constexpr double dt = 0.01;
  Cycle cycle = cycle_of(falling_balls(), dt);
  model::FixedComponents z;
  z.fix(2);
  cycle = changed(std::move(cycle), {.of = ball(1), .fix = z, .velocity = Vec3(0, 0, 2)}, dt);
  cycle.run(50);
  EXPECT_NEAR(position_of(cycle.state(), 1).z(), 10 + 2 * 50 * dt, 1e-12);
  EXPECT_NEAR(position_of(cycle.state(), 0).z(), 10 - 0.5 * g * 0.25, 1e-12);
  cycle = changed(std::move(cycle), {.of = ball(1), .free = z}, dt);
  const double z0 = position_of(cycle.state(), 1).z();
  cycle.run(50);
  // Freed, its velocity of 2 m/s is that of half a step before.
  EXPECT_NEAR(position_of(cycle.state(), 1).z(),
              z0 + (2 + 0.5 * g * dt) * 0.5 - 0.5 * g * 0.25 - g * dt * 0.5, 1e-12);
}

// A ball between two planes: a radius of R + ε makes an overlap of ε at both.
TEST(StateChanges, ALargerRadiusPressesOnBothWallsAtOnce) {
  constexpr double k = 3;
  constexpr double part = 1e-3;
  SceneBuilder builder({.kn = k, .tension = false});
  builder.ball({0, 0, 1}, 1, 2).plane({0, 0, 0}, {0, 0, 1}).plane({0, 0, 2}, {0, 0, -1});
  State state = cycle::start(builder.scene());
  assembly::change_bodies(state, {.of = {}, .growth = 1 + part}, "test");
  const std::vector<Vec3> forces = assembly::wall_forces(state.model);
  ASSERT_EQ(forces.size(), 2U);
  EXPECT_NEAR(forces[0].z(), -k * part, 1e-14);
  EXPECT_NEAR(forces[1].z(), k * part, 1e-14);
  const double factor = 1 + part;
  EXPECT_NEAR(state.model.bodies.mass[0], 2 * std::pow(factor, 3), 1e-14);
  EXPECT_NEAR(state.model.bodies.inertia[0], 0.8 * std::pow(factor, 5), 1e-14);
  EXPECT_EQ(state.next_dt, 0);  // the step is chosen anew
}

TEST(StateChanges, ADiskKeepsTheMassOfADisk) {
  model::Bodies bodies;
  bodies.radius = {2};
  bodies.mass = {model::disk_mass(2, 5)};
  bodies.inertia = {model::disk_inertia(2, bodies.mass[0])};
  bodies.position = {Vec3::Zero()};
  model::scale_radii(bodies, std::vector<std::int32_t>{0}, 1.5);
  EXPECT_NEAR(bodies.mass[0], model::disk_mass(3, 5), 1e-12);
  EXPECT_NEAR(bodies.inertia[0], model::disk_inertia(3, model::disk_mass(3, 5)), 1e-12);
}

TEST(StateChanges, ARadiusMayTakeItsTime) {
  constexpr double k = 3;
  SceneBuilder builder({.kn = k, .tension = false});
  builder.ball({0, 0, 1}, 1, 2).plane({0, 0, 0}, {0, 0, 1}).plane({0, 0, 2}, {0, 0, -1});
  Cycle cycle = cycle_of(std::move(builder), 0.01);
  cycle.run(10);
  cycle = changed(std::move(cycle), {.of = {}, .growth = 1.002, .over = 1.0}, 0.01);
  cycle.run(50);
  EXPECT_NEAR(cycle.state().model.bodies.radius[0], 1.001, 1e-15);
  cycle.run(100);
  EXPECT_NEAR(cycle.state().model.bodies.radius[0], 1.002, 1e-15);
  EXPECT_NEAR(assembly::wall_forces(cycle.state().model)[0].z(), -k * 2e-3, 1e-14);
}

// Loads and a damping from now on: v = F t/m, and with local damping α, (1 - α) F t/m.
TEST(StateChanges, LoadsAndDampingFromNowOn) {
  constexpr double dt = 0.01;
  SceneBuilder builder;
  builder.ball({0, 0, 0}, 1, 2).ball({5, 0, 0}, 1, 2);
  Cycle cycle = cycle_of(std::move(builder), dt);
  cycle.run(5);
  State state = cycle.release();
  assembly::change_bodies(state, {.of = {}, .force = Vec3(3, 0, 0), .moment = Vec3(0, 0, 0.5)}, "test");
  assembly::change_bodies(state, {.of = ball(1), .damping = 0.4}, "test");
  cycle = Cycle(std::move(state), fixed_step(dt));
  cycle.run(100);
  // The velocity of t - Δt/2: 100 kicks from rest.
  EXPECT_NEAR(velocity_of(cycle.state(), 0).x(), 3.0 / 2 * 100 * dt, 1e-13);
  EXPECT_NEAR(velocity_of(cycle.state(), 1).x(), 0.6 * 3.0 / 2 * 100 * dt,
              2e-2);  // the first kick is undamped
  EXPECT_NEAR(spin_of(cycle.state(), 0).z(), 0.5 / model::sphere_inertia(1, 2) * 100 * dt, 1e-13);
}

TEST(StateChanges, AClumpChangesAsAWhole) {
  SceneBuilder builder;
  builder.ball({20, 0, 0}).clump(dumbbell(), {.position = {0, 0, 0}});
  State state = cycle::start(builder.scene());
  const Vec3 spin{0, 0.5, 0};
  assembly::change_bodies(state, {.of = ball(2), .velocity = Vec3(1, 0, 0), .spin = spin}, "test");
  const model::Clumps& clumps = state.model.bodies.clumps;
  EXPECT_EQ(clumps.velocity[0], Vec3(1, 0, 0));
  EXPECT_EQ(clumps.spin[0], spin);
  EXPECT_LT((clumps.angular_momentum[0] - model::angular_momentum(clumps, 0, spin)).norm(), 1e-15);
  for (const std::int32_t row : clumps.members(0)) {
    const auto i = static_cast<std::size_t>(row);
    EXPECT_LT((state.model.bodies.velocity[i] -
               (Vec3(1, 0, 0) + spin.cross(state.model.bodies.position[i] - clumps.position[0])))
                  .norm(),
              1e-15);
  }
  EXPECT_EQ(velocity_of(state, 0), Vec3(Vec3::Zero()));
  EXPECT_THROW(assembly::change_bodies(state, {.of = ball(1), .growth = 2}, "test"), InputError);
}

// As AVelocityIsThatOfTheMoment, of a clump and of a ball that comes in.
TEST(StateChanges, SoIsThatOfClumpsAndOfBallsThatComeIn) {
  constexpr double dt = 0.01;
  SceneBuilder builder;
  builder.ball({20, 0, 0}).clump(dumbbell(), {.position = {0, 0, 5}});
  builder.scene().gravity = {0, 0, -g};
  Cycle cycle = cycle_of(std::move(builder), dt);
  cycle.run(7);
  State state = cycle.release();
  const double z = state.model.bodies.clumps.position[0].z();
  assembly::change_bodies(state, {.of = ball(1), .velocity = Vec3(0, 0, 1)}, "test");
  SceneBuilder more;
  more.ball({-20, 0, 3}).moving({0, 0, 1}, {0, 2, 0});
  assembly::add_balls(state, more.scene().bodies);
  cycle = Cycle(std::move(state), fixed_step(dt));
  cycle.run(50);
  const double way = 0.5 - 0.5 * g * 0.25;
  EXPECT_NEAR(cycle.state().model.bodies.clumps.position[0].z(), z + way, 1e-12);
  EXPECT_NEAR(position_of(cycle.state(), 3).z(), 3 + way, 1e-12);
  EXPECT_EQ(spin_of(cycle.state(), 3), Vec3(0, 2, 0));
}

TEST(StateChanges, SelectionsMeanTheBallsForWhichAllHolds) {
  State state = cycle::start(falling_balls().scene());
  const model::BoxRegion upper{.min = {-100, -100, 15}, .max = {100, 100, 25}};
  model::Selection selection;
  selection.region = model::Region{"upper", upper};
  const auto identities = [&](const model::Selection& of) {
    std::vector<std::int64_t> result;
    for (const std::int32_t row : assembly::selected(state.model.bodies, state.groups, of, "test"))
      result.push_back(state.model.bodies.identity[static_cast<std::size_t>(row)]);
    std::sort(result.begin(), result.end());
    return result;
  };
  EXPECT_THAT(identities({}), ElementsAre(0, 1, 2));
  EXPECT_THAT(identities(selection), ElementsAre(2));
  EXPECT_THAT(identities({.region = {}, .material = 1, .balls = {}, .group = {}}), ElementsAre());
  const std::vector<model::GroupChoice> choices{{"lid", selection}};
  assembly::make_groups(state.model.bodies, choices, state.groups);
  for (Vec3& x : state.model.bodies.position) x.z() -= 10;  // the group goes where its balls go
  model::Selection of_group;
  of_group.group = "lid";
  EXPECT_THAT(identities(of_group), ElementsAre(2));
  of_group.balls = std::vector<std::int64_t>{0, 1};
  EXPECT_THAT(identities(of_group), ElementsAre());
  of_group.group = "led";
  EXPECT_THROW(identities(of_group), InputError);
  EXPECT_THROW(identities(ball(3)), InputError);
  EXPECT_THROW(assembly::make_groups(state.model.bodies, choices, state.groups),
               InputError);  // nobody is there now
}

TEST(StateChanges, BallsComeInWhereThereIsRoom) {
  SceneBuilder builder({.kn = 10, .tension = false});
  builder.ball({0, 0, 1}).plane({0, 0, 0}, {0, 0, 1});
  builder.scene().gravity = {0, 0, -g};
  State state = cycle::start(builder.scene());
  SceneBuilder more;
  more.ball({0, 0, 2.5}).ball({4, 0, 0.5}).ball({4, 0, 3}).ball({4, 0, 5.5}).moving({0, 0, -1});
  const assembly::Added added = assembly::add_balls(state, more.scene().bodies);
  // The first overlaps the ball that is there, the second the floor; those that come may touch each other.
  EXPECT_EQ(added.balls, 2);
  EXPECT_EQ(added.left_out, 2);
  ASSERT_EQ(state.model.bodies.size(), 3);
  EXPECT_EQ(position_of(state, 1), Vec3(4, 0, 3));
  EXPECT_EQ(velocity_of(state, 2), Vec3(0, 0, -1));
  Cycle cycle(std::move(state), fixed_step(1e-3));
  cycle.run(100);
  EXPECT_NEAR(position_of(cycle.state(), 1).z(), 3 - 0.5 * g * 0.01, 1e-12);
  EXPECT_NEAR(position_of(cycle.state(), 2).z(), 5.5 - 0.1 - 0.5 * g * 0.01, 1e-12);
  EXPECT_EQ(cycle.state().force.size(), 3U);
}

// Balls that were made for a cell which is smaller now may have come to overlap through its faces.
TEST(StateChanges, BallsComeInWithoutOverlapsWhereTheCellHasMoved) {
  SceneBuilder builder({.kn = 10, .tension = false});
  builder.ball({5, 5, 5});
  builder.scene().cell = model::PeriodicCell::box(Vec3::Zero(), Vec3::Constant(20), {true, true, true});
  State state = cycle::start(builder.scene());
  SceneBuilder more;
  more.ball({1, 1, 1}).ball({15.5, 1, 1});  // 5.5 apart through the face, or 0.5 in a cell of 15
  State before = state;
  EXPECT_EQ(assembly::add_balls(before, more.scene().bodies).balls, 2);
  state.model.cell.edges = Vec3::Constant(15).asDiagonal();
  EXPECT_EQ(assembly::add_balls(state, more.scene().bodies).balls, 1);
}

/// Two balls on a floor, beside each other, with an entry `soft` for contacts that are chosen.
SceneBuilder balls_on_floor() {
  SceneBuilder builder({.kn = 10, .ks = 5, .tension = false});
  builder.ball({0, 0, 0.99}).ball({5, 0, 0.99}).plane({0, 0, 0}, {0, 0, 1});
  model::ContactRule soft = builder.scene().contacts[0];
  soft.name = "soft";
  soft.parameters = {4, 2, 0.5};
  builder.scene().contacts.push_back(soft);
  return builder;
}

/// The rules of the contacts of a state, by the identity of their first ball.
std::map<std::int64_t, std::int32_t> rules_of(const State& state) {
  std::map<std::int64_t, std::int32_t> rules;
  state.model.contacts.for_each_group([&](const auto& group) {
    for (const contact::Pair& pair : group.pairs)
      rules[state.model.bodies.identity[static_cast<std::size_t>(pair.a)]] = group.rule;
  });
  return rules;
}

TEST(StateChanges, ChosenContactsTakeAnotherLawWhileTheyAct) {
  constexpr double dt = 0.05;
  SceneBuilder builder = balls_on_floor();
  builder.moving({0.01, 0, 0});  // ball 1 shears its contact
  Cycle cycle = cycle_of(std::move(builder), dt);
  cycle.run(3);
  State state = cycle.release();
  const std::vector<Vec3> before = shears_of(state);
  EXPECT_EQ(assembly::choose_contacts(state, {.take = "soft", .of = ball(1), .wall = {}}, "test"), 1);
  EXPECT_EQ(rules_of(state), (std::map<std::int64_t, std::int32_t>{{0, 0}, {1, 1}}));
  const std::vector<Vec3> after = shears_of(state);  // ball 0, then the group of the other entry
  ASSERT_EQ(after.size(), 2U);
  EXPECT_EQ(after, before);
  EXPECT_GT(after[1].norm(), 1e-4);
  // The secant normal force is that of the new stiffness at once.
  const double depth = 1 - position_of(state, 1).z();
  EXPECT_NEAR(state.force[row_of(state, 1)].z(), 4 * depth, 1e-14);
  // It stays through new lists, and goes back once it has opened.
  assembly::renew_list(state, state.list.skin);
  EXPECT_EQ(rules_of(state).at(1), 1);
  state.model.bodies.position[row_of(state, 1)].z() = 1.01;  // within the skin
  assembly::renew_list(state, state.list.skin);
  EXPECT_EQ(rules_of(state).at(1), 0);
  EXPECT_THROW(assembly::choose_contacts(state, {.take = "soft", .of = ball(1), .wall = {}}, "test"),
               InputError);
  EXPECT_THROW(assembly::choose_contacts(state, {.take = "hard", .of = {}, .wall = {}}, "test"), InputError);
  EXPECT_THROW(assembly::choose_contacts(state, {.take = "soft", .of = {}, .wall = "none"}, "test"),
               InputError);
}

// Dashpots for the contacts that exist (theory §4): the chosen one loses energy as a damped oscillator does,
// e^{-2 β ω t} of it in the mean, the other loses none.
TEST(StateChanges, DashpotsForContactsThatExist) {
  constexpr double beta = 0.05;
  constexpr double k = 10;
  SceneBuilder builder({.kn = k, .tension = false});
  // Pressed far enough into the floor by their weight for neither to lift off.
  builder.ball({0, 0, 0.9}).ball({5, 0, 0.9}).plane({0, 0, 0}, {0, 0, 1});
  builder.scene().gravity = {0, 0, -0.1 * k};
  model::ContactRule damped = builder.scene().contacts[0];
  damped.name = "damped";
  damped.parameters = {k, 0, 0, 0, 0, 0, 0, beta};
  builder.scene().contacts.push_back(damped);
  const double omega = std::sqrt(k);
  const double dt = 1e-3 / omega;
  State state = cycle::start(builder.scene());
  assembly::change_bodies(state, {.of = {}, .velocity = Vec3(0, 0, 0.05 * omega)}, "test");
  assembly::choose_contacts(state, {.take = "damped", .of = ball(1), .wall = {}}, "test");
  Cycle cycle(std::move(state), fixed_step(dt));
  const double omega_damped = omega * std::sqrt(1 - beta * beta);
  const int steps = static_cast<int>(2 * std::numbers::pi / omega_damped / dt * 3);  // three periods
  cycle.run(steps);
  const double t = steps * dt;
  // x = x₀ + (v₀/ω_d) e^{-βωt} sin ω_d t.
  const double exact =
      0.9 + 0.05 * omega / omega_damped * std::exp(-beta * omega * t) * std::sin(omega_damped * t);
  const double free = 0.9 + 0.05 * std::sin(omega * t);
  // The lagged velocity of the dashpot makes it first order: ½Δt of phase, 5e-4 of 0.05·β.
  EXPECT_NEAR(position_of(cycle.state(), 1).z(), exact, 0.05 * 2e-4);
  EXPECT_NEAR(position_of(cycle.state(), 0).z(), free, 0.05 * 1e-5);
}

}  // namespace
}  // namespace eigengrain::test
