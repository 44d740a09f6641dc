// Every kind of scene from every kind of start comes to rest: at 1e-10 of the mean contact force, or three
// times what the rounding of places makes of it, with nothing unsupported; the explicit cycle stays there,
// and what walls bear is what bodies weigh. With EIGENGRAIN_LONG_TESTS=1 at 3,000 and 10,000 bodies instead
// of 300 (tests/bench/relax_matrix.sh).
#include "eigengrain/assembly/acting.hpp"
#include "eigengrain/assembly/contact_list.hpp"
#include "eigengrain/assembly/forces.hpp"
#include "eigengrain/assembly/loads.hpp"
#include "eigengrain/cycle/cycle.hpp"
#include "eigengrain/cycle/policy.hpp"
#include "eigengrain/io/scene_reader.hpp"
#include "eigengrain/relaxation/relax.hpp"

#include "support/scenes.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <numbers>
#include <string>
#include <vector>

namespace eigengrain::test {
namespace {

constexpr double radius = 4.5e-3;

std::vector<int> sizes() {
  if (std::getenv("EIGENGRAIN_LONG_TESTS") != nullptr) return {3000, 10000};
  return {300};
}

/// A kind of scene: contacts, what stands around, and whether bodies are clumps.
struct Kind {
  std::string name;
  std::string contacts;
  bool clumps = false;
  bool periodic = false;
  bool servo = false;
  double friction = 0.5;
};
const std::vector<Kind>& kinds() {
  static const std::vector<Kind> all{
      {.name = "frictionless", .contacts = "law: linear, kn: 1.0e5", .friction = 0},
      {.name = "frictional", .contacts = "law: linear, kn: 1.0e5, ks: 5.0e4, friction: 0.5"},
      {.name = "bonded",
       .contacts =
           "law: linear, kn: 1.0e5, ks: 5.0e4, friction: 0.5, bond: {kind: parallel, kn: 2.0e9, ks: 1.0e9, "
           "gap: 0.1 mm}"},
      {.name = "clumps", .contacts = "law: linear, kn: 1.0e5, ks: 5.0e4, friction: 0.5", .clumps = true},
      {.name = "hertz",
       .contacts = "law: hertz, effective_young: 5.0e7, effective_shear: 2.0e7, friction: 0.5"},
      {.name = "periodic", .contacts = "law: linear, kn: 1.0e5, ks: 5.0e4, friction: 0.5", .periodic = true},
      {.name = "servo", .contacts = "law: linear, kn: 1.0e5, ks: 5.0e4, friction: 0.5", .servo = true}};
  return all;
}

std::string balls_of(double fraction, double edge, double height) {
  return fmt::format(
      "balls: [{{fill: {}, fraction: {}, radius: {}, seed: 3, material: grain, box: {{min: [0, 0, 0], max: "
      "[{}, {}, {}]}}}}]\n",
      fraction < 0.4 ? "random" : "dense", fraction, radius, edge, edge, height);
}

/// Dumbbells and bent triples, turned at random, on a grid on which none touch.
std::string clumps_of(int count, double edge) {
  const double pitch = 4.2 * radius;
  const int across = std::max(1, static_cast<int>(edge / pitch));
  std::mt19937_64 random(5);
  std::string instances[2];
  for (int k = 0; k < count; ++k) {
    const Vec3 axis = random_vector(random).normalized();
    const double step = edge / across;
    instances[k % 2] += fmt::format("      - {{position: [{}, {}, {}], axis: [{}, {}, {}], angle: {}}}\n",
                                    step * (k % across + 0.5), step * (k / across % across + 0.5),
                                    pitch * (k / across / across + 0.6), axis.x(), axis.y(), axis.z(),
                                    std::uniform_real_distribution<double>(0, 6)(random));
  }
  return fmt::format(
      "clumps:\n"
      "  - balls: [{{at: [0, 0, 0], radius: {0}}}, {{at: [{0}, 0, 0], radius: {0}}}]\n"
      "    material: grain\n    instances:\n{1}"
      "  - balls: [{{at: [0, 0, 0], radius: {0}}}, {{at: [{2}, 0, 0], radius: {2}}}, {{at: [0, {2}, 0], "
      "radius: {2}}}]\n"
      "    material: grain\n    instances:\n{3}",
      radius, instances[0], 0.8 * radius, instances[1]);
}

/// count bodies in a box, a cell that repeats sideways, or under a lid that is pressed down; loose or dense.
model::Scene scene_of(const Kind& kind, int count, bool loose) {
  const double volume = count * 4 / 3. * std::numbers::pi * radius * radius * radius;
  const double edge = std::cbrt(volume / 0.6);
  const double fraction = loose ? 0.25 : 0.6;
  const double height = volume / fraction / (edge * edge);
  std::string text =
      "gravity: [0, 0, -9.81]\nmaterials: [{name: grain, density: 2500}]\ndamping: {local: 0.7}\n"
      "timestep: {policy: bound}\n";
  text += "contacts: [{between: [grain, grain], " + kind.contacts + "}]\n";
  text += kind.clumps ? clumps_of(count, edge) : balls_of(fraction, edge, height);
  if (kind.periodic)
    text += fmt::format(
        "periodic: {{box: [{}, {}, 1], axes: [x, y]}}\n"
        "walls: [{{plane: {{point: [0, 0, 0], normal: [0, 0, 1]}}, material: grain}}]\n",
        edge, edge);
  else
    text += fmt::format(
        "walls:\n  - {{box: {{min: [0, 0, 0], max: [{}, {}, 10], open: [+z]}}, material: grain}}\n", edge,
        edge);
  // Ten times the weight, so that no ball is loose below it.
  if (kind.servo)
    text += fmt::format(
        "  - plane: {{point: [0, 0, {}], normal: [0, 0, -1]}}\n    material: grain\n"
        "    servo: {{force: {}, max_speed: 0.1}}\n",
        height, 10 * volume * 2500 * 9.81);
  return io::read_scene_text(text, ".", kind.name);
}

double mean_overlap(const assembly::State& state) {
  double sum = 0;
  std::int64_t count = 0;
  assembly::for_each_acting(state.model, [&](const auto&, std::size_t, const auto& geometry) {
    sum += std::max(geometry.overlap, 0.0);
    ++count;
  });
  return sum / static_cast<double>(count);
}

/// The sum of loads and of what walls bear, over the sum of the loads.
double momentum_error(const assembly::State& state) {
  Vec3 total = Vec3::Zero();
  double loads = 0;
  for (std::int32_t row = 0; row < state.model.bodies.size(); ++row) {
    if (state.model.bodies.clumps.owner(row) != row) continue;
    const Vec3 load = assembly::load_on(state.model, static_cast<std::size_t>(row));
    total += load;
    loads += load.norm();
  }
  for (const Vec3& force : assembly::wall_forces(state.model)) {
    total -= force;
    loads = std::max(loads, force.norm());
  }
  return total.norm() / loads;
}

double mean_of(const assembly::Balance& balance) {
  return std::max(balance.mean, balance.moment_mean);
}

/// Relaxes and looks at what must be true of it.
void expect_rest(assembly::State& state) {
  const relaxation::RelaxResult result = relaxation::relax(state, {.tolerance = 1e-10});
  const double wished = std::max(1e-10, 3 * result.end.floor);
  EXPECT_LE(mean_of(result.end), wished) << result.explicit_steps << " steps, " << result.part_steps
                                         << " of a few, " << result.newton_iterations << " iterations";
  EXPECT_EQ(result.end.unsupported, 0);
  EXPECT_LE(result.missing_force, wished);
  // Each body misses the ratio times the mean contact force, and bodies are some hundred or thousand contacts
  // high.
  EXPECT_LE(momentum_error(state), wished * static_cast<double>(result.end.bodies));
  fmt::print("    {} steps, {} of a few, {} of Newton ({} linear), {:.1e}, {:.2g} s\n", result.explicit_steps,
             result.part_steps, result.newton_iterations, result.linear_iterations, mean_of(result.end),
             result.seconds);
  cycle::Cycle cycle(state, cycle::policy_of(state.settings));
  double worst = 0;
  for (int k = 0; k < 10; ++k) {
    cycle.run(100);
    worst = std::max(worst, assembly::balance_of(cycle.state()).mean);
  }
  EXPECT_LE(worst, 3 * wished);  // cycles move bodies by less than an ulp of their places each
}

/// Each body by a random vector of a tenth of the mean overlap.
void shake(assembly::State& state) {
  const double amplitude = 0.1 * mean_overlap(state);
  std::mt19937_64 random(11);
  model::Bodies& bodies = state.model.bodies;
  for (std::int32_t row = 0; row < bodies.size(); ++row)
    if (bodies.clumps.of(row) == model::Clumps::none)
      bodies.position[static_cast<std::size_t>(row)] += amplitude * random_vector(random) / std::sqrt(3.0);
  for (Vec3& x : bodies.clumps.position) x += amplitude * random_vector(random) / std::sqrt(3.0);
  if (!bodies.clumps.empty()) model::place_members(bodies);
  assembly::renew_list(state, state.list.skin);
  assembly::renew_forces(state);
}

void load_more(assembly::State& state) {
  bool servo = false;
  for (model::WallMotion& motion : state.model.wall_motions)
    if (motion.servo) {
      motion.servo->force *= 1.05;
      servo = true;
    }
  if (!servo) state.model.gravity *= 1.05;
}

void tilt(assembly::State& state) {
  const double angle = 10 * std::numbers::pi / 180;
  state.model.gravity = state.model.gravity.norm() * Vec3(std::sin(angle), 0, -std::cos(angle));
}

class Matrix : public testing::TestWithParam<Kind> {};

TEST_P(Matrix, ComesToRestFromEveryStart) {
  const Kind& kind = GetParam();
  for (const int size : sizes()) {
    assembly::State dense = cycle::start(scene_of(kind, size, false));
    {
      SCOPED_TRACE(fmt::format("{} bodies, as generated", size));
      expect_rest(dense);
    }
    if (kind.friction > 0 || !kind.periodic) {
      SCOPED_TRACE(fmt::format("{} bodies, gravity tilted by 10 degrees", size));
      assembly::State state = dense;
      tilt(state);
      expect_rest(state);
    }
    {
      SCOPED_TRACE(fmt::format("{} bodies, 5% more load", size));
      assembly::State state = dense;
      load_more(state);
      expect_rest(state);
    }
    {
      SCOPED_TRACE(fmt::format("{} bodies, shaken", size));
      assembly::State state = dense;
      shake(state);
      expect_rest(state);
    }
    if (!kind.clumps) {  // these begin loose
      SCOPED_TRACE(fmt::format("{} bodies, loose", size));
      assembly::State state = cycle::start(scene_of(kind, size, true));
      expect_rest(state);
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Relax, Matrix, testing::ValuesIn(kinds()),
                         [](const auto& kind) { return kind.param.name; });

}  // namespace
}  // namespace eigengrain::test
