// Inertial masses that make a step stable: proven, of use, and without influence on the static solution.
#include "eigengrain/cycle/mass_scaling.hpp"

#include "eigengrain/assembly/balance.hpp"
#include "eigengrain/assembly/local_damping.hpp"
#include "eigengrain/cycle/bounds.hpp"
#include "eigengrain/cycle/step_prover.hpp"
#include "eigengrain/measures/ledger.hpp"

#include "support/clumps.hpp"
#include "support/restart.hpp"
#include "support/scaled_heap.hpp"

#include <Eigen/Eigenvalues>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <limits>
#include <random>

namespace eigengrain::test {
namespace {

using cycle::Cycle;
using Form = model::MassScaling::Form;

constexpr double infinity = std::numeric_limits<double>::infinity();

/// The state of a scene whose masses make a step of one second stable.
assembly::State scaled(SceneBuilder builder, Form form = Form::differential) {
  builder.scene().mass_scaling = model::MassScaling{form, 1.0};
  assembly::State state = cycle::start(builder.scene());
  cycle::scale_masses(state);
  return state;
}

/// The true limit of the damped cycle of the scaled masses, over what was to be proven (dense spectrum).
double limit_over_wish(const assembly::State& state, assembly::Listed which) {
  const assembly::LinearSystem system(state.model, which);
  const Eigen::MatrixXd a = assembly::dense_scaled_stiffness(system);
  const double largest =
      Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd>(a, Eigen::EigenvaluesOnly).eigenvalues().maxCoeff();
  if (!(largest > 0)) return infinity;
  const double limit = cycle::damped_timestep(2 / std::sqrt(largest), assembly::largest_damping(state.model));
  return limit / (state.settings.mass_scaling->dt / state.settings.timestep.safety);
}

struct Range {
  double least = infinity;
  double most = 0;
  void add(double x) {
    least = std::min(least, x);
    if (std::isfinite(x)) most = std::max(most, x);
  }
};

// The dense eigenvalues err by some 1e-15 times their number.
constexpr double rounding = 1e-12;

TEST(MassScaling, TheTrueLimitIsNeverBelowWhatIsProven) {
  std::mt19937_64 random(11);
  std::uniform_real_distribution<double> uniform(0, 1);
  for (const Form form : {Form::differential, Form::uniform}) {
    Range range;
    for (int k = 0; k < 300; ++k) {
      const double spread = k % 2 == 0 ? 10 : 1.5;
      SceneBuilder builder = random_cluster(
          random, 3 + k % 20, {.kn = 1e4, .ks = k % 3 == 0 ? 0 : 1e4 * uniform(random)}, spread, 0.1);
      builder.damped(k % 2 == 0 ? 0.7 : 0);
      if (k % 5 == 0) builder.damped_alone(0.3);
      if (k % 4 == 0) builder.plane({-1.5, 0, 0}, {1, 0, 0});
      const assembly::State state = scaled(builder, form);
      range.add(limit_over_wish(state, assembly::Listed::all));
      range.add(limit_over_wish(state, assembly::Listed::acting));
    }
    std::printf("%s: true limit %.4f to %.4f of what was to be proven\n", model::name_of(form), range.least,
                range.most);
    EXPECT_GE(range.least, 1 - rounding);
  }
}

TEST(MassScaling, OfClumpsToo) {
  std::mt19937_64 random(5);
  Range range;
  for (int k = 0; k < 100; ++k)
    range.add(limit_over_wish(scaled(touching_pair({.kn = 1e4, .ks = k % 2 == 0 ? 0.0 : 5e3}, random)),
                              assembly::Listed::acting));
  std::printf("clumps: true limit %.4f to %.4f of what was to be proven\n", range.least, range.most);
  EXPECT_GE(range.least, 1 - rounding);
}

/// Two equal balls, without friction, along (1, 1, 1).
SceneBuilder oblique_pair() {
  SceneBuilder builder({.kn = 1e4});
  return builder.ball(Vec3::Zero()).ball((2 - 1e-9) / std::sqrt(3) * Vec3::Ones());
}

// PFC3D takes the diagonal k_n/3 on each axis where the block has k_n: its step of one is 1.2247 times the
// true limit of its own masses, and the block is exact here.
TEST(MassScaling, TheRuleOfPfc3dIsNoBoundOnAnObliquePair) {
  EXPECT_NEAR(limit_over_wish(scaled(oblique_pair()), assembly::Listed::acting), 1, rounding);
  assembly::State state = scaled(oblique_pair());
  for (std::size_t i = 0; i < 2; ++i)
    state.model.bodies.mass_factor[i] = 1e4 / 3 / state.model.bodies.mass[i];
  const assembly::LinearSystem system(state.model);
  EXPECT_NEAR(cycle::diagonal_estimate(system), 1, rounding);  // as PFC3D wants it
  const Eigen::MatrixXd a = assembly::dense_scaled_stiffness(system);
  const double largest = Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd>(a).eigenvalues().maxCoeff();
  EXPECT_NEAR(1 / (2 / std::sqrt(largest)), std::sqrt(1.5), rounding);
}

// √factor is the ratio of steps: one factor makes the bound of the scaled system what is wished.
TEST(MassScaling, OneFactorForAllMakesTheBoundWhatIsWished) {
  std::mt19937_64 random(2);
  assembly::State state = scaled(random_cluster(random, 15, {.kn = 1e4, .ks = 5e3}, 5), Form::uniform);
  const std::vector<double>& factor = state.model.bodies.mass_factor;
  EXPECT_EQ(std::count(factor.begin(), factor.end(), factor[0]), 15);
  const assembly::LinearSystem system(state.model, assembly::Listed::all);
  // What policy `bound` proves, until 3% more cannot be proven.
  const double proven = cycle::StepProver(system).sharpen(std::numeric_limits<double>::infinity(), 1.03);
  EXPECT_NEAR(proven, 1 / 0.8, 1e-12);
}

// A clump keeps its tensor but for the factor, and its angular velocity: a moment makes it turn by M/(c I).
TEST(MassScaling, ScalesTheWholeTensorOfAClump) {
  const model::ClumpShape shape = odd_shape();
  SceneBuilder builder;
  builder.clump(shape, {.moment = {0, 0.1, 0}});
  builder.ball({50, 0, 0});  // something to meet
  builder.scene().mass_scaling = model::MassScaling{Form::differential, 0.25};
  Cycle cycle(cycle::start(builder.scene()), cycle::policy_of(builder.scene()));
  cycle.run(2);
  const model::Bodies& bodies = cycle.state().model.bodies;
  const auto holder = static_cast<std::size_t>(bodies.clumps.holder(0));
  EXPECT_NEAR(bodies.clumps.angular_momentum[0].y(), 1.5 * 0.25 * 0.1 / bodies.mass_factor[holder], 1e-15);
}

/// Balls on each other under gravity, with radii from 1 to 5 and masses to fit.
SceneBuilder column() {
  SceneBuilder builder({.kn = 1e4, .tension = false});
  double height = 0;
  for (int i = 0; i < 5; ++i) {
    const double radius = 1 + i;
    builder.ball({0, 0, height + radius}, radius, radius * radius * radius);
    height += 2 * radius;
  }
  return builder.plane(Vec3::Zero(), Vec3::UnitZ()).gravity({0, 0, -10}).damped(0.7);
}

/// Steps until the mean unbalanced ratio is below this, looked at every 10.
struct Settled {
  std::int64_t steps = 0;
  assembly::State state;
};
Settled settle(const model::Scene& scene, double ratio, std::int64_t most = 1000000) {
  Cycle cycle(cycle::start(scene), cycle::policy_of(scene));
  while (cycle.state().step < most) {
    cycle.run(10);
    const assembly::Balance balance = assembly::balance_of(cycle.state());
    if (balance.unsupported == 0 && balance.contacts > 0 && balance.mean < ratio) break;
  }
  const std::int64_t steps = cycle.state().step;
  return {steps, cycle.release()};
}

TEST(MassScaling, TheWeightOfAColumnIsTheTrueOne) {
  constexpr double ratio = 1e-9;
  for (const Form form : {Form::differential, Form::uniform}) {
    SceneBuilder builder = column();
    builder.scene().mass_scaling = model::MassScaling{form, 1.0};
    const Settled end = settle(builder.scene(), ratio);
    double weight = 0;
    for (int i = 0; i < 5; ++i) weight += 10 * (1 + i) * (1 + i) * (1 + i);
    const double load = assembly::wall_loads(end.state.model)[0].force.z();
    // What is unbalanced of five balls, each on average by `ratio` of the mean contact force, which is less
    // than the weight.
    EXPECT_NEAR(load, -weight, 5 * ratio * weight) << model::name_of(form);
  }
}

/// Large and small balls in turn, 10:1 in size and 1000:1 in mass, in four columns side by side.
SceneBuilder bed_of_two_sizes() {
  SceneBuilder builder({.kn = 1e4, .ks = 5e3, .tension = false});
  for (int column = 0; column < 4; ++column) {
    double height = 0;
    for (int i = 0; i < 10; ++i) {
      const double radius = (i + column) % 2 == 0 ? 1 : 0.1;
      builder.ball({3.0 * column, 0, height + radius}, radius, radius * radius * radius);
      height += 2 * radius;
    }
  }
  return builder.plane(Vec3::Zero(), Vec3::UnitZ()).gravity({0, 0, -10}).damped(0.7);
}

TEST(MassScaling, ABedOfTwoSizesSettlesInFewerSteps) {
  constexpr double ratio = 1e-4;
  constexpr std::int64_t most = 100000;
  model::Scene scene = bed_of_two_sizes().scene();
  scene.timestep = {model::TimestepPolicy::bound, 0.8, {}};
  for (model::FixedComponents& fixed : scene.bodies.fixed)
    fixed = model::FixedComponents(0b111011);  // along z
  const Settled truly = settle(scene, ratio, most);
  scene.mass_scaling = model::MassScaling{Form::differential, 1.0};
  const Settled quickly = settle(scene, ratio, most);
  std::printf("%d balls, 10:1: %lld steps with the true masses, %lld with scaled ones\n", scene.bodies.size(),
              static_cast<long long>(truly.steps), static_cast<long long>(quickly.steps));
  ASSERT_LT(truly.steps, most);
  EXPECT_LT(4 * quickly.steps, truly.steps);
  // Both are the same solution: what the floor bears errs by no more than what all bodies together are out of
  // balance by.
  double weight = 0;
  for (const double m : scene.bodies.mass) weight += 10 * m;
  for (const Settled* end : {&truly, &quickly}) {
    const assembly::Balance balance = assembly::balance_of(end->state);
    EXPECT_NEAR(assembly::wall_loads(end->state.model)[0].force.z(), -weight,
                40 * balance.mean * balance.mean_contact_force);
  }
}

TEST(MassScaling, ABallWithoutContactsHasTheFactorOfItsFirstOne) {
  SceneBuilder builder({.kn = 1e4});
  builder.ball({0, 0, 0}, 1, 3).ball({100, 0, 0}, 2, 5);
  const assembly::State state = scaled(builder);
  // Two equal balls: 2 k/m is the block, so c = (dt/2s)² 2 k/m
  for (std::size_t i = 0; i < 2; ++i)
    EXPECT_NEAR(state.model.bodies.mass_factor[i],
                std::pow(0.5 / 0.8, 2) * 2 * 1e4 / state.model.bodies.mass[i], 1e-9);
}

TEST(MassScaling, HasNoLedger) {
  SceneBuilder builder = column();
  builder.scene().mass_scaling = model::MassScaling{};
  assembly::State state = cycle::start(builder.scene());
  EXPECT_THROW(measures::begin_ledger(state), InputError);
}

std::string heap(const std::string& form, const std::string& law) {
  return scaled_heap("{form: " + form + ", dt: 1 ms}", law);
}

TEST(MassScaling, ARestartGoesOnToTheBit) {
  for (const char* form : {"differential", "uniform"})
    for (const char* law : {"law: linear, kn: 1e4, ks: 5e3, friction: 0.4",
                            "law: hertz, effective_young: 1e7, effective_shear: 5e6, friction: 0.4"}) {
      const model::Scene scene = io::read_scene_text(heap(form, law), ".", "heap.yaml");
      expect_to_continue(scene, 300, {0, 1, 133});
      const auto run = [&](int threads) {
        const Threads with(threads);
        Cycle cycle(cycle::start(scene), cycle::policy_of(scene));
        cycle.run(200);
        return bits_of(cycle.state());
      };
      EXPECT_EQ(run(1), run(3));
    }
}

TEST(MassScaling, IsSwitchedOffInAState) {
  const io::TemporaryFolder folder;
  const model::Scene scene = io::read_scene_text(
      heap("differential", "law: linear, kn: 1e4, ks: 5e3, friction: 0.4"), ".", "heap.yaml");
  Cycle cycle(cycle::start(scene), cycle::policy_of(scene));
  cycle.run(50);
  io::write_state(cycle.state(), folder.path() / "state.h5");
  const std::vector<std::string> off{"mass_scaling.form=none"};
  const assembly::State read = io::read_state(folder.path() / "state.h5", off);
  EXPECT_TRUE(read.model.bodies.mass_factor.empty());
  EXPECT_FALSE(read.settings.mass_scaling.has_value());
  EXPECT_EQ(read.dt, 0);
  for (const Vec3& v : read.model.bodies.velocity) EXPECT_EQ(v, Vec3::Zero());
}

}  // namespace
}  // namespace eigengrain::test
