// The load at which a parallel bond breaks, against -F_n/A + |M_s| R/I and |F_s|/A + |M_n| R/J, by pulling,
// shearing, bending and twisting one of two balls in the cycle until the bond is gone.
#include "eigengrain/assembly/bonds.hpp"

#include "support/bonds.hpp"
#include "support/motion.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>
#include <numbers>
#include <utility>

namespace eigengrain::test {
namespace {

using contact::BreakMode;

constexpr double pi = std::numbers::pi;
constexpr double tensile_strength = 1e-3;
constexpr double shear_strength = 2e-3;

struct Break {
  assembly::BondBreak event;
  Vec3 force;   ///< on the moved ball in the last step that the bond held, N
  Vec3 moment;  ///< about the contact point, N m
};

/// Moves and turns ball 1 of a pair along z steadily until the bond breaks; ball 0 is held.
Break driven(const Vec3& velocity, const Vec3& spin, bool incremental = false) {
  SceneBuilder pair;
  pair.ball({0, 0, 0}, 1, 1, fix_all).ball({0, 0, 2}, 1, 1, fix_all).moving(velocity, spin).without_law();
  pair.bonded(Cemented{
      .kn = 1, .ks = 0.5, .tension = tensile_strength, .shear = shear_strength, .incremental = incremental}
                  .rule());
  cycle::Cycle cycle = cycle_of(pair, 1.0);
  Break result{};
  for (int step = 0; step < 100000; ++step) {
    const std::size_t moved = row_of(cycle.state(), 1);
    result.force = cycle.state().force[moved];
    result.moment = cycle.state().moment[moved] - Vec3(0, 0, -1).cross(result.force);
    cycle.step();
    const auto breaks = cycle.take_breaks();
    if (breaks.empty()) continue;
    EXPECT_EQ(breaks.size(), 1U);
    result.event = breaks.front();
    EXPECT_EQ(cycle.state().force[moved], Vec3(0, 0, 0));
    EXPECT_EQ(assembly::count_bonds(cycle.state().model), 0);
    return result;
  }
  ADD_FAILURE() << "it never broke";
  return result;
}

// Each is driven at 1e-6 a step to some 3e-3 of deformation φ: the last load is a step, 3e-4, below the
// strength, and in bending the straight way of the centre stretches the bond by ¼φ², 0.8e-3 of it.
void expect_just_below(double load, double strength, const char* what) {
  std::printf("%-28s broke beyond %.6f of its strength\n", what, load / strength);
  EXPECT_LT(load, strength * (1 + 1e-12)) << what;
  EXPECT_GT(load, strength * (1 - 2e-3)) << what;
}

TEST(Strength, InTensionIsSigmaTimesA) {
  for (const bool incremental : {false, true}) {
    const Break found = driven({0, 0, 1e-6}, Vec3::Zero(), incremental);
    expect_just_below(-found.force.z(), tensile_strength * pi, "tension");
    EXPECT_EQ(found.event.mode, BreakMode::tension);
    // Where it was, and when: k̄_n δ = σ, k̄_n = 1/π.
    EXPECT_EQ(found.event.first, 0);
    EXPECT_EQ(found.event.second, 1);
    EXPECT_EQ(found.event.rule, 0);
    EXPECT_NEAR(static_cast<double>(found.event.step), tensile_strength * pi / 1e-6, 1);
    EXPECT_EQ(found.event.time, static_cast<double>(found.event.step));
    EXPECT_NEAR(found.event.place.z(), 1 + 0.5 * tensile_strength * pi, 1e-6);
    EXPECT_NEAR(found.event.normal.z(), 1, 1e-15);
  }
}

TEST(Strength, InShearIsTauTimesA) {
  // Neither ball turns, so that the two ends slide on each other and the bond is not bent.
  for (const bool incremental : {false, true}) {
    const Break found = driven({1e-6, 0, 0}, Vec3::Zero(), incremental);
    // Across n, which has turned a little.
    const Vec3& n = found.event.normal;
    expect_just_below((found.force - found.force.dot(n) * n).norm(), shear_strength * pi, "shear");
    EXPECT_EQ(found.event.mode, BreakMode::shear);
  }
}

TEST(Strength, InBendingIsSigmaTimesIOverR) {
  // Turned about the contact point, so that its ends do not slide: v = -w × R_b with R_b = -z.
  for (const bool incremental : {false, true}) {
    const Break found = driven({0, -1e-6, 0}, {1e-6, 0, 0}, incremental);
    expect_just_below(-found.moment.x(), tensile_strength * pi / 4, "bending");
    EXPECT_EQ(found.event.mode, BreakMode::tension);
  }
}

TEST(Strength, InTorsionIsTauTimesJOverR) {
  for (const bool incremental : {false, true}) {
    const Break found = driven(Vec3::Zero(), {0, 0, 1e-6}, incremental);
    expect_just_below(-found.moment.z(), shear_strength * pi / 2, "torsion");
    EXPECT_EQ(found.event.mode, BreakMode::shear);
  }
}

TEST(Strength, PressureHoldsABentBondTogether) {
  // Pressed by half the strength, bending has to reach one and a half times it.
  SceneBuilder pair;
  pair.ball({0, 0, 0}).ball({0, 0, 2}).without_law();
  pair.bonded(Cemented{.kn = 1, .ks = 0.5, .tension = tensile_strength}.rule());
  const double press = 0.5 * tensile_strength * pi;
  const double bend = 1.5 * tensile_strength * pi;  // κ_s ψ R/I = k̄_n ψ R = ψ/π
  for (const auto& [part, holds] : {std::pair{0.999, true}, std::pair{1.001, false}}) {
    assembly::Model model = pair.build();
    const double half = std::asin(0.5 * part * bend);  // ψ = 2 sin(φ/2), both ends by half of φ
    model.bodies.position[1].z() -= press;
    model.bodies.orientation[0] = contact::turned(model.bodies.orientation[0], Vec3(-half, 0, 0));
    model.bodies.orientation[1] = contact::turned(model.bodies.orientation[1], Vec3(half, 0, 0));
    EXPECT_EQ(assembly::contact_forces(model).force[0].norm() > 0, holds) << part;
  }
}

}  // namespace
}  // namespace eigengrain::test
