// Frequency, order and damping of the cycle against closed forms.
#include "support/motion.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <cstdio>
#include <random>

namespace eigengrain::test {
namespace {

using assembly::State;
using cycle::Cycle;

/// A ball (R = 1, m = 1) on a floor z = 0, pressed into it by `depth`. A plane keeps its normal and the law
/// its slope, so that the motion along z is linear at any amplitude.
SceneBuilder ball_on_floor(const Springs& springs, double depth) {
  return SceneBuilder(springs).ball({0, 0, 1 - depth}).plane({0, 0, 0}, {0, 0, 1});
}

// x'' = -ω²x by leapfrog has the solutions e^{±inθ} with sin(θ/2) = ½ωΔt; from x₀ and v₀ with the half step
// x₁ = x₀ + Δt v₀ - ½Δt²ω²x₀ = x₀ cos θ + Δt v₀, it is x_n = x₀ cos nθ + Δt v₀ sin nθ/sin θ.
TEST(Oscillator, HasTheDiscreteFrequencyOfLeapfrog) {
  constexpr double depth = 0.1;
  constexpr double v0 = 0.03;
  constexpr int steps = 2000;
  for (const double k : {1.0, 7.0})
    for (const double part : {0.1, 0.7, 1.0, 1.5, 1.9}) {
      const double dt = part / std::sqrt(k);  // the limit is at 2
      Cycle cycle = cycle_of(ball_on_floor({.kn = k}, depth).moving({0, 0, v0}), dt);
      const double theta = 2 * std::asin(0.5 * part);
      double error = 0;
      for (int n = 1; n <= steps; ++n) {
        cycle.step();
        const double exact = -depth * std::cos(n * theta) + dt * v0 * std::sin(n * theta) / std::sin(theta);
        error = std::max(error, std::abs(position_of(cycle.state(), 0).z() - 1 - exact));
      }
      // An ulp of z ≈ 1 a step (1e-16) makes, as a random kick of phase, 1e-16 n^1.5 = 1e-11.
      EXPECT_LT(error, 1e-10) << "k " << k << ", step " << part;
    }
}

// The same across the floor: a ball that sways on its contact has ω² = 3.5 k_s/m (docs/theory.md). The floor
// is the same everywhere, so this is linear too.
TEST(Oscillator, SwaysAcrossTheFloorWithThreeAndAHalfTimesTheShearStiffness) {
  constexpr double v0 = 0.03;
  constexpr double ks = 0.6;
  const double omega = std::sqrt(3.5 * ks);
  const double dt = 0.8 / omega;
  const double theta = 2 * std::asin(0.4);
  // Slides without turning at first: the contact point moves with v₀.
  Cycle cycle = cycle_of(ball_on_floor({.kn = 1, .ks = ks}, 1e-14).moving({v0, 0, 0}), dt);
  double error = 0;
  for (int n = 1; n <= 2000; ++n) {
    cycle.step();
    // The force on the ball is -k_s s, s the way of the contact point; its share 2/7 moves the centre.
    const double way = dt * v0 * std::sin(n * theta) / std::sin(theta);
    error = std::max(error, std::abs(cycle.state().force[0].x() + ks * way));
  }
  // Rounding as above; the lever is R - U/2 with U = 1e-14.
  EXPECT_LT(error, 1e-10);
}

/// Slope of log error over log step between neighbours.
void expect_order(const std::vector<double>& error, double order, double tolerance, const char* what) {
  for (std::size_t i = 0; i + 1 < error.size(); ++i) {
    const double observed = std::log2(error[i] / error[i + 1]);
    std::printf("%s: error %.3e, order %.3f\n", what, error[i + 1], observed);
    EXPECT_NEAR(observed, order, tolerance) << what << ", refinement " << i;
  }
}

// A velocity at t = 0 becomes one at the half step by half a kick. A scheme that takes it as it is (as one
// does that believes it to be of t - Δt/2) errs by ½Δt a₀ in the velocity: first order.
TEST(Oscillator, StartsAtSecondOrder) {
  constexpr double depth = 0.1;
  constexpr double v0 = 0.03;
  constexpr double end = 2;
  std::vector<double> with_half_kick;
  std::vector<double> naive;
  for (const int steps : {20, 40, 80, 160}) {
    const double dt = end / steps;
    SceneBuilder builder = ball_on_floor({}, depth).moving({0, 0, v0});
    const auto error = [&](State state) {
      Cycle cycle(std::move(state), fixed_step(dt));
      cycle.run(steps);
      const double exact = 1 - depth * std::cos(end) + v0 * std::sin(end);
      return std::abs(position_of(cycle.state(), 0).z() - exact);
    };
    State state = cycle::start(builder.scene());
    with_half_kick.push_back(error(state));
    state.dt = dt;  // as if a step had been made: the first kick is a whole one
    naive.push_back(error(std::move(state)));
  }
  // Orders differ from 2 and 1 by terms of relative size Δt <= 0.1.
  expect_order(with_half_kick, 2, 0.05, "half kick");
  expect_order(naive, 1, 0.1, "naive start");
}

/// Positions at time 4 of five balls that stick together, turn about each other and vibrate.
std::vector<Vec3> tumbled(const Springs& springs, int steps) {
  std::mt19937_64 random(5);
  SceneBuilder builder = random_cluster(random, 5, springs, 1.3);
  model::Bodies& bodies = builder.scene().bodies;
  for (int i = 0; i < 5; ++i) {
    bodies.velocity.push_back(0.1 * random_vector(random));
    bodies.spin.push_back(0.2 * random_vector(random));
  }
  Cycle cycle = cycle_of(builder, 4.0 / steps);
  cycle.run(steps);
  return positions_of(cycle.state());
}

double distance(const std::vector<Vec3>& a, const std::vector<Vec3>& b) {
  double sum = 0;
  for (std::size_t i = 0; i < a.size(); ++i) sum += (a[i] - b[i]).squaredNorm();
  return std::sqrt(sum);
}

/// Differences of results with steps halved again and again.
std::vector<double> differences(const Springs& springs) {
  std::vector<double> result;
  std::vector<Vec3> before = tumbled(springs, 40);
  for (const int steps : {80, 160, 320, 640, 1280}) {
    std::vector<Vec3> now = tumbled(springs, steps);
    result.push_back(distance(before, now));
    before = std::move(now);
  }
  return result;
}

// A whole cluster with shear and large rotations: self-convergence, no exact solution needed.
TEST(Cycle, IsOfSecondOrderWithoutShear) {
  expect_order(differences({.kn = 1, .ks = 0}), 2, 0.1, "no shear");
}

TEST(Cycle, IsOfSecondOrderWithShearCarriedThroughMidStep) {
  expect_order(differences({.kn = 1, .ks = 0.5}), 2, 0.1, "mid-step");
}

// PFC3D's geometry at the end of the step makes spurious shear of size Δt² a step: first order.
TEST(Cycle, IsOfFirstOrderWithGeometryAtTheEndOfTheStep) {
  expect_order(differences({.kn = 1, .ks = 0.5, .end_step = true}), 1, 0.2, "end of step");
  expect_order(differences({.kn = 1, .ks = 0.5, .small_angle = true, .end_step = true}), 1, 0.2,
               "end of step, small angle");
}

/// Highest and lowest places, one after the other, of a height given at every step.
class TurningPoints {
 public:
  void add(double z) {
    if (count_ >= 2 && (last_ - before_) * (z - last_) < 0) found_.push_back(last_);
    before_ = last_;
    last_ = z;
    ++count_;
  }
  const std::vector<double>& found() const { return found_; }

 private:
  std::vector<double> found_;
  double before_ = 0;
  double last_ = 0;
  int count_ = 0;
};

/// Ratios of successive swings about the middle between which they decay, of `balls` on top of each other
/// under gravity that sets in at once. The column is linear at any amplitude; heights are of the mean.
std::vector<double> swing_ratios(int balls, double alpha, double dt) {
  constexpr double g = 1e-3;
  SceneBuilder builder{Springs{}};
  for (int i = 0; i < balls; ++i) builder.ball({0, 0, 1 - 1e-14 + 2 * i * (1 - 1e-14)});
  builder.plane({0, 0, 0}, {0, 0, 1}).gravity({0, 0, -g}).damped(alpha);
  Cycle cycle = cycle_of(builder, dt);
  TurningPoints points;
  double at_rest = 0;  // sinking of the mean in the end: ball i by Σ_j<=i (N - j) g/k, k = 1
  for (int i = 0; i < balls; ++i)
    for (int j = 0; j <= i; ++j) at_rest -= (balls - j) * g / balls;
  while (points.found().size() < 4) {
    double sinking = 0;
    for (int i = 0; i < balls; ++i) sinking += (position_of(cycle.state(), i).z() - 1 - 2 * i) / balls;
    points.add(sinking - at_rest);
    cycle.step();
  }
  std::vector<double> ratios{std::abs(points.found()[0] / at_rest)};
  for (std::size_t i = 0; i + 1 < points.found().size(); ++i)
    ratios.push_back(std::abs(points.found()[i + 1] / points.found()[i]));
  return ratios;
}

// While a ball nears its place of rest the resultant drives it with (1 - α)F, and beyond it resists with
// (1 + α)F: equal work, so A'/A = √((1 - α)/(1 + α)) (PFC3D's eq. 1.47).
TEST(LocalDamping, ShrinksEveryHalfCycleByTheSameRatio) {
  for (const double alpha : {0.2, 0.7}) {
    const double ratio = std::sqrt((1 - alpha) / (1 + alpha));
    for (const double found : swing_ratios(1, alpha, 1e-3)) {
      std::printf("alpha %.1f: ratio %.6f, closed form %.6f\n", alpha, found, ratio);
      // Where the velocity turns, its sign lags by half a step: first order in Δt √(k/m) = 1e-3.
      EXPECT_NEAR(found, ratio, 1e-3);
    }
  }
}

// Three balls on top of each other have three modes, which do not swing together: in the first half cycle
// their mean overshoots by about the ratio of one ball (so says PFC3D's section on damping), at α = 0.2 later
// too.
TEST(LocalDamping, ShrinksTheSwingOfThreeStackedBallsByAboutTheSameRatio) {
  for (const double alpha : {0.2, 0.7}) {
    const double ratio = std::sqrt((1 - alpha) / (1 + alpha));
    const std::vector<double> found = swing_ratios(3, alpha, 1e-2);
    std::printf("three balls, alpha %.1f: ratios %.4f %.4f %.4f, of one ball %.4f\n", alpha, found[0],
                found[1], found[2], ratio);
    EXPECT_NEAR(found[0], ratio, 0.1 * ratio);
    if (alpha < 0.5) {
      EXPECT_NEAR(found[1], ratio, 0.05 * ratio);
    }
  }
}

// In one mode force and velocity have the signs of the mode in every component, so that damping multiplies
// all of them by the same (1 ± α): the mode stays alone, and its half cycles have the ratio of one ball.
TEST(LocalDamping, LeavesAModeOfThreeStackedBallsAlone) {
  for (const double alpha : {0.2, 0.7}) {
    const double ratio = std::sqrt((1 - alpha) / (1 + alpha));
    for (const Eigen::Index mode : {0, 2}) {
      SceneBuilder stack{Springs{}};
      for (int i = 0; i < 3; ++i)  // along z only: free across the stack there is nothing
        stack.ball({0, 0, (1 + 2 * i) * (1 - 1e-12)}, 1, 1, model::FixedComponents(0b111011));
      stack.plane({0, 0, 0}, {0, 0, 1}).damped(alpha);
      const System system(stack);
      const Modes modes(system);
      modes.add_velocity(stack.scene(), mode, 1e-3);
      Cycle cycle = cycle_of(stack, 1e-3);
      TurningPoints points;
      while (points.found().size() < 3) {
        cycle.step();
        points.add(modes.part(cycle.state(), mode));
      }
      // Greatest speeds, where the middle is passed. First order in Δt ω <= 2e-3 as above.
      EXPECT_NEAR(std::abs(points.found()[0]) / 1e-3, ratio, 3e-3) << "mode " << mode;
      EXPECT_NEAR(std::abs(points.found()[1] / points.found()[0]), ratio, 3e-3) << "mode " << mode;
      EXPECT_NEAR(std::abs(points.found()[2] / points.found()[1]), ratio, 3e-3) << "mode " << mode;
    }
  }
}

}  // namespace
}  // namespace eigengrain::test
