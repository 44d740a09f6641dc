// The work of walls that move, in the energy ledger.
#include "eigengrain/cycle/policy.hpp"
#include "eigengrain/io/scene_reader.hpp"
#include "eigengrain/io/state_file.hpp"

#include "support/ledger.hpp"
#include "support/motion.hpp"
#include "support/surfaces.hpp"
#include "unit/io_support.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>
#include <string>

namespace eigengrain::test {
namespace {

using assembly::State;
using cycle::Cycle;
using measures::Ledger;
using measures::ledger_of;

// Ball on ball under a lid that sinks by d: two springs of k = 1 in series hold ½(k/2)d². Linear, so the
// balance is exact; the lid is started slowly, and what swings is (v/ω)² of d².
TEST(LedgerWalls, AWallThatCompressesTwoBallsPutsInWhatTheyStore) {
  constexpr double speed = 1e-5;
  constexpr double way = 0.01;
  SceneBuilder builder({.kn = 1, .ks = 0, .tension = false});
  builder.ball({0, 0, 0}, 1, 1, fix_all).ball({0, 0, 2 - 1e-12}).plane({0, 0, 3 - 2e-12}, {0, 0, -1});
  builder.carried({0, 0, 0});
  builder.scene().wall_motions[0].time = {0, 100, 1000, 1100};
  builder.scene().wall_motions[0].velocity = {
      {}, {.translation = {0, 0, -speed}}, {.translation = {0, 0, -speed}}, {}};
  Cycle cycle = cycle_with_ledger(builder, 0.5);
  cycle.run(2300);
  const Ledger ledger = ledger_of(cycle.state());
  std::printf("compressed: work %.9e, elastic %.9e, kinetic %.1e, error %.1e\n", ledger.integrals.walls,
              ledger.elastic.normal, ledger.kinetic, ledger.balance_error);
  EXPECT_NEAR(ledger.elastic.normal, 0.25 * way * way, 1e-4 * way * way);
  EXPECT_NEAR(ledger.integrals.walls, ledger.elastic.normal + ledger.kinetic, 1e-15);
  EXPECT_LT(std::abs(ledger.balance_error), 1e-15);
}

/// A ball at rest on a floor that moves under it with V until it rolls: V/7 of V² it has then, and V/7 was
/// lost by slip; the floor has given both.
Ledger dragged(SceneBuilder builder, double dt) {
  Cycle cycle = cycle_with_ledger(std::move(builder), dt);
  cycle.run(std::lround(600 / dt));
  return ledger_of(cycle.state());
}

TEST(LedgerWalls, AFloorThatDragsABallGivesItsEnergyAndTheSlip) {
  constexpr double g = 1e-3;
  constexpr double V = 0.1;
  const auto ball = [] {
    SceneBuilder builder({.kn = 1, .ks = 0.5, .tension = false, .friction = 0.5});
    builder.ball({0.1, 0.2, 1 - g}).gravity({0, 0, -g});
    return builder;
  };
  for (const double dt : {0.4, 0.1}) {
    SceneBuilder on_plane = ball();
    on_plane.plane({0, 0, 0}, {0, 0, 1}).carried({V, 0, 0});
    SceneBuilder on_mesh = ball();
    on_mesh.surface(flat(160, 0.9)).surface_carried({V, 0, 0});
    for (const SceneBuilder& builder : {on_plane, on_mesh}) {
      const Ledger ledger = dragged(builder, dt);
      std::printf("dragged, step %.1f: work %.5f, slip %.5f, kinetic %.5f V², error %.1e\n", dt,
                  ledger.integrals.walls / (V * V), ledger.integrals.contacts.slip / (V * V),
                  ledger.kinetic / (V * V), ledger.balance_error / (V * V));
      // The lever is R - ½U. The shear spring goes on swinging with the force μmg, which makes a velocity of
      // μmg/√(2/7 k_s) = 1.3e-3 beside 2/7 V: 4e-3 of V² pass to and fro.
      EXPECT_NEAR(ledger.integrals.walls / (V * V), 2.0 / 7, 5e-3);
      EXPECT_NEAR(ledger.integrals.contacts.slip / (V * V), 1.0 / 7, 1e-3);
      EXPECT_NEAR(ledger.kinetic / (V * V), 1.0 / 7, 5e-3);
      EXPECT_LT(std::abs(ledger.balance_error), 2e-5 * V * V);
    }
  }
}

// A ball that is held on a turntable with F_n = 0.01 slips under μF_n at a distance of 3: its work is the
// moment times the angle, μ F_n r ω t, all of which is lost, once the shear spring is at the cone.
TEST(LedgerWalls, ATurntableUnderABallThatIsHeldWorksByItsMoment) {
  constexpr double turn = 0.01;
  double last = 0;
  for (const double dt : {0.4, 0.2, 0.1}) {
    SceneBuilder builder({.kn = 1, .ks = 0.5, .tension = false, .friction = 0.5});
    builder.ball({5, 1, 0.99}, 1, 1, fix_all).plane({2, 1, 0}, {0, 0, 1});
    builder.carried({0, 0, 0}, {0, 0, turn}, {2, 1, 0});
    Cycle cycle = cycle_with_ledger(builder, dt);
    cycle.run(std::lround(200 / dt));
    const Ledger ledger = ledger_of(cycle.state());
    const double expected = 0.5 * 0.01 * 3 * turn * 200;
    const double spring = 0.5 * 2.5e-5 / 0.5;
    std::printf("turntable, step %.1f: work %.6f, slip %.6f of the closed form, error %.1e\n", dt,
                ledger.integrals.walls / expected, ledger.integrals.contacts.slip / expected,
                ledger.balance_error / expected);
    // Until the spring is at the cone the force is less, over a way of 0.01 of 6.
    EXPECT_NEAR(ledger.integrals.walls, expected - spring, 1e-3 * expected);
    EXPECT_NEAR(ledger.integrals.contacts.slip, ledger.integrals.walls - spring, 1e-3 * expected);
    const double error = std::abs(ledger.balance_error) / expected;
    EXPECT_LT(error, 1e-4 * dt * dt);
    last = error;
  }
  EXPECT_LT(last, 1e-6);
}

// From F = 0.2 to 0.204 on a spring of k = 2.
TEST(LedgerWalls, AServoPutsInWhatItsSpringStores) {
  SceneBuilder builder({.kn = 2, .ks = 0, .tension = false});
  builder.ball({0, 0, 0}, 1, 1, fix_all).plane({0, 0, 0.9}, {0, 0, -1}).carried(Vec3::Zero());
  builder.scene().wall_motions[0].servo = model::Servo{{0, 0, -1}, 0.204, 0.25, 0.01};
  Cycle cycle = cycle_with_ledger(builder, 0.5);
  cycle.run(200);
  const Ledger ledger = ledger_of(cycle.state());
  EXPECT_NEAR(ledger.integrals.walls, (0.204 * 0.204 - 0.04) / 4, 1e-15);
  EXPECT_LT(std::abs(ledger.balance_error), 1e-15);
}

const std::string scene_with_all =
    "gravity: [0, 0, -9.81]\n"
    "materials: [{name: glass, density: 2500}, {name: steel}, {name: clay, density: 2000}]\n"
    "contacts:\n"
    "  - {between: [glass, glass], law: linear, kn: 2e4, ks: 1e4, friction: 0.5, restitution: 0.7, beta_s: "
    "0.1,\n"
    "     kr: 0.01, rolling_friction: 0.1, bond: {kind: parallel, kn: 1e9, ks: 5e8, tension: 10 kPa, gap: "
    "0.1 mm}}\n"
    "  - {between: [glass, steel], law: hertz, effective_young: 1e7, effective_shear: 2e6, friction: 0.4,\n"
    "     beta_n: 0.1}\n"
    "  - {between: [clay, any], law: hysteretic, kn: 2e4, ks: 1e4, restitution: 0.5, friction: 0.3}\n"
    "balls:\n"
    "  - {position: [0, 0, 5 mm], radius: 5 mm, material: glass, velocity: [0.2, 0, 0]}\n"
    "  - {position: [0, 1 mm, 14.95 mm], radius: 5 mm, material: glass}\n"
    "  - {position: [0, 1 mm, 25 mm], radius: 5 mm, material: glass, velocity: [0, 0, -0.3]}\n"
    "  - {position: [9.9 mm, 1 mm, 9 mm], radius: 5 mm, material: clay, velocity: [-0.2, 0, 0],\n"
    "     damping: 0.1, growth: {factor: 1.01, over: 3 ms}}\n"
    "  - {position: [40 mm, 0, 5 mm], radius: 5 mm, material: glass, velocity: [0.005, 0, 0],\n"
    "     force: [1 mN, 0, 0], moment: [0, 1e-7, 0]}\n"
    "  - {position: [50 mm, 0, 5 mm], radius: 5 mm, material: glass, fix: [z], velocity: [0, 0, -0.001]}\n"
    "walls:\n"
    "  - {plane: {point: [0, 0, 0], normal: [0, 0, 1]}, material: steel, velocity: [0.1, 0, 0]}\n"
    "  - {plane: {point: [0, 0, 30.1 mm], normal: [0, 0, -1]}, material: steel,\n"
    "     servo: {force: 1 N, max_speed: 0.2 m/s}}\n";

TEST(LedgerWalls, AndAllElseGoOnToTheBitAfterARestart) {
  const io::TemporaryFolder folder;
  const auto file = folder.path() / "state.h5";
  Cycle whole(with_ledger(cycle::start(io::read_scene_text(scene_with_all, "."))), fixed_step(1e-5));
  whole.run(150);
  io::write_state(whole.state(), file);
  whole.run(300);
  State read = io::read_state(file);
  ASSERT_TRUE(read.ledger.has_value());
  Cycle rest(std::move(read), fixed_step(1e-5));
  rest.run(300);
  const Ledger ledger = ledger_of(whole.state());
  for (const measures::LedgerEntry& entry : measures::entries_of(ledger)) {
    EXPECT_NE(entry.value, 0) << entry.name;
    std::printf("%s %.3e\n", entry.name.c_str(), entry.value);
  }
  EXPECT_TRUE(same_bits(ledger, ledger_of(rest.state())));
}

}  // namespace
}  // namespace eigengrain::test
