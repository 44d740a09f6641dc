// What bonds release when they break, in the energy ledger.
#include "support/bonds.hpp"
#include "support/laws.hpp"
#include "support/ledger.hpp"
#include "support/motion.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>
#include <limits>
#include <numbers>
#include <random>

namespace eigengrain::test {
namespace {

using cycle::Cycle;
using measures::Ledger;
using measures::ledger_of;

constexpr double infinity = std::numeric_limits<double>::infinity();
constexpr double strength = 0.01;  // N, with k = 1: ½F²/k = 5e-5 J
constexpr double speed = 1e-5;

model::BondRule glue(double tension, double shear) {
  return {.kind = "contact", .parameters = {tension, shear}, .gap = 1e-9};
}

/// Two balls of which one is held and one is pulled along x.
SceneBuilder pulled(SceneBuilder builder, const model::BondRule& bond) {
  builder.ball({0, 0, 0}, 1, 1, fix_all).ball({2, 0, 0}, 1, 1, fix_all).moving({speed, 0, 0});
  return builder.bonded(bond);
}

/// A place of 2 is rounded to 2e-16 at each of 10^4 steps, under forces of 0.01.
constexpr double rounding = 3e-14;

// The force is linear in the way: exact. What is released is what was put in, the energy at the strength to
// within a step, of first order.
void expect_release(const SceneBuilder& builder, const char* what) {
  for (const double dt : {1.0, 0.1}) {
    Cycle cycle = cycle_with_ledger(builder, dt);
    while (cycle.take_breaks().empty()) {
      ASSERT_LT(cycle.state().time, 2000) << what;
      cycle.step();
    }
    cycle.run(3);
    const Ledger ledger = ledger_of(cycle.state());
    const double released = ledger.integrals.contacts.bonds;
    std::printf("%s, step %.1f: released %.8f of ½F²/k, error %.1e\n", what, dt,
                released / (0.5 * strength * strength), ledger.balance_error);
    EXPECT_NEAR(released / (0.5 * strength * strength), 1, 2.1 * speed * dt / strength) << what;
    EXPECT_NEAR(ledger.integrals.prescribed, released, rounding) << what;
    EXPECT_LT(std::abs(ledger.balance_error), rounding) << what;
    EXPECT_EQ(ledger.elastic.total(), 0) << what;
  }
}

TEST(LedgerBonds, ReleaseWhatTheyHold) {
  SceneBuilder alone;
  alone.without_law();
  const double stress = strength / std::numbers::pi;
  expect_release(pulled(alone, Cemented{.tension = stress}.rule()), "parallel");
  expect_release(pulled(alone, Cemented{.tension = stress, .incremental = true}.rule()), "incremental");
  expect_release(pulled(SceneBuilder({.kn = 1, .ks = 0.5, .tension = false}), glue(strength, infinity)),
                 "contact");
  const SceneBuilder damped =
      with_law("linear", {{"kn", 1}, {"ks", 0.5}, {"friction", 0.5}, {"beta_n", 0.2}});
  // Dashpots pull beside the bond, and take a part of the work.
  Cycle cycle = cycle_with_ledger(pulled(damped, glue(strength, infinity)), 0.5);
  while (cycle.take_breaks().empty()) cycle.step();
  cycle.run(3);
  const Ledger ledger = ledger_of(cycle.state());
  EXPECT_NEAR(ledger.integrals.contacts.bonds, 0.5 * strength * strength, 1e-3 * strength * strength);
  // c v for the way of 0.01, c = 2 β √(m/2).
  EXPECT_NEAR(ledger.integrals.contacts.viscous, 0.4 * std::sqrt(0.5) * speed * strength,
              2e-3 * speed * strength);
  EXPECT_LT(std::abs(ledger.balance_error), rounding);
}

// Bending by φ: κ_s sin φ is the moment and ½κ_s (2 sin ½φ)² the energy; trapezoidal, with steps of φ.
TEST(LedgerBonds, ReleaseWhatBendingHolds) {
  for (const bool incremental : {false, true}) {
    double last = 0;
    for (const double dt : {4.0, 2.0, 1.0}) {
      SceneBuilder pair;
      pair.ball({0, 0, 0}, 1, 1, fix_all).ball({0, 0, 2}, 1, 1, fix_all);
      pair.moving({1e-4, 0, 0}, {1e-4, 5e-5, 2e-5}).without_law();
      pair.bonded(Cemented{.tension = 0.1, .shear = 0.2, .incremental = incremental}.rule());
      Cycle cycle = cycle_with_ledger(pair, dt);
      while (cycle.take_breaks().empty()) {
        ASSERT_LT(cycle.state().time, 20000);
        cycle.step();
      }
      cycle.run(3);
      const Ledger ledger = ledger_of(cycle.state());
      const double released = ledger.integrals.contacts.bonds;
      const double error = std::abs(ledger.balance_error) / released;
      std::printf("%s, step %.0f: broke at t = %.0f, released %.6e, error %.1e of it\n",
                  incremental ? "incremental" : "total form", dt, cycle.state().time, released, error);
      EXPECT_NEAR(ledger.integrals.prescribed, released, 1e-2 * released);
      EXPECT_EQ(ledger.elastic.total(), 0);
      if (!incremental) {
        EXPECT_LT(error, 1e-6 * dt * dt);
      }
      last = released;
    }
    EXPECT_GT(last, 1e-3);
  }
}

// Broken by shear a contact bond slides on with what its cone leaves; pressed together with F_n = 0.1.
TEST(LedgerBonds, BrokenByShearTheRestIsFriction) {
  SceneBuilder builder({.kn = 1, .ks = 1, .tension = false, .friction = 0.05});
  builder.ball({0, 0, 0}, 1, 1, fix_all).ball({0, 0, 1.9}, 1, 1, fix_all).moving({speed, 0, 0});
  builder.bonded(glue(infinity, strength));
  Cycle cycle = cycle_with_ledger(builder, 1.0);
  while (cycle.take_breaks().empty()) cycle.step();
  const double broken_at = cycle.state().time;
  cycle.run(1000);
  const Ledger ledger = ledger_of(cycle.state());
  // ½(F² - (μF_n)²)/k_s are released, and μF_n goes on over the way.
  EXPECT_NEAR(ledger.integrals.contacts.bonds, 0.5 * (1e-4 - 2.5e-5), 2e-7);
  EXPECT_NEAR(ledger.integrals.contacts.slip, 0.05 * 0.1 * speed * (cycle.state().time - broken_at), 5e-7);
  EXPECT_LT(std::abs(ledger.balance_error), 1e-9);
}

/// A block of bonded balls that is shaken to pieces, and the error of its balance over what it began with.
double error_of_a_block(const model::BondRule& bond, bool damped, double dt) {
  std::mt19937_64 random(5);
  SceneBuilder builder =
      damped
          ? with_law("linear", {{"kn", 1}, {"ks", 0.5}, {"friction", 0.5}, {"beta_n", 0.1}, {"beta_s", 0.1}})
          : SceneBuilder(Springs{.kn = 1, .ks = 0.5, .tension = false});
  constexpr int edge = 6;
  for (int k = 0; k < edge; ++k)
    for (int j = 0; j < edge; ++j)
      for (int i = 0; i < edge; ++i)
        builder.ball(2.0 * Vec3(i + 0.5, j + 0.5, k + 0.5))
            .moving(0.02 * random_vector(random), 0.02 * random_vector(random));
  builder.periodic(Vec3::Constant(2.0 * edge), {true, false, false}).bonded(bond);
  Cycle cycle = cycle_with_ledger(builder, dt);
  cycle.run(std::lround(60 / dt));
  const Ledger ledger = ledger_of(cycle.state());
  const double energy = cycle.state().ledger->initial;
  const double error = ledger.balance_error / energy;
  std::printf("block, %s, step %.2f: %zu broke; bonds %.3f, slip %.3f, viscous %.3f, error %.1e of %.3f J\n",
              bond.kind.c_str(), dt, cycle.take_breaks().size(), ledger.integrals.contacts.bonds / energy,
              ledger.integrals.contacts.slip / energy, ledger.integrals.contacts.viscous / energy, error,
              energy);
  EXPECT_GT(ledger.integrals.contacts.bonds, 0.03 * energy);
  return std::abs(error);
}

// Hundreds of breaks, each in its own phase of the step: no error of first order is left.
TEST(LedgerBonds, OfABlockThatGoesToPiecesCloseTheBalance) {
  for (const double dt : {0.2, 0.1, 0.05}) {
    EXPECT_LT(error_of_a_block(Cemented{.tension = 0.01, .shear = 0.02}.rule(), false, dt), 0.1 * dt * dt);
    EXPECT_LT(error_of_a_block(glue(0.02, 0.02), true, dt), 0.1 * dt * dt);
  }
}

}  // namespace
}  // namespace eigengrain::test
