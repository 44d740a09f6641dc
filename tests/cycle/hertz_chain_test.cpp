// The solitary wave that runs along a chain of Hertzian balls (Nesterenko, J. Appl. Mech. Tech. Phys. 24:733,
// 1983), struck at its end by a ball of its own.
#include "support/laws.hpp"
#include "support/motion.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>

namespace eigengrain::test {
namespace {

constexpr int balls = 60;
constexpr int first = 25;  // where the wave is looked at: it has its shape long before
constexpr int last = 45;
constexpr double velocity = 1e-4;  // of the ball that strikes; overlaps are some 1e-4 of the radii then
// F = K U^(3/2) with K = 4/3 E* √R*, R* = 1/2: K = 1, and m = 1.
const double effective_young = 0.75 / std::sqrt(0.5);
// The only time that K, m and the velocity make.
const double unit_time = std::pow(velocity, -0.2);

struct Wave {
  double speed;  ///< balls in a unit of time
  double peak;   ///< greatest velocity of a ball over that of the strike
};

/// Place of the top of a parabola through three values, from the middle one, in steps; and its height.
std::pair<double, double> top_of(double before, double middle, double after) {
  const double slope = 0.5 * (after - before);
  const double bend = before - 2 * middle + after;
  return {-slope / bend, middle - 0.5 * slope * slope / bend};
}

Wave run_chain(double steps_a_unit) {
  const double dt = unit_time / steps_a_unit;
  SceneBuilder builder = with_law("hertz", {{"effective_young", effective_young}});
  for (int k = 0; k < balls; ++k) builder.ball({2.0 * k, 0, 0});
  builder.scene().bodies.velocity.assign(balls, Vec3::Zero());
  builder.scene().bodies.velocity[0].x() = velocity;
  cycle::Cycle cycle = cycle_of(std::move(builder), dt);
  double when[2] = {0, 0};
  Wave wave{};
  double history[2][2] = {{0, 0}, {0, 0}};  // the last two velocities of each of the two balls
  while (when[1] == 0) {
    cycle.step();
    for (int side = 0; side < 2; ++side) {
      const double now = velocity_of(cycle.state(), side == 0 ? first : last).x();
      auto& [before, middle] = history[side];
      if (when[side] == 0 && middle > 0 && now < middle) {
        const auto [place, height] = top_of(before, middle, now);
        when[side] = cycle.state().time + (place - 1) * dt;
        wave.peak = height / velocity;
      }
      before = middle;
      middle = now;
    }
  }
  wave.speed = (last - first) / (when[1] - when[0]) * unit_time;
  return wave;
}

// The reference was integrated with an explicit Runge-Kutta method of order 8 (SciPy's DOP853, tolerance
// 1e-12). Nesterenko's long waves are 0.8% faster: (16/25)^(1/5) (v_peak/v)^(1/5) = 0.84712.
TEST(HertzChain, CarriesASolitaryWaveOfTheRightSpeed) {
  constexpr double speed = 0.840508773;
  constexpr double peak = 0.681631549;
  const Wave coarse = run_chain(50);
  const Wave fine = run_chain(100);
  std::printf("speed %.8f (error %.1e, %.1e at twice the step), peak %.8f (error %.1e, %.1e)\n", fine.speed,
              fine.speed / speed - 1, coarse.speed / speed - 1, fine.peak, fine.peak / peak - 1,
              coarse.peak / peak - 1);
  EXPECT_NEAR(fine.speed / speed, 1, 1e-4);
  EXPECT_NEAR(fine.peak / peak, 1, 1e-4);
  EXPECT_NEAR((coarse.speed / speed - 1) / (fine.speed / speed - 1), 4, 0.2);  // second order
}

}  // namespace
}  // namespace eigengrain::test
