// A free rigid body: angular momentum, energy, order, and closed forms.
#include "eigengrain/cycle/free_rotation.hpp"

#include "support/clumps.hpp"
#include "support/motion.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <numbers>

namespace eigengrain::test {
namespace {

using cycle::rotate_freely;

struct Body {
  Quat orientation = Quat::Identity();
  Vec3 momentum;
  Vec3 inertia;

  Vec3 own_momentum() const { return orientation.conjugate() * momentum; }
  double energy() const { return 0.5 * own_momentum().cwiseAbs2().cwiseQuotient(inertia).sum(); }
  void run(double dt, std::int64_t steps) {
    for (std::int64_t k = 0; k < steps; ++k)
      orientation = rotate_freely(orientation, momentum, inertia, dt).orientation;
  }
};

/// How far apart two orientations are, rad; q and -q are one.
double angle_between(const Quat& a, const Quat& b) {
  return 2 * std::asin(std::min(1.0, (a.conjugate() * b).vec().norm()));
}

/// Jacobi's sn by descending Landen transformations (Abramowitz and Stegun 16.4).
double jacobi_sn(double u, double k) {
  std::array<double, 24> a{1};
  std::array<double, 24> c{k};
  double b = std::sqrt(1 - k * k);
  std::size_t n = 0;
  while (std::abs(c[n]) > 1e-16 && n + 1 < a.size()) {
    const double mean = 0.5 * (a[n] + b);
    c[n + 1] = 0.5 * (a[n] - b);
    b = std::sqrt(a[n] * b);
    a[++n] = mean;
  }
  double phi = std::ldexp(a[n] * u, static_cast<int>(n));
  for (; n > 0; --n) phi = 0.5 * (phi + std::asin(c[n] / a[n] * std::sin(phi)));
  return std::sin(phi);
}

/// ω_2 of a free body that starts with ω_2 = 0 (Landau and Lifshitz, Mechanics, §37), I_1 < I_2 < I_3 and
/// L² > 2 E I_2.
double exact_spin_2(const Body& start, double t) {
  const Vec3& i = start.inertia;
  const double e2 = 2 * start.energy();
  const double l2 = start.momentum.squaredNorm();
  const double rate = std::sqrt((i[2] - i[1]) * (l2 - e2 * i[0]) / (i[0] * i[1] * i[2]));
  const double k2 = (i[1] - i[0]) * (e2 * i[2] - l2) / ((i[2] - i[1]) * (l2 - e2 * i[0]));
  return std::sqrt((e2 * i[2] - l2) / (i[1] * (i[2] - i[1]))) * jacobi_sn(rate * t, std::sqrt(k2));
}

const Vec3 asymmetric(1.0, 1.7, 2.4);

/// Turns mostly about axis 3, and a little about 1.
Body tumbling() {
  return {Quat::Identity(), Vec3(0.5, 0, 2.0), asymmetric};
}

TEST(FreeRotation, OfASymmetricTopIsExact) {
  // The axis of the top and the body about it: q(t) = exp(L t/I) q_0 exp(π_3 (1/I_3 - 1/I) t e_3). Each of
  // the steps rounds the orientation by some 1e-16; after 10,000 that is 1e-14 of π_3, and times t = 3000 s
  // the angle.
  for (const double third : {0.4, 3.0}) {
    for (int axis = 0; axis < 3; ++axis) {
      Vec3 inertia(1.3, 1.3, 1.3);
      inertia[axis] = third;
      Body body{Quat(Eigen::AngleAxisd(0.7, Vec3(1, 2, -1).normalized())), Vec3(0.3, -1.1, 0.8), inertia};
      const double own = body.own_momentum()[axis] * (1 / third - 1 / 1.3);
      constexpr double dt = 0.3;  // some 0.3 rad a step: a coarse one does not matter
      constexpr int steps = 10000;
      const Quat start = body.orientation;
      body.run(dt, steps);
      const double t = dt * steps;
      const Vec3 space = body.momentum / 1.3;
      const Quat exact = Quat(Eigen::AngleAxisd(space.norm() * t, space.normalized())) * start *
                         Quat(Eigen::AngleAxisd(own * t, Vec3::Unit(axis)));
      EXPECT_LT(angle_between(body.orientation, exact), 1e-9) << third << ' ' << axis;
    }
  }
}

TEST(FreeRotation, OfASphereIsThatOfItsSpinVector) {
  const Vec3 momentum(0.2, -0.4, 1);
  const cycle::FreeRotation turn = rotate_freely(Quat::Identity(), momentum, Vec3::Constant(2), 0.1);
  EXPECT_EQ(turn.theta, Vec3(0.1 * 0.5 * momentum));
}

TEST(FreeRotation, GivesItsTurnAsQuaternionAndVector) {
  const Body body = tumbling();
  for (const double dt : {1e-9, 1e-3, 1.0}) {
    const cycle::FreeRotation turn = rotate_freely(body.orientation, body.momentum, body.inertia, dt);
    EXPECT_LT(((turn.turn * body.orientation).coeffs() - turn.orientation.coeffs()).norm(), 1e-15);
    const double angle = turn.theta.norm();
    const Quat again(Eigen::AngleAxisd(angle, turn.theta / angle));
    // To digits of its own size: the difference of the vector parts over the angle.
    EXPECT_LT((again.vec() - turn.turn.vec()).norm(), 4e-16 * std::max(angle, 1e-300)) << dt;
  }
}

TEST(FreeRotation, OfAnAsymmetricBodyIsOfSecondOrder) {
  const Body start = tumbling();
  ASSERT_GT(start.momentum.squaredNorm(), 2 * start.energy() * start.inertia[1]);
  constexpr double t = 20;
  std::vector<double> error;
  for (const int steps : {400, 800, 1600, 3200}) {
    Body body = start;
    body.run(t / steps, steps);
    error.push_back(std::abs(body.own_momentum()[1] / body.inertia[1] - exact_spin_2(start, t)));
  }
  EXPECT_LT(error.back(), 1e-5);
  for (std::size_t k = 1; k < error.size(); ++k)
    EXPECT_NEAR(std::log2(error[k - 1] / error[k]), 2, 0.02) << error[k];
}

TEST(FreeRotation, GoesBackTheWayItCame) {
  Body body = tumbling();
  const Quat start = body.orientation;
  body.run(0.05, 10000);
  EXPECT_GT(angle_between(body.orientation, start), 0.1);
  body.momentum = -body.momentum;
  body.run(0.05, 10000);
  EXPECT_LT(angle_between(body.orientation, start), 1e-10);  // 20,000 roundings of 1e-16, that grow with t
}

/// The largest deviation of the energy over some steps, relative.
double deviation(Body& body, double energy, double dt, int steps) {
  double most = 0;
  for (int k = 0; k < steps; ++k) {
    body.run(dt, 1);
    most = std::max(most, std::abs(body.energy() / energy - 1));
  }
  return most;
}

TEST(FreeRotation, KeepsTheEnergyBoundedOverAMillionSteps) {
  std::array<double, 2> bound{};
  for (const int half : {0, 1}) {
    Body body = tumbling();
    const double energy = body.energy();
    const double dt = half == 0 ? 0.1 : 0.05;
    const double early = deviation(body, energy, dt, 10000);
    body.run(dt, 980000);
    const double late = deviation(body, energy, dt, 10000);
    bound[static_cast<std::size_t>(half)] = early;
    EXPECT_NEAR(late / early, 1, 0.01);  // the largest of so many phases is nearly the same
    // The orientation has stayed a rotation: two Newton steps' worth of an ulp.
    EXPECT_NEAR(body.orientation.squaredNorm(), 1, 1e-15);
  }
  EXPECT_LT(bound[0], 1e-2);
  EXPECT_NEAR(bound[0] / bound[1], 4, 0.1);  // and of second order
}

TEST(FreeRotation, StaysBoundedWhereTheAxisFlips) {
  // About the middle axis, off by 1e-3: it flips over and back for ever (Dzhanibekov).
  Body body{Quat::Identity(), Vec3(1e-3, 1.7, 0), asymmetric};
  const double energy = body.energy();
  int flips = 0;
  double before = 1;
  double most = 0;
  constexpr double dt = 0.05;
  for (int k = 0; k < 1000000; ++k) {
    body.run(dt, 1);
    most = std::max(most, std::abs(body.energy() / energy - 1));
    const double now = body.own_momentum()[1];
    if (now * before < 0) ++flips;
    before = now;
  }
  EXPECT_LT(most, 1e-3);
  // The time between two flips is 2 K(k)/rate of exact_spin_2, with the roles of 1 and 3 as L² and 2 E I_2
  // have it. Near the separatrix it goes by the logarithm of the smallest number, here 1e-3, which second
  // order shifts by 1e-4: a percent of the time.
  const Vec3& i = body.inertia;
  const double e2 = 2 * energy;
  const double l2 = body.momentum.squaredNorm();
  const double rate = std::sqrt((i[1] - i[0]) * (e2 * i[2] - l2) / (i[0] * i[1] * i[2]));
  const double k2 = (i[2] - i[1]) * (l2 - e2 * i[0]) / ((i[1] - i[0]) * (e2 * i[2] - l2));
  ASSERT_LT(k2, 1);
  const double between = 2 * std::comp_ellint_1(std::sqrt(k2)) / rate;
  EXPECT_NEAR(flips / (1000000 * dt / between), 1, 0.02);
}

TEST(FreeRotation, InTheCycleKeepsMomentumToTheBit) {
  SceneBuilder builder;
  const model::ClumpShape shape = odd_shape();
  builder.clump(shape, {.velocity = {0.1, 0.2, -0.3}, .spin = {0.7, -0.4, 0.2}});
  cycle::Cycle cycle = cycle_of(builder, 0.05);
  const Vec3 momentum = cycle.state().model.bodies.clumps.angular_momentum[0];
  cycle.run(20000);
  const model::Clumps& clumps = cycle.state().model.bodies.clumps;
  EXPECT_EQ(clumps.angular_momentum[0], momentum);
  EXPECT_EQ(clumps.velocity[0], Vec3(0.1, 0.2, -0.3));
}

}  // namespace
}  // namespace eigengrain::test
