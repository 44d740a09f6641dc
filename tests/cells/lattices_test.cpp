// Stress and moduli of lattices strained by the motion of their cell, against closed forms: FCC in the table
// of docs/theory.md, SC below. m = 1, R = 1, d = 2.
#include "support/lattices.hpp"

#include "eigengrain/measures/measure.hpp"

#include "cells/support.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>
#include <numbers>

namespace eigengrain::test {
namespace {

using assembly::State;
using cycle::Cycle;

constexpr double kn = 1;
constexpr double ks = 0.6;
constexpr double d = 2;

Mat3 stress_of(const State& state) {
  const std::vector<model::Region> all{{"all", {}}};
  return measures::measure(state.model, all).front().stress;
}

/// A lattice of linear springs after a strain by L t = strain, in ten steps. Each body is a centre of
/// symmetry, so that nothing moves beside the flow.
State strained(const Lattice& lattice, const Mat3& strain, const Springs& springs) {
  SceneBuilder builder = make_lattice(lattice, springs, {2, 2, 2});
  constexpr double dt = 0.1;
  builder.scene().cell.velocity_gradient = strain / (10 * dt);
  Cycle cycle = cycle_of(builder, dt);
  cycle.run(10);
  return cycle.release();
}

Mat3 symmetric(int i, int j, double value) {
  return shear_rate(i, j, 0.5 * value) + shear_rate(j, i, 0.5 * value);
}

struct Moduli {
  double c11 = 0;
  double c12 = 0;
  double c44 = 0;
};

Moduli moduli(const Lattice& lattice, double strain) {
  const Springs springs{.kn = kn, .ks = ks, .tension = true};
  const Mat3 pulled = stress_of(strained(lattice, shear_rate(0, 0, strain), springs));
  const Mat3 sheared = stress_of(strained(lattice, symmetric(0, 2, strain), springs));
  EXPECT_NEAR(pulled(1, 1), pulled(2, 2), 1e-12);
  EXPECT_NEAR(sheared(0, 2), sheared(2, 0), 1e-12);
  return {pulled(0, 0) / strain, pulled(1, 1) / strain, sheared(0, 2) / strain};
}

// Springs that pull and stick are linear but for the turning of branches: the error is of the order of the
// strain, and what is left of two strains when that is taken off is of its square.
void expect_moduli(const Lattice& lattice, const Moduli& wanted) {
  const auto errors = [&](double strain) {
    const Moduli found = moduli(lattice, strain);
    return Vec3(found.c11 - wanted.c11, found.c12 - wanted.c12, found.c44 - wanted.c44);
  };
  const Vec3 coarse = errors(1e-3);
  const Vec3 fine = errors(1e-4);
  const Vec3 extrapolated = (10 * fine - coarse) / 9;
  for (int k = 0; k < 3; ++k) {
    std::printf("%s %s: %.1e at a strain of 1e-3, %.1e at 1e-4, %.1e extrapolated\n", lattice.name.c_str(),
                std::array{"C11", "C12", "C44"}[static_cast<std::size_t>(k)], coarse[k], fine[k],
                extrapolated[k]);
    EXPECT_LT(std::abs(coarse[k]), 3e-3);
    EXPECT_LT(std::abs(fine[k]), 0.11 * std::abs(coarse[k]) + 1e-8);
    // Some 1e-3² of moduli of order one; stresses of 1e-4 are known to 1e-13 of positions.
    EXPECT_LT(std::abs(extrapolated[k]), 1e-6);
  }
}

TEST(Moduli, OfFaceCentredCubic) {
  constexpr double root = std::numbers::sqrt2;
  expect_moduli(face_centred(),
                {root * (kn + ks) / d, root * (kn - ks) / (2 * d), root * (kn + ks) / (2 * d)});
}

// One contact along each axis: along it σ = k_n d ε/d²; across it each side of a cube slips by ½ γ d over
// k_s.
TEST(Moduli, OfSimpleCubic) {
  expect_moduli(simple_cubic(), {kn / d, 0, ks / (2 * d)});
}

// Simple shear is that and a rotation: balls turn with half the vorticity on average, and σ/γ is C44 then.
// From γ to 2γ, so that how it began does not matter. (Spins swing about their mean for good: local damping
// goes by the sign of the spin itself, and takes nothing from swings that are smaller than the mean.)
TEST(Moduli, OfASimpleShearInWhichBallsTurn) {
  for (const auto& [along, over] : {std::pair(0, 2), std::pair(2, 0), std::pair(1, 0)}) {
    SceneBuilder builder = make_lattice(face_centred(), {.kn = kn, .ks = ks, .tension = true}, {2, 2, 2});
    const double rate = 1e-7;
    builder.scene().cell.velocity_gradient = shear_rate(along, over, rate);
    builder.damped(0.5);
    Cycle cycle = cycle_of(builder, 0.1);
    cycle.run(10000);
    const Mat3 before = stress_of(cycle.state());
    Vec3 mean = Vec3::Zero();
    for (int k = 0; k < 10000; ++k) {
      cycle.step();
      for (const Vec3& spin : cycle.state().model.bodies.spin) mean += spin / (32 * 10000);
    }
    const Mat3 change = (stress_of(cycle.state()) - before) / (1e-4);
    const double wanted = std::numbers::sqrt2 * (kn + ks) / (2 * d);
    Vec3 turn = Vec3::Zero();  // curl of v over two
    turn[3 - along - over] = (over - along + 3) % 3 == 1 ? -0.5 * rate : 0.5 * rate;
    const double off = (mean - turn).norm() / turn.norm();
    std::printf("C44 of %d over %d: off by %.1e, antisymmetric %.1e, mean spin off by %.1e\n", along, over,
                change(along, over) / wanted - 1, change(along, over) - change(over, along), off);
    // The strain of 2e-4, and swings of spins by half their mean: k_s times a swing of 1e-7 √(m/k) over 1e-4.
    EXPECT_NEAR(change(along, over), wanted, 1e-3 * wanted);
    EXPECT_NEAR(change(over, along), wanted, 1e-3 * wanted);
    // Not a whole number of swings in 1000 √(m/k).
    EXPECT_LT(off, 5e-3);
  }
}

// FCC has σ = -2√2 F/d² (six contacts in d³/√2), whatever the strain: F = k (2 - d), d = 2 exp(-rate t).
TEST(Compression, RaisesThePressureOfFccAsTheClosedFormSays) {
  SceneBuilder builder = make_lattice(face_centred(), {.kn = 1, .tension = false}, {2, 2, 2});
  builder.scene().cell.velocity_gradient = -1e-3 * Mat3::Identity();
  Cycle cycle = cycle_of(builder, 0.1);
  double last = 0;
  for (int k = 0; k < 10; ++k) {
    cycle.run(50);
    const double spacing = 2 * touching * std::exp(-1e-3 * cycle.state().time);
    const double pressure = 2 * std::numbers::sqrt2 * (2 - spacing) / (spacing * spacing);
    const Mat3 found = stress_of(cycle.state());
    // Overlaps of 0.01 and more of positions of 6, with 50 roundings of the cell to each.
    EXPECT_LT((found + pressure * Mat3::Identity()).norm(), 1e-12);
    EXPECT_GT(pressure, last);
    last = pressure;
    EXPECT_NEAR(cycle.state().model.cell.volume(),
                std::pow(4 * std::sqrt(2.0) * touching, 3) * std::exp(-3e-3 * cycle.state().time), 1e-10);
  }
}

// Without friction the stress is a function of where the cell is, at any strain: -(1/V) Σ F ⊗ ℓ over the six
// branches of a site, carried by exp(L t). Past many lists, in a cell that is reduced on the way.
TEST(Shear, OfALatticeFollowsTheBranches) {
  SceneBuilder builder = make_lattice(face_centred(), {.kn = 1, .tension = true}, {1, 3, 2});
  const double rate = 1e-3;
  builder.scene().cell.velocity_gradient = shear_rate(0, 1, rate);
  Cycle cycle = cycle_of(builder, 0.25);
  const double half = 0.5 * 2 * std::numbers::sqrt2 * touching;
  for (int k = 0; k < 6; ++k) {
    cycle.run(160);
    const double strain = rate * cycle.state().time;
    Mat3 wanted = Mat3::Zero();
    for (const Vec3& at :
         {Vec3(1, 1, 0), Vec3(1, -1, 0), Vec3(1, 0, 1), Vec3(1, 0, -1), Vec3(0, 1, 1), Vec3(0, 1, -1)}) {
      const Vec3 branch = half * (at + strain * at.y() * Vec3::UnitX());
      const double force = 2 - branch.norm();
      wanted -= force * branch.normalized() * branch.transpose();
    }
    wanted /= 2 * half * half * half;  // a site's share: d³/√2
    // Springs that pull act only where they were made, and only between first neighbours.
    EXPECT_LT((stress_of(cycle.state()) - wanted).norm(), 1e-11) << strain;
  }
  EXPECT_NEAR(rate * cycle.state().time, 0.24, 1e-12);
  EXPECT_LT(cycle.state().model.cell.edges(0, 1), 0);  // 0.72 of the edge along x, reduced
  // Balls of radius 1 come nearer by half the strain, twice that is the skin of 0.05: a list lasts for 0.05.
  EXPECT_EQ(cycle.state().list.rebuilds, 4);

  // A gradient is seen as it is by the cell and by regions that reach beyond it, whose images move otherwise.
  const Vec3 corner(-3, -2, 0.3);
  const std::vector<model::Region> regions{{"all", {}},
                                           {"box", model::BoxRegion{corner, corner + Vec3(13, 11, 9)}},
                                           {"sphere", model::SphereRegion{corner, 6.5}}};
  for (const measures::Measure& m : measures::measure(cycle.state().model, regions)) {
    ASSERT_TRUE(m.velocity_gradient.has_value());
    // Positions of ten are moved by 2.5e-4 of their distance in a step, and rounded by an ulp.
    EXPECT_LT((*m.velocity_gradient - shear_rate(0, 1, rate)).norm(), 1e-12);
  }
}

}  // namespace
}  // namespace eigengrain::test
