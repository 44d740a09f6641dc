// The limit of the damped cycle against dense algebra, and against runs on both sides of it.
//
// With x along the mode of the limit, M'-normalised, k = x·Kx and c = x·Cx, the cycle is
//   z² + (kΔt² + cΔt - 2) z + 1 - cΔt = 0      at Δt = 2/μ, μ² = k + μc, z = -1 is a root
// Near z = -1 the resultant opposes the velocity of the step before in each component, as both are M'x, so
// that local damping acts as M' = M/(1 + α), whatever α each component has.
#include "eigengrain/assembly/local_damping.hpp"
#include "eigengrain/assembly/product.hpp"
#include "eigengrain/cycle/bounds.hpp"
#include "eigengrain/timestep/truth.hpp"

#include "support/clusters.hpp"
#include "support/laws.hpp"
#include "support/motion.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <complex>
#include <cstdio>
#include <random>
#include <utility>

namespace eigengrain::test {
namespace {

using cycle::Cycle;
using timestep::Truth;

Truth truth_of(const System& s, const timestep::TruthOptions& options = {}) {
  return timestep::critical_timestep(s, assembly::damping_of_unknowns(s.model, s.unknowns), options);
}

/// 2/μ by the companion matrix of the whole quadratic problem.
double dense_limit(const System& s) {
  const std::vector<std::int32_t> free = s.unknowns.free_components();
  const std::vector<double> alpha = assembly::damping_of_unknowns(s.model, s.unknowns);
  Eigen::MatrixXd k = assembly::dense_scaled_stiffness(s);
  Eigen::MatrixXd c = assembly::dense_scaled_stiffness(assembly::with_viscosity(s, 1.0)) - k;
  const Eigen::Index n = k.rows();
  Eigen::VectorXd scale(n);
  for (Eigen::Index i = 0; i < n; ++i)
    scale[i] = std::sqrt(1 + alpha[static_cast<std::size_t>(free[static_cast<std::size_t>(i)])]);
  Eigen::MatrixXd companion = Eigen::MatrixXd::Zero(2 * n, 2 * n);  // of (x, μx)
  companion.topRightCorner(n, n).setIdentity();
  companion.bottomLeftCorner(n, n) = scale.asDiagonal() * k * scale.asDiagonal();
  companion.bottomRightCorner(n, n) = scale.asDiagonal() * c * scale.asDiagonal();
  return 2 / Eigen::EigenSolver<Eigen::MatrixXd>(companion, false).eigenvalues().real().maxCoeff();
}

/// Linear springs that pull, with dashpots. All contacts alike, or, with `others`, those between balls of
/// the second material and those across with ratios of their own.
struct Dashpot {
  double normal = 0;
  double shear = 0;
};
SceneBuilder damped_scene(double ks, Dashpot beta, std::vector<Dashpot> others = {}) {
  const auto rule = [&](Dashpot b) {
    return values_of("linear", {{"kn", 1},
                                {"ks", ks},
                                {"friction", ks > 0 ? 0.5 : 0},
                                {"tension", 1},
                                {"beta_n", b.normal},
                                {"beta_s", b.shear}});
  };
  SceneBuilder builder;
  builder.scene().contacts = {{.law = "linear", .parameters = rule(beta)}};
  if (others.empty()) return builder;
  builder.scene().materials.push_back({"other", 1.0});
  builder.scene().contacts = {{.first = 0, .second = 0, .law = "linear", .parameters = rule(beta)},
                              {.first = 0, .second = 1, .law = "linear", .parameters = rule(others.at(0))},
                              {.first = 1, .second = 1, .law = "linear", .parameters = rule(others.at(1))}};
  return builder;
}

SceneBuilder& with_balls(SceneBuilder& builder, const PlacedBalls& places) {
  for (std::size_t i = 0; i < places.centres.size(); ++i)
    builder.ball(places.centres[i], places.radii[i], std::pow(places.radii[i], 3));
  return builder;
}

/// α and material of each ball for itself.
void mix(SceneBuilder& builder, std::uint64_t seed) {
  std::mt19937_64 random(seed);
  std::uniform_real_distribution<double> uniform(0, 1);
  model::Bodies& bodies = builder.scene().bodies;
  bodies.damping.clear();
  for (std::size_t i = 0; i < bodies.position.size(); ++i) {
    bodies.damping.push_back(0.8 * uniform(random));
    if (builder.scene().materials.size() > 1) bodies.material[i] = uniform(random) < 0.5 ? 0 : 1;
  }
}

/// The part of the mode of the limit in the motion of a scene.
class LimitMode {
 public:
  LimitMode(const System& s, const Truth& truth)
      : system_(s), mode_(truth.limit_mode), alpha_(assembly::damping_of_unknowns(s.model, s.unknowns)) {
    assembly::StiffnessProduct viscosity(s.unknowns,
                                         s.damping.empty() ? s.elements : assembly::viscous_elements(s));
    std::vector<double> cx(mode_.size());
    viscosity.apply(mode_, cx);
    const double mu = 2 / truth.limit;
    for (std::size_t k = 0; k < mode_.size() && !s.damping.empty(); ++k) c_ += mode_[k] * cx[k];
    k_ = mu * mu - mu * c_;
  }

  /// Gives a scene velocities along the mode: the fastest surface makes a way of `way` in a step.
  void start(model::Scene& scene, double way, double dt) const {
    double most = 0;
    each([&](std::size_t k, std::size_t body, int, bool turns) {
      most = std::max(most, std::abs(mode_[k]) * (turns ? system_.model.bodies.radius[body] : 1));
    });
    const std::size_t count = scene.bodies.position.size();
    scene.bodies.velocity.assign(count, Vec3::Zero());
    scene.bodies.spin.assign(count, Vec3::Zero());
    each([&](std::size_t k, std::size_t body, int axis, bool turns) {
      const auto identity = static_cast<std::size_t>(system_.model.bodies.identity[body]);
      (turns ? scene.bodies.spin : scene.bodies.velocity)[identity][axis] = way / dt / most * mode_[k];
    });
  }

  /// x·M'v
  double part(const assembly::State& state) const {
    double sum = 0;
    each([&](std::size_t k, std::size_t body, int axis, bool turns) {
      const model::Bodies& bodies = state.model.bodies;
      sum +=
          mode_[k] * system_.mass[k] / (1 + alpha_[k]) * (turns ? bodies.spin : bodies.velocity)[body][axis];
    });
    return sum;
  }

  /// |z| of the faster root.
  double growth(double dt) const {
    const double p = k_ * dt * dt + c_ * dt - 2;
    const double q = 1 - c_ * dt;
    const std::complex<double> root = std::sqrt(std::complex<double>(p * p - 4 * q));
    return 0.5 * std::max(std::abs(-p + root), std::abs(-p - root));
  }

 private:
  template <class Visit>
  void each(const Visit& visit) const {
    for (std::int32_t block = 0; block < system_.unknowns.blocks(); ++block)
      for (int axis = 0; axis < 3; ++axis)
        visit(static_cast<std::size_t>(3 * block + axis),
              static_cast<std::size_t>(system_.unknowns.body(block)), axis,
              system_.unknowns.is_rotation(block));
  }

  const System& system_;
  std::vector<double> mode_;
  std::vector<double> alpha_;
  double c_ = 0;
  double k_ = 0;
};

/// |part of the mode| at the start, after half of the steps and at the end, and the largest of all.
struct Course {
  double start = 0, half = 0, end = 0, largest = 0;
};
Course run(const SceneBuilder& unmoved, const LimitMode& mode, double dt, int steps) {
  SceneBuilder builder = unmoved;
  mode.start(builder.scene(), 1e-9, dt);
  Cycle cycle = cycle_of(builder, dt);
  Course course{.start = std::abs(mode.part(cycle.state()))};
  for (int k = 0; k < steps; ++k) {
    cycle.step();
    const double now = std::abs(mode.part(cycle.state()));
    course.largest = std::max(course.largest, now);
    if (k == steps / 2 - 1) course.half = now;
    course.end = now;
  }
  return course;
}

/// 0.1%: grows at 1.001 of the limit as the root says, does not at 0.999.
void expect_limit(const SceneBuilder& builder, const char* what) {
  const System s(builder);
  const Truth truth = truth_of(s);
  EXPECT_LT(truth.limit_residual, 1e-8);
  const LimitMode mode(s, truth);
  EXPECT_NEAR(mode.growth(truth.limit), 1, 1e-7);  // a double root without dashpots: the root of rounding

  // Long enough to grow by 1e5; strong dashpots leave 0.002 a step.
  const double rate = std::log(mode.growth(1.001 * truth.limit));
  const int steps = 2 * static_cast<int>(0.5 * std::log(1e5) / rate + 1);
  const Course above = run(builder, mode, 1.001 * truth.limit, steps);
  const Course below = run(builder, mode, 0.999 * truth.limit, steps);
  const double measured = std::log(above.end / above.half) / (steps - steps / 2);
  std::printf(
      "%s: limit %.4f of the undamped; e^%.5f a step above (theory %.5f), %.1e after %d steps below\n", what,
      truth.limit / truth.dt, measured, rate, below.end / below.start, steps);
  // The other root, which starts as strong, is gone by half of the time; of what ends by overlaps and
  // rounding 1e-5 is left.
  EXPECT_NEAR(measured / rate, 1, 2e-3) << what;
  // Without dashpots it swings up to 22.4 times the start (limit_test.cpp), with them it dies out.
  EXPECT_LT(below.largest, 22.4 * below.start) << what;
  if (!s.damping.empty()) {
    EXPECT_LT(below.end, 0.1 * below.start) << what;
  }
}

TEST(DampedTruth, IsTheLargestRootOfTheDenseQuadraticProblem) {
  std::mt19937_64 random(11);
  std::uniform_real_distribution<double> uniform(0, 1);
  double worst = 0;
  for (int scene = 0; scene < 60; ++scene) {
    SceneBuilder builder = random_cluster(random, 3 + scene % 8, {}, 2, 0.2);
    builder.scene().contacts =
        damped_scene(0.7 * uniform(random), {2 * uniform(random), uniform(random)}).scene().contacts;
    if (scene % 3 > 0) mix(builder, static_cast<std::uint64_t>(scene));
    const System s(builder);
    if (s.elements.empty() || s.unknowns.free_components().empty()) continue;
    const Truth truth = truth_of(s);
    if (!std::isfinite(truth.limit)) continue;
    worst = std::max(worst, std::abs(truth.limit / dense_limit(s) - 1));
    EXPECT_TRUE(truth.certified);
    EXPECT_LE(truth.limit_proof.dt, truth.limit);
    EXPECT_GT(truth.limit_proof.dt, truth.limit * (1 - 1e-6));
  }
  std::printf("largest relative difference from the companion matrix: %.1e\n", worst);
  EXPECT_LT(worst, 1e-10);  // residuals of 1e-10 and unsymmetric dense eigenvalues
}

TEST(DampedTruth, OfOneModeIsItsClosedForm) {
  for (const double beta : {0.0, 0.01, 0.5, 2.0})
    for (const double alpha : {0.0, 0.4, 0.8}) {
      SceneBuilder builder = damped_scene(0, {beta, 0});
      builder.ball({0, 0, 1 - 1e-9}).plane({0, 0, 0}, {0, 0, 1}).damped(alpha);
      const double expected = 2 * (std::sqrt(beta * beta + 1 / (1 + alpha)) - beta);
      EXPECT_NEAR(truth_of(System(builder)).limit / expected, 1, 1e-12) << beta << " " << alpha;
    }
}

// Eq. 1.35 (tests/bench/damped_limits.py prints more) for two equal balls, k_s = ½: the mode across n with
// both rolling has k/m = 7 k_s, c/m = 7 c_s, c_s = 2β√(½ k_s); the rule takes √(I/(R² k_s)) F(β) of it. Safe
// at rest (0.84), it is 1.38 times the limit at β = 1, and 1.81 with α = 0.8 beside it.
TEST(DampedTruth, IsBelowTheRuleOfPfc3dForOnePair) {
  for (const auto& [beta, alpha] : {std::pair{0.0, 0.0}, std::pair{1.0, 0.0}, std::pair{1.0, 0.8}}) {
    SceneBuilder builder = damped_scene(0.5, {beta, beta});
    builder.ball(Vec3::Zero()).ball({2 - 1e-9, 0, 0}).damped(alpha);
    const System s(builder);
    const double a = 1 + alpha;
    const double limit = 2 / (0.5 * (7 * a * beta + std::sqrt(49 * a * a * beta * beta + 14 * a)));
    EXPECT_NEAR(truth_of(s).limit / limit, 1, 1e-8);  // levers are R - ½ 1e-9
    const double rule = cycle::damped_timestep(cycle::diagonal_estimate(s), alpha);
    EXPECT_NEAR(rule / (std::sqrt(0.8) * (std::sqrt(1 + beta * beta) - beta) / std::sqrt(a)), 1, 1e-8);
    EXPECT_EQ(rule > limit, beta > 0);
  }
}

TEST(DampedTruth, WithoutDashpotsIsOverRootOnePlusAlphaExactly) {
  const System s(unstressed_cluster(3, 12, {.kn = 1, .ks = 0.5}, 0.7));
  const Truth truth = truth_of(s);
  EXPECT_EQ(truth.limit, cycle::damped_timestep(truth.dt, 0.7));
  EXPECT_EQ(truth.limit_proof.dt, cycle::damped_timestep(truth.proof.dt, 0.7));
}

// The iteration that larger systems need, against the dense one.
TEST(DampedTruth, IterationAndDenseLinearizationAgree) {
  SceneBuilder small = damped_scene(0.6, {0.3, 0.2});
  mix(with_balls(small, unstressed_places(4, 8)), 5);
  SceneBuilder large = damped_scene(0.6, {0.3, 0.2});
  mix(with_balls(large, unstressed_places(4, 40)), 5);
  const System a(small);
  const System b(large);
  EXPECT_LE(a.unknowns.size(), timestep::dense_unknowns);
  EXPECT_GT(b.unknowns.size(), timestep::dense_unknowns);
  EXPECT_NEAR(truth_of(a).limit / dense_limit(a), 1, 1e-11);
  EXPECT_NEAR(truth_of(b).limit / dense_limit(b), 1, 1e-11);
}

TEST(DampedTruth, OfOneContactIsWhereRunsBeginToGrow) {
  for (const double beta : {0.1, 1.0, 2.0})
    for (const double alpha : {0.0, 0.8}) {
      SceneBuilder builder = damped_scene(0.5, {beta, 0.5 * beta});
      const Vec3 n = Vec3(1, 2, -0.7).normalized();
      builder.ball(Vec3::Zero(), 1, 1).ball(2.5 * (1 - 1e-12) * n, 1.5, 3).damped(alpha);
      expect_limit(builder, "pair");
    }
}

TEST(DampedTruth, OfAPairWithTwoAlphasIsWhereRunsBeginToGrow) {
  for (const double beta : {0.0, 0.5, 2.0}) {
    SceneBuilder builder = damped_scene(0.5, {beta, 0.3 * beta});
    const Vec3 n = Vec3(1, 2, -0.7).normalized();
    builder.ball(Vec3::Zero(), 1, 1).ball(2.5 * (1 - 1e-12) * n, 1.5, 3).damped_alone(0.8);
    expect_limit(builder, "pair, alpha 0 and 0.8");
  }
}

TEST(DampedTruth, OfAChainIsWhereRunsBeginToGrow) {
  for (const double beta : {0.0, 0.3, 2.0})
    for (const double alpha : {0.0, 0.8}) {
      SceneBuilder builder = damped_scene(0.4, {beta, 0.5 * beta});
      const Vec3 n = Vec3(1, 1, 1).normalized();
      for (int i = 0; i < 40; ++i) builder.ball(2 * i * (1 - 1e-13) * n);
      expect_limit(builder.damped(alpha), "chain of 40");
    }
}

TEST(DampedTruth, OfAMixedChainIsWhereRunsBeginToGrow) {
  SceneBuilder builder = damped_scene(0.4, {0.1, 0.4}, {{1.0, 0.2}, {2.0, 0}});
  for (int i = 0; i < 40; ++i) builder.ball({2 * i * (1 - 1e-13), 0, 0});
  mix(builder, 8);
  expect_limit(builder, "chain of 40, all mixed");
}

TEST(DampedTruth, OfAPackingIsWhereRunsBeginToGrow) {
  const PlacedBalls places = unstressed_places(21, 220, 30);
  for (const auto& [beta, alpha] : {std::pair{0.2, 0.0}, std::pair{0.5, 0.8}, std::pair{2.0, 0.8}}) {
    SceneBuilder builder = damped_scene(0.6, {beta, 0.5 * beta});
    expect_limit(with_balls(builder, places).damped(alpha), "220 balls");
  }
}

TEST(DampedTruth, OfAMixedPackingIsWhereRunsBeginToGrow) {
  const PlacedBalls places = unstressed_places(22, 220, 30);
  for (const double strength : {0.0, 0.1, 1.0}) {
    SceneBuilder builder =
        damped_scene(0.6, {0.1 * strength, 0.5 * strength}, {{strength, 0}, {2 * strength, 0.2 * strength}});
    mix(with_balls(builder, places), 9);
    expect_limit(builder, "220 balls, all mixed");
  }
}

/// Σ F·x/2 of the springs is no norm of floppy modes; velocities are looked at without them: largest relative
/// velocity of two balls in contact.
double strain_rate(const assembly::State& state) {
  double most = 0;
  const model::Bodies& bodies = state.model.bodies;
  for (const contact::ContactElement& e : assembly::contact_elements(state.model)) {
    const auto at = [&](std::int32_t body, const Vec3& lever) -> Vec3 {
      const auto i = static_cast<std::size_t>(body);
      return bodies.velocity[i] + bodies.spin[i].cross(lever);
    };
    most = std::max(most, (at(e.b, e.lever_b) - at(e.a, e.lever_a)).norm());
  }
  return most;
}

// That runs grow above the limit is a theorem for mixed α too (docs/theory.md). That nothing grows below it
// is not: random starts, of which no component need be on the side that the mode of the limit would have it.
TEST(DampedTruth, NothingGrowsBelowItFromRandomStarts) {
  std::mt19937_64 random(31);
  std::uniform_real_distribution<double> uniform(0, 1);
  double worst = 0;
  for (int scene = 0; scene < 40; ++scene) {
    const double strength = scene % 4 == 0 ? 0 : 2 * uniform(random);
    SceneBuilder builder = damped_scene(uniform(random), {strength, uniform(random) * strength},
                                        {{strength * uniform(random), 0}, {0, strength * uniform(random)}});
    mix(with_balls(builder, unstressed_places(random(), 3 + scene % 10)), random());
    const double dt = 0.999 * truth_of(System(builder)).limit;
    for (std::size_t i = 0; i < builder.scene().bodies.position.size(); ++i) {
      builder.scene().bodies.velocity.emplace_back(1e-9 * random_vector(random) / dt);
      builder.scene().bodies.spin.emplace_back(1e-9 * random_vector(random) / dt);
    }
    Cycle cycle = cycle_of(builder, dt);
    double first = 0;
    double last = 0;
    for (int k = 0; k < 2000; ++k) {
      cycle.step();
      double& most = k < 200 ? first : last;
      if (k < 200 || k >= 1800) most = std::max(most, strain_rate(cycle.state()));
    }
    worst = std::max(worst, last / first);
  }
  std::printf("after 2000 steps at most %.1e of the first 200\n", worst);
  EXPECT_LT(worst, 1);
}

}  // namespace
}  // namespace eigengrain::test
