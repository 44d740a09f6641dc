// The masses that make a step stable: proven by dense spectra, against closed forms and the other forms of
// mass scaling; and the policy of runs.
#include "eigengrain/timestep/selective_lift.hpp"

#include "eigengrain/assembly/local_damping.hpp"
#include "eigengrain/base/error.hpp"
#include "eigengrain/cycle/bounds.hpp"
#include "eigengrain/cycle/lift.hpp"
#include "eigengrain/cycle/mass_scaling.hpp"
#include "eigengrain/io/scene_reader.hpp"
#include "eigengrain/timestep/low_modes.hpp"

#include "support/clumps.hpp"
#include "support/lattices.hpp"
#include "support/laws.hpp"
#include "support/restart.hpp"
#include "support/scaled_heap.hpp"

#include <Eigen/Eigenvalues>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <limits>
#include <random>

namespace eigengrain::test {
namespace {

using cycle::Lift;
using testing::HasSubstr;
using timestep::critical_timestep;
using timestep::lift_step;
using timestep::SelectiveLift;

/// Of dense eigenvalues, and of what is found by squaring and dividing them.
constexpr double rounding = 1e-12;

const timestep::TruthOptions unproven{.certify = timestep::Certify::never};

System dense_packing() {
  return System(assembly::build_model(io::read_scene_text(R"(
materials: [{name: grain, density: 2500}]
contacts: [{between: [grain, grain], law: linear, kn: 1e5, ks: 5e4, friction: 0.5}]
periodic: {box: [0.05, 0.05, 0.05]}
damping: {local: 0}
balls:
  - fill: dense
    mean_overlap: 1e-3
    sizes: {distribution: lognormal, mean: 4.6 mm, deviation: 0.5 mm, min: 3 mm, max: 7 mm}
    seed: 1
    material: grain
)",
                                                          ".")));
}

double sum(const std::vector<double>& column) {
  double result = 0;
  for (const double x : column) result += x;
  return result;
}

/// Each body by its own block.
Lift differential(const System& s, std::span<const double> alpha, double wished) {
  return cycle::lift_of_weights(s, s.model.bodies.mass, alpha, wished,
                                std::vector<double>(s.model.bodies.mass.size(), 1.0));
}

/// The law of the scene with dashpots.
void add_dashpots(SceneBuilder& builder, double ks, double beta_n, double beta_s) {
  builder.scene().contacts[0].parameters = values_of(
      "linear",
      {{"kn", 1}, {"ks", ks}, {"friction", 0.5}, {"tension", 1}, {"beta_n", beta_n}, {"beta_s", beta_s}});
}

// In every second scene with local damping, in every third with dashpots, in every fifth with clumps.
TEST(SelectiveLift, IsProvenInRandomClusters) {
  std::mt19937_64 random(4);
  std::uniform_real_distribution<double> uniform(0, 1);
  double least = std::numeric_limits<double>::infinity();
  double most = 0;
  int lifted = 0;
  double part_of_differential = 0;
  for (int scene = 0; scene < 300; ++scene) {
    const double spread = scene % 2 == 0 ? 5 : 1.5;
    SceneBuilder builder =
        scene % 5 == 0 ? touching_pair({.kn = 1, .ks = 0.5 * uniform(random)}, random)
                       : random_cluster(random, 2 + scene % 15,
                                        {.kn = 1, .ks = scene % 4 == 0 ? 0 : uniform(random)}, spread, 0.1);
    if (scene % 3 == 0) add_dashpots(builder, 0.5, 0.3 * uniform(random), 0.2);
    builder.damped(scene % 2 == 0 ? 0.7 : 0);
    if (scene % 7 == 0) builder.plane({-1, 0, 0}, {1, 0, 0});
    const System system(builder);
    const std::vector<double> damping = assembly::damping_of_unknowns(system.model, system.unknowns);
    const std::vector<double> alpha(system.model.bodies.mass.size(), system.model.local_damping);
    const double limit = critical_timestep(system, damping, unproven).limit;
    if (!std::isfinite(limit)) continue;
    const double wished = limit * (1 + uniform(random));
    const Lift lift = cycle::lift(system, system.model.bodies.mass, alpha, wished);
    const double ratio =
        critical_timestep(cycle::lifted(system, lift.factor), damping, unproven).limit / wished;
    least = std::min(least, ratio);
    most = std::max(most, ratio);
    for (const double c : lift.factor) EXPECT_GE(c, 1);
    const double by_blocks = differential(system, alpha, wished).added;
    EXPECT_LE(lift.added, by_blocks * (1 + rounding)) << scene;
    if (by_blocks > 0) part_of_differential += lift.added / by_blocks;
    ++lifted;
  }
  std::printf("%d clusters: true limit %.6f to %.4f of the wished step; %.3f of the mass of differential\n",
              lifted, least, most, part_of_differential / lifted);
  EXPECT_GT(lifted, 200);
  EXPECT_GE(least, 1 - rounding);
}

/// Two balls in a row. 1/M_1 + 1/M_2 = μ²/k with as little mass as may be: M_1 = M_2 = 2k/μ², but for a ball
/// that is heavier already.
SceneBuilder pair_of(double first, double second) {
  SceneBuilder builder({.kn = 1});
  return builder.ball({0, 0, 0}, 1, first).ball({2 - 1e-9, 0, 0}, 1, second);
}

/// c of the balls in the order of the scene.
std::vector<double> factors_of(const assembly::Model& model, const Lift& lift) {
  std::vector<double> result(lift.factor.size());
  for (std::size_t i = 0; i < result.size(); ++i)
    result[static_cast<std::size_t>(model.bodies.identity[i])] = lift.factor[i];
  return result;
}

// The kink at c = 1 is rounded off by two thousandths in the end, and the last step of a weight is half a
// percent.
TEST(SelectiveLift, OfAPairIsTheLeastThatThereIs) {
  constexpr double convergence = 5e-3;
  const double limit = 2 / std::sqrt(4.0 / 3);
  const System system(pair_of(1, 3));
  {
    const double mu2 = 4 / (1.44 * limit * limit);  // 1.2 times the truth: the lighter ball alone
    const Lift lift = cycle::lift(system, system.model.bodies.mass, {}, 1.2 * limit);
    const std::vector<double> c = factors_of(system.model, lift);
    EXPECT_EQ(lift.heavier, 1);
    EXPECT_EQ(c[1], 1);
    EXPECT_NEAR(c[0], 1 / (mu2 - 1.0 / 3), convergence);
    EXPECT_GE(c[0], 1 / (mu2 - 1.0 / 3) * (1 - rounding));
  }
  {
    const Lift lift = cycle::lift(system, system.model.bodies.mass, {}, 2 * limit);  // both have to be 6
    const std::vector<double> c = factors_of(system.model, lift);
    EXPECT_NEAR(c[0], 6, 6 * convergence);
    EXPECT_NEAR(c[1], 2, 2 * convergence);
    EXPECT_NEAR(lift.added, 8, 8 * convergence * convergence);  // a minimum: of second order
    EXPECT_GE(lift.added, 8 * (1 - rounding));
  }
}

TEST(SelectiveLift, LeavesAloneWhatHolds) {
  const System system = dense_packing();
  const double proven = cycle::block_bound(system);
  for (const double part : {0.5, 1 - rounding, 1.15}) {  // the last with weights
    const Lift lift = cycle::lift(system, system.model.bodies.mass, {}, part * proven);
    EXPECT_EQ(lift.heavier, 0);
    EXPECT_EQ(lift.added, 0);
    EXPECT_EQ(std::ranges::count(lift.factor, 1.0), std::ssize(lift.factor));
  }
  // Where something has to be lifted it is nothing far from what does not hold.
  const double truth = critical_timestep(system, 0.0, unproven).dt;
  const Lift little = cycle::lift(system, system.model.bodies.mass, {}, truth);
  EXPECT_GT(little.heavier, 0);
  EXPECT_LT(10 * little.heavier, std::ssize(little.factor));
}

TEST(SelectiveLift, AddsLessMassThanTheOtherForms) {
  const System system = dense_packing();
  const double truth = critical_timestep(system, 0.0, unproven).dt;
  const double mass = sum(system.model.bodies.mass);
  for (const double part : {1.1, 1.3, 2.0}) {
    const SelectiveLift lift = lift_step(system.model, part * truth);
    std::printf(
        "%.1f times the truth: %.3f%% on %d of %zu bodies; by weights %.3f%%, differential %.3f%%, "
        "uniform %.1f%%\n",
        part, 100 * lift.lift.added / mass, lift.lift.heavier, lift.lift.factor.size(),
        100 * lift.added_by_weights / mass, 100 * lift.added_differential / mass,
        100 * lift.added_uniform / mass);
    EXPECT_TRUE(lift.by_eigenvalue);
    EXPECT_NEAR(lift.mass, mass, 1e-12 * mass);
    EXPECT_LT(lift.lift.added, lift.added_by_weights);
    EXPECT_LE(lift.added_by_weights, lift.added_differential);
    EXPECT_LT(lift.added_differential, lift.added_uniform);
    EXPECT_NEAR(lift.added_uniform, (part * part - 1) * mass, 1e-9 * mass);
    // Proven by a factorisation, and true by the dense spectrum.
    EXPECT_TRUE(lift.after.certified);
    EXPECT_GE(lift.after.limit_proof.dt, lift.wished);
    const Eigen::MatrixXd a = assembly::dense_scaled_stiffness(cycle::lifted(system, lift.lift.factor));
    const double largest =
        Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd>(a, Eigen::EigenvaluesOnly).eigenvalues().maxCoeff();
    EXPECT_GE(2 / std::sqrt(largest), lift.wished);
    EXPECT_LE(2 / std::sqrt(largest), 1.01 * lift.wished);
  }
}

// The slowest modes of a cluster that grew as a tree and of a periodic packing: rigid motions and spins that
// nothing resists come before them.
TEST(LowModes, AreTheLeastOfTheDenseSpectrumThatAreNotZero) {
  std::mt19937_64 random(8);
  for (const bool cluster : {true, false}) {
    const System system =
        cluster ? System(random_cluster(random, 120, {.kn = 1, .ks = 0.5}, 2)) : dense_packing();
    ASSERT_GT(system.unknowns.free_components().size(), 300U);  // iterated
    const Eigen::VectorXd spectrum = system.spectrum();
    const double largest = spectrum.maxCoeff();
    const timestep::LowModes low = timestep::low_modes(system, 6, largest);
    ASSERT_EQ(low.lambda.size(), 6U);
    const auto first =
        std::find_if(spectrum.begin(), spectrum.end(), [&](double x) { return x > low.floor; });
    std::printf("%td motions not resisted, then %.3e of the largest\n", first - spectrum.begin(),
                *first / largest);
    for (std::size_t k = 0; k < 6; ++k) {
      // Dense eigenvalues err by some 1e-15 times their number of the largest.
      EXPECT_NEAR(low.lambda[k], first[k], 1e-12 * largest + 1e-9 * first[k]) << k;
      EXPECT_LT(low.residual[k], 1e-5);
    }
  }
}

TEST(SelectiveLift, TellsWhatBecomesOfTheSlowestModes) {
  const System system = dense_packing();
  const SelectiveLift lift = lift_step(system.model, 1.2 * critical_timestep(system, 0.0, unproven).dt);
  ASSERT_EQ(lift.low_before.lambda.size(), 6U);
  ASSERT_EQ(lift.low_after.lambda.size(), 6U);
  for (std::size_t k = 0; k < 6;
       ++k) {  // c_max bounds what more mass can do, and it does nothing but slow down
    EXPECT_LE(lift.low_after.lambda[k], lift.low_before.lambda[k] * (1 + 1e-9));
    EXPECT_GE(lift.low_after.lambda[k], lift.low_before.lambda[k] / lift.lift.largest);
  }
}

std::string refusal(const assembly::Model& model, double wished) {
  try {
    lift_step(model, wished);
  } catch (const InputError& error) {
    return error.what();
  }
  return "none";
}

TEST(SelectiveLift, RefusesWhatIsNoLongerStep) {
  const assembly::Model model = pair_of(1, 3).build();
  EXPECT_THAT(refusal(model, -1), HasSubstr("-1 s is no step; write a time above 1.732051e+00 s"));
  EXPECT_THAT(refusal(model, std::numeric_limits<double>::infinity()), HasSubstr("inf s is no step"));
  EXPECT_THAT(refusal(model, std::nan("")), HasSubstr("is no step"));
  EXPECT_THAT(refusal(model, 1.7), HasSubstr("within the true limit of this scene as it is, 1.732051e+00 s"));
  SceneBuilder apart({.kn = 1});
  apart.ball({0, 0, 0}).ball({9, 0, 0});
  EXPECT_THAT(refusal(apart.build(), 1), HasSubstr("nothing resists a motion here"));
}

/// A state with the masses of the policy, the safety factor being one.
assembly::State scaled(SceneBuilder builder, double dt) {
  builder.scene().mass_scaling = model::MassScaling{model::MassScaling::Form::selective, dt};
  builder.scene().timestep.safety = 1;
  assembly::State state = cycle::start(builder.scene());
  cycle::scale_masses(state);
  return state;
}

double limit_of(const assembly::State& state, assembly::Listed which) {
  const assembly::LinearSystem system(state.model, which);
  return critical_timestep(system, assembly::damping_of_unknowns(state.model, system.unknowns), unproven)
      .limit;
}

TEST(SelectiveMassScaling, MakesTheStepStable) {
  std::mt19937_64 random(5);
  for (int scene = 0; scene < 60; ++scene) {
    SceneBuilder builder =
        random_cluster(random, 3 + scene % 20, {.kn = 1, .ks = scene % 3 == 0 ? 0 : 0.5}, 4, 0.1);
    if (scene % 2 == 0) add_dashpots(builder, 0.5, 0.2, 0.1);
    builder.damped(scene % 2 == 0 ? 0.7 : 0);
    const double dt = 1.5;
    const assembly::State state = scaled(builder, dt);
    EXPECT_GE(limit_of(state, assembly::Listed::all), dt * (1 - rounding)) << scene;
    EXPECT_GE(limit_of(state, assembly::Listed::acting), dt * (1 - rounding)) << scene;
    const cycle::ScaledMasses masses = cycle::scaled_masses(state.model.bodies);
    EXPECT_GE(masses.added, 0);
    EXPECT_LE(masses.heavier, masses.bodies);
  }
}

TEST(SelectiveMassScaling, LeavesMassesAloneWhereTheStepIsStable) {
  const assembly::State state = scaled(pair_of(1, 3), 1.7);
  EXPECT_EQ(state.model.bodies.mass_factor, (std::vector<double>{1, 1}));
  EXPECT_EQ(cycle::scaled_masses(state.model.bodies).added, 0);
}

constexpr const char* selective = "{form: selective, dt: 0.1 ms}";

TEST(SelectiveMassScaling, ARestartGoesOnToTheBit) {
  for (const char* law : {"law: linear, kn: 1e4, ks: 5e3, friction: 0.4, beta_n: 0.2",
                          "law: hertz, effective_young: 1e7, effective_shear: 5e6, friction: 0.4"}) {
    const model::Scene scene = io::read_scene_text(scaled_heap(selective, law), ".", "heap.yaml");
    expect_to_continue(scene, 300, {0, 1, 133});
    const auto run = [&](int threads) {
      const Threads with(threads);
      cycle::Cycle cycle(cycle::start(scene), cycle::policy_of(scene));
      cycle.run(200);
      EXPECT_GT(cycle::scaled_masses(cycle.state().model.bodies).heavier, 0) << law;
      return bits_of(cycle.state());
    };
    EXPECT_EQ(run(1), run(3));
  }
}

// Beside policy `tracked` the acting contacts are never beyond the limit, whatever closes on the way.
TEST(SelectiveMassScaling, OfWhatIsTrackedIsStableAtEveryStep) {
  for (const char* law : {"law: linear, kn: 1e4, ks: 5e3, friction: 0.4, beta_n: 0.2",
                          "law: hertz, effective_young: 1e7, effective_shear: 5e6, friction: 0.4"}) {
    const model::Scene scene = io::read_scene_text(
        scaled_heap(selective, law) + "timestep: {policy: tracked, safety: 1}\n", ".", "heap.yaml");
    expect_to_continue(scene, 300, {0, 1, 133});
    cycle::Cycle cycle(cycle::start(scene), cycle::policy_of(scene));
    std::int64_t heavier = 0;
    for (int step = 0; step < 300; ++step) {
      cycle.step();
      EXPECT_EQ(cycle.state().dt, 1e-4);
      EXPECT_GE(limit_of(cycle.state(), assembly::Listed::acting), 1e-4 * (1 - rounding)) << law << step;
      heavier = std::max(heavier, cycle::scaled_masses(cycle.state().model.bodies).heavier);
    }
    EXPECT_GT(heavier, 0) << law;
  }
}

// Its time is the true one: what moves goes on moving when it is switched off, unlike with the other forms.
TEST(SelectiveMassScaling, IsSwitchedOffInAState) {
  const io::TemporaryFolder folder;
  const model::Scene scene = io::read_scene_text(
      scaled_heap(selective, "law: linear, kn: 1e4, ks: 5e3, friction: 0.4"), ".", "heap.yaml");
  cycle::Cycle cycle(cycle::start(scene), cycle::policy_of(scene));
  cycle.run(50);
  io::write_state(cycle.state(), folder.path() / "state.h5");
  const std::vector<std::string> off{"mass_scaling.form=none"};
  const assembly::State read = io::read_state(folder.path() / "state.h5", off);
  EXPECT_TRUE(read.model.bodies.mass_factor.empty());
  EXPECT_EQ(read.model.bodies.velocity, cycle.state().model.bodies.velocity);
  EXPECT_EQ(read.dt, cycle.state().dt);
  EXPECT_EQ(read.next_dt, 0);
  const std::vector<std::string> other{"mass_scaling.form=differential"};
  const assembly::State stopped = io::read_state(folder.path() / "state.h5", other);
  EXPECT_EQ(stopped.dt, 0);
  for (const Vec3& v : stopped.model.bodies.velocity) EXPECT_EQ(v, Vec3::Zero());
}

}  // namespace
}  // namespace eigengrain::test
