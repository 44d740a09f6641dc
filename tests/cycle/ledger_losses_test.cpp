// What contacts lose, in the energy ledger: against closed forms, and with the error of the balance.
#include "support/laws.hpp"
#include "support/ledger.hpp"
#include "support/motion.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>
#include <numbers>
#include <string>

namespace eigengrain::test {
namespace {

using cycle::Cycle;
using measures::Ledger;
using measures::ledger_of;

/// The ledger of a ball of mass one that hits a floor, in units of the energy that it comes with.
struct Impact {
  double viscous = 0;
  double hysteresis = 0;
  double slip = 0;
  double error = 0;
};

Impact impact_of(SceneBuilder builder, const Vec3& velocity, double dt) {
  builder.ball({0, 0, 1 - 0.3 * dt * velocity.z()}).moving(velocity).plane({0, 0, 0}, {0, 0, 1});
  Cycle cycle = cycle_with_ledger(std::move(builder), dt);
  cycle.run(std::lround(6 / dt));
  EXPECT_GT(position_of(cycle.state(), 0).z(), 1);
  const Ledger ledger = ledger_of(cycle.state());
  EXPECT_EQ(ledger.elastic.total(), 0);
  const double energy = cycle.state().ledger->initial;
  const contact::Dissipation& lost = ledger.integrals.contacts;
  return {lost.viscous / energy, lost.hysteresis / energy, lost.slip / energy, ledger.balance_error / energy};
}

/// Where the contact begins and where it ends within a step the balance errs by up to ⅛k(vΔt)² each, which is
/// ¼Δt² of the energy for k = m = 1; in between it is exact for linear springs and of second order for
/// others.
double allowed_error(double dt) {
  return dt * dt;
}

// The restitution of the cycle itself is of first order in the step, as velocities lag behind by half of it.
TEST(LedgerLoss, DashpotsTakeWhatAnImpactLoses) {
  for (const double beta : {0.05, 0.2, 0.5}) {
    const double e = std::exp(-std::numbers::pi * beta / std::sqrt(1 - beta * beta));
    for (const double dt : {0.1, 0.01, 0.001}) {
      const Impact impact = impact_of(with_law("linear", {{"kn", 1}, {"beta_n", beta}}), {0, 0, -1e-3}, dt);
      std::printf("linear, beta %.2f, step %.3f: viscous loss %.6f of 1 - e2 = %.6f, error %.1e\n", beta, dt,
                  impact.viscous, 1 - e * e, impact.error);
      EXPECT_NEAR(impact.viscous, 1 - e * e, 2 * dt);
      EXPECT_LT(std::abs(impact.error), allowed_error(dt));
    }
  }
}

TEST(LedgerLoss, DashpotsTakeWhatAnImpactOfHertzLoses) {
  for (const double e : {0.4, 0.8})
    for (const double dt : {0.1, 0.01, 0.001}) {
      const Impact impact =
          impact_of(with_law("hertz", {{"effective_young", 30}, {"restitution", e}}), {0, 0, -1e-3}, dt);
      std::printf("hertz, e %.1f, step %.3f: viscous loss %.6f of 1 - e2 = %.6f, error %.1e\n", e, dt,
                  impact.viscous, 1 - e * e, impact.error);
      EXPECT_NEAR(impact.viscous, 1 - e * e, 2 * dt);
      EXPECT_LT(std::abs(impact.error), allowed_error(dt));
    }
}

// What the loading line leaves behind depends on the largest overlap alone, of second order in the step.
TEST(LedgerLoss, TheHystereticSpringTakesWhatAnImpactLoses) {
  for (const double e : {0.3, 0.5, 0.9})
    for (const double dt : {0.1, 0.01, 0.001}) {
      const Impact impact =
          impact_of(with_law("hysteretic", {{"kn", 1}, {"restitution", e}}), {0, 0, -1e-3}, e * dt);
      std::printf("hysteretic, e %.1f, step %.4f: loss %.7f of 1 - e2 = %.7f, error %.1e\n", e, e * dt,
                  impact.hysteresis, 1 - e * e, impact.error);
      EXPECT_NEAR(impact.hysteresis, 1 - e * e, dt * dt);
      EXPECT_LT(std::abs(impact.error), allowed_error(dt));
      EXPECT_EQ(impact.viscous, 0);
    }
}

/// The worst error of the balance of an oblique impact over phases of the step, and its loss by friction.
Impact oblique(const std::string& law, Named named, double dt) {
  Impact worst;
  for (const double more : {0.0, 0.21, 0.43, 0.77}) {
    SceneBuilder builder = with_law(law, named);
    const Impact impact = impact_of(std::move(builder), {2e-3, 0, -1e-3 * (1 + 0.1 * more)}, dt);
    worst.slip += 0.25 * impact.slip;
    worst.error = std::max(worst.error, std::abs(impact.error));
  }
  return worst;
}

// Overlap, shear and slip all change at once, and a part of the shear is there when the contact opens. Of
// linear springs the balance still errs where they begin and end alone; of Hertz's by the rule's Δt².
TEST(LedgerLoss, FrictionOfAnObliqueImpactClosesTheBalance) {
  for (const double dt : {0.08, 0.04, 0.02, 0.01}) {
    const Impact linear = oblique("linear", {{"kn", 1}, {"ks", 0.8}, {"friction", 0.3}}, dt);
    const Impact sticking = oblique("linear", {{"kn", 1}, {"ks", 0.8}, {"friction", 3}}, dt);
    const Impact projected =
        oblique("linear", {{"kn", 1}, {"ks", 0.8}, {"friction", 0.3}, {"projected", 1}}, dt);
    const Impact hertz =
        oblique("hertz", {{"effective_young", 30}, {"effective_shear", 8}, {"friction", 0.3}}, dt);
    const Impact all = oblique("hertz",
                               {{"effective_young", 30},
                                {"effective_shear", 8},
                                {"friction", 0.6},
                                {"restitution", 0.7},
                                {"beta_s", 0.2},
                                {"kr", 0.01},
                                {"rolling_friction", 0.1}},
                               dt);
    std::printf("oblique, step %.2f: errors %.1e linear, %.1e sticking, %.1e hertz, %.1e with all of it\n",
                dt, linear.error, sticking.error, hertz.error, all.error);
    EXPECT_GT(linear.slip, 0.1);
    EXPECT_GT(sticking.slip, 1e-3);
    EXPECT_GT(hertz.slip, 0.1);
    for (const double error : {linear.error, sticking.error, projected.error, hertz.error, all.error})
      EXPECT_LT(error, allowed_error(dt));
  }
}

// A ball that rolls without slipping has 0.7 m u², and all of it goes into its resistance, but for what
// swings in the springs: ½(μ_r m g)²/k_r and as much, 1e-4 of it; and the lever is R - ½U.
TEST(LedgerLoss, RollingResistanceTakesWhatARollingBallHas) {
  constexpr double g = 1e-3;
  constexpr double u = 0.02;
  double last = 0;
  for (const double dt : {0.4, 0.2, 0.1}) {
    SceneBuilder builder = with_law("linear", {{"kn", 1},
                                               {"ks", 0.5},
                                               {"friction", 0.5},
                                               {"kr", 0.1},
                                               {"rolling_friction", 0.05},
                                               {"beta_s", 0.2}});
    builder.ball({0, 0, 1 - g}).moving({u, 0, 0}, {0, u / (1 - g / 2), 0});
    builder.plane({0, 0, 0}, {0, 0, 1}).gravity({0, 0, -g});
    Cycle cycle = cycle_with_ledger(std::move(builder), dt);
    cycle.run(std::lround(800 / dt));
    const Ledger ledger = ledger_of(cycle.state());
    const double energy = cycle.state().ledger->initial - ledger.elastic.normal;
    const contact::Dissipation& lost = ledger.integrals.contacts;
    std::printf("rolling, step %.1f: rolling loss %.5f, viscous %.1e, slip %.1e, error %.1e of 0.7 u2\n", dt,
                lost.rolling / energy, lost.viscous / energy, lost.slip / energy,
                ledger.balance_error / energy);
    EXPECT_LT(ledger.kinetic, 1e-3 * energy);
    EXPECT_NEAR(lost.rolling / (0.7 * u * u), 1, 3e-3);
    EXPECT_LT(std::abs(ledger.balance_error) / energy, 1e-5);
    last = ledger.elastic.rolling;
  }
  EXPECT_GT(last, 0);
  EXPECT_LT(last, 0.51 * std::pow(0.05 * g, 2) / 0.1);
}

}  // namespace
}  // namespace eigengrain::test
