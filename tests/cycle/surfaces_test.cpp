// Balls that roll, bounce and are carried on surfaces of triangles.
#include "support/surfaces.hpp"

#include "eigengrain/assembly/energies.hpp"
#include "eigengrain/cycle/policy.hpp"
#include "eigengrain/io/scene_reader.hpp"
#include "eigengrain/io/state_file.hpp"

#include "support/bits.hpp"
#include "support/motion.hpp"
#include "support/restart.hpp"
#include "unit/io_support.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>
#include <random>

namespace eigengrain::test {
namespace {

using assembly::State;
using cycle::Cycle;

/// A ball thrown along a floor with spin: it slides, then rolls obliquely over it.
SceneBuilder rolling(const Mat3& turn) {
  constexpr double g = 1e-3;
  SceneBuilder builder({.kn = 1, .ks = 0.5, .tension = false, .friction = 0.3});
  builder.ball(turn * Vec3(-1.23, -0.77, 1 - g))
      .moving(turn * Vec3(8e-3, 5e-3, 0), turn * Vec3(3e-3, -1e-3, 2e-3));
  return builder.gravity(turn * Vec3(0, 0, -g));
}

// The same motion as on a plane, to rounding: over triangles larger than the ball and much smaller, along an
// axis and askew, sliding and rolling, with its shear force.
TEST(Surface, ThatIsFlatRollsABallAsAPlaneDoes) {
  std::mt19937_64 random(2);
  for (const Mat3& turn : {Mat3(Mat3::Identity()), random_rotation(random)})
    for (const double cell : {1.1, 0.07}) {
      model::Surface mesh = flat(static_cast<int>(16 / cell), cell);
      transform(mesh, turn, Vec3::Zero());
      Cycle on_mesh = cycle_of(rolling(turn).surface(mesh), 0.3);
      Cycle on_plane = cycle_of(rolling(turn).plane(Vec3::Zero(), turn * Vec3::UnitZ()), 0.3);
      double apart = 0;
      double shear = 0;
      for (int k = 0; k < 2000; ++k) {
        on_mesh.step();
        on_plane.step();
        apart = std::max(apart, (position_of(on_mesh.state(), 0) - position_of(on_plane.state(), 0)).norm());
        apart = std::max(apart, (spin_of(on_mesh.state(), 0) - spin_of(on_plane.state(), 0)).norm());
        shear = std::max(shear, (on_mesh.state().force[0] - on_plane.state().force[0]).norm());
      }
      EXPECT_GT((position_of(on_plane.state(), 0) - turn * Vec3(-1.23, -0.77, 1)).norm(), 3);
      // An ulp of a place near 1 is a force of 2e-16; over 2000 steps it grows with the square of time at
      // most, and friction keeps it small: some 1e-12.
      EXPECT_LT(apart, 1e-11);
      EXPECT_LT(shear, 1e-12);
    }
}

/// Kinetic, elastic and gravitational energy.
double energy_of(const State& state) {
  const assembly::Energies e = assembly::energies_of(state);
  return e.kinetic_product + e.elastic + e.gravitational;
}

/// The greatest error of the energy of balls that bounce in a bowl with random heights of up to `rough`, over
/// the energy that they fall with.
double energy_error(double rough) {
  std::mt19937_64 random(5);
  std::uniform_real_distribution<double> uniform(0, 1);
  const model::Surface bowl =
      terrain(24, 0.6, [&](double x, double y) { return 0.2 * (x * x + y * y) + rough * uniform(random); });
  double worst = 0;
  for (int run = 0; run < 3; ++run) {
    constexpr double g = 1e-4;
    SceneBuilder builder({.kn = 1, .ks = 0, .tension = false});
    builder.ball({2 * uniform(random) - 1, 2 * uniform(random) - 1, 6}).gravity({0, 0, -g}).surface(bowl);
    Cycle cycle = cycle_of(builder, 0.02);
    const double start = energy_of(cycle.state());
    int bounces = 0;
    bool touches = false;
    for (int k = 0; k < 200000; ++k) {
      cycle.step();
      const bool now = !cycle.state().force[0].isZero(0);
      bounces += now && !touches ? 1 : 0;
      touches = now;
      if (!now) worst = std::max(worst, std::abs(energy_of(cycle.state()) - start) / (5 * g));
    }
    EXPECT_GT(bounces, 10);
  }
  std::printf("roughness %g: energy errs by %.1e\n", rough, worst);
  return worst;
}

// A force that is the slope of ½ k (r - distance)² cannot do work in a closed path; an edge that pushed twice
// or missed a step of the height would.
TEST(Surface, KeepsTheEnergyOfABouncingBall) {
  // An impact that begins within a step errs by ¼Δt² k/m = 1e-4 of its energy; some 15 of them.
  EXPECT_LT(energy_error(0.05), 2e-3);
}

// In hollows of three and more facets some of which are within 30° of each other and some not, it depends on
// which is nearest whether a second one counts: there the force has steps. They give as much as they take.
TEST(Surface, KeepsTheEnergyOfABouncingBallWithinBoundsWhereItIsRough) {
  EXPECT_LT(energy_error(0.25), 3e-2);
}

TEST(Surface, CarriesTheWeightOfARestingBall) {
  constexpr double g = 1e-3;
  SceneBuilder builder({.kn = 1, .ks = 0.5, .tension = false});
  // In the bottom of a bowl of four triangles.
  model::Surface bowl = terrain(2, 3, [](double x, double y) { return 0.2 * (std::abs(x) + std::abs(y)); });
  bowl.centre = {1, 0, 0};
  builder.ball({0.01, 0.02, 1.2}).gravity({0, 0, -g}).damped(0.7).surface(bowl);
  Cycle cycle = cycle_of(builder, 0.3);
  cycle.run(5000);
  const auto loads = assembly::wall_loads(cycle.state().model);
  ASSERT_EQ(loads.size(), 1U);
  // What the ball gets with the other sign; the rest of its swinging is 1e-5 of its weight by then.
  EXPECT_LT((loads[0].force + cycle.state().force[0]).norm(), 1e-15 * g);
  EXPECT_LT((loads[0].force - Vec3(0, 0, -g)).norm(), 1e-4 * g);
  EXPECT_NEAR(loads[0].moment.y(), -g * (1 - position_of(cycle.state(), 0).x()), 1e-4 * g);
}

// A ball that flies into a sheet so fast that its centre crosses comes back to the side it came from.
TEST(Surface, WithTwoSidesCatchesBallsFromBoth) {
  for (const double side : {1.0, -1.0}) {
    model::Surface sheet = flat(4, 1);
    sheet.two_sided = true;
    constexpr double v = 1.5;  // overlap v √(m/k) = 1.5 R
    SceneBuilder builder({.kn = 1, .ks = 0, .tension = false});
    builder.ball({0.1, 0.2, 1.3 * side}).moving({0, 0, -v * side}).surface(sheet);
    Cycle cycle = cycle_of(builder, 0.005);
    double deepest = 1;
    for (int k = 0; k < 1200; ++k) {
      cycle.step();
      deepest = std::min(deepest, side * position_of(cycle.state(), 0).z());
    }
    EXPECT_NEAR(deepest, -0.5, 1e-3);
    EXPECT_NEAR(side * velocity_of(cycle.state(), 0).z(), v, 1e-4 * v);
  }
}

// A mesh that moves is a plane that moves: where it drags, lifts and turns a ball.
TEST(Surface, ThatMovesCarriesABallAsAPlaneDoes) {
  const Vec3 velocity(4e-3, -2e-3, 1e-3);
  const Vec3 spin(1e-4, 2e-4, 1e-3);
  const auto scene = [] { return rolling(Mat3::Identity()).moving({0, 0, 0}); };
  Cycle on_mesh = cycle_of(scene().surface(flat(30, 0.7)).surface_carried(velocity, spin), 0.3);
  Cycle on_plane = cycle_of(scene().plane(Vec3::Zero(), Vec3::UnitZ()).carried(velocity, spin), 0.3);
  double apart = 0;
  for (int k = 0; k < 1500; ++k) {
    on_mesh.step();
    on_plane.step();
    apart = std::max(apart, (position_of(on_mesh.state(), 0) - position_of(on_plane.state(), 0)).norm());
  }
  EXPECT_GT(position_of(on_plane.state(), 0).x(), -1);
  EXPECT_GT(on_mesh.state().list.rebuilds, 5);
  EXPECT_LT(apart, 1e-11);
}

/// Balls in a drum that turns, with a plate through it.
std::string drum_scene() {
  std::string balls;
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j)
      for (int k = 0; k < 3; ++k)
        balls +=
            fmt::format("  - {{position: [{}, {}, {}], radius: {}, material: grain}}\n", -0.012 + 0.0105 * i,
                        -0.0105 + 0.0105 * j, -0.015 + 0.0105 * k, 0.005 + 0.0001 * ((i + j * k) % 3));
  return R"(
gravity: [0, 0, -9.81]
materials: [{name: grain, density: 2500}]
contacts: [{between: [any, any], law: linear, kn: 1e5, ks: 5e4, friction: 0.4}]
balls:
)" + balls +
         R"(walls:
  - {plane: {point: [0, -0.02, 0], normal: [0, 1, 0]}, material: grain}
  - {plane: {point: [0, 0.02, 0], normal: [0, -1, 0]}, material: grain}
  - {mesh: {file: drum.stl, unit: mm}, material: grain, spin: [0, 10, 0], centre: [0, 0, 0]}
  - polygon: {corners: [[-0.02, -0.02, 0.02], [0.02, -0.02, 0.02], [0.02, 0.02, 0.02], [-0.02, 0.02, 0.02]], two_sided: true}
    material: grain
    velocity: [0, 0, -0.05]
timestep: {policy: fixed, dt: 20 us}
)";
}

std::string stl_of(const model::Surface& surface) {
  std::string text = "solid drum\n";
  for (const model::Triangle& t : surface.triangles) {
    text += "facet normal 0 0 0\nouter loop\n";
    for (const std::int32_t v : t) {
      const Vec3& x = surface.vertices[static_cast<std::size_t>(v)];
      text += fmt::format("vertex {} {} {}\n", x[0], x[1], x[2]);
    }
    text += "endloop\nendfacet\n";
  }
  return text + "endsolid drum\n";
}

TEST(Surface, GivesTheSameBitsOnAnyNumberOfThreadsAndAfterARestart) {
  const io::TemporaryFolder folder;
  folder.write("drum.stl", stl_of(tube(24, 30, 50)));
  const model::Scene scene = io::read_scene_text(drum_scene(), folder.path(), "drum.yaml");
  ASSERT_EQ(scene.surfaces.size(), 2U);
  constexpr int steps = 8000;
  const auto run = [&](int count) {
    const Threads threads(count);
    Cycle cycle(cycle::start(scene), cycle::policy_of(scene));
    cycle.run(steps);
    return cycle.release();
  };
  const State one = run(1);
  EXPECT_GT(one.list.rebuilds, 10);
  std::size_t sheared = 0;
  for_each_shear(one.model, [&](const contact::Pair& pair, const auto& state) {
    sheared += pair.is_contact() && !state.shear.isZero(0) ? 1 : 0;
  });
  EXPECT_GT(sheared, 1U);
  EXPECT_EQ(bits_of(one), bits_of(run(2)));
  EXPECT_EQ(bits_of(one), bits_of(run(4)));
  expect_to_continue(scene, steps, {0, 1, 3456});
  // With another mesh the numbers of its triangles would mean others.
  const auto file = folder.path() / "drum.h5";
  io::write_state(one, file);
  folder.write("drum.stl", stl_of(tube(25, 30, 50)));
  try {
    io::read_state(file);
    ADD_FAILURE() << "not refused";
  } catch (const InputError& error) {
    EXPECT_NE(std::string(error.what()).find("other triangles than when the state was written"),
              std::string::npos)
        << error.what();
  }
}

}  // namespace
}  // namespace eigengrain::test
