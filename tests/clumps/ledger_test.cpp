// The energy ledger of clumps: works and losses against closed forms, and a balance of second order.
#include "support/ledger.hpp"

#include "support/clumps.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>
#include <random>
#include <vector>

namespace eigengrain::test {
namespace {

using assembly::State;
using cycle::Cycle;
using measures::Ledger;

/// A cycle that keeps a ledger from its first step on: before it the step changes, from nothing to dt, which
/// the balance shows (docs/theory.md).
Cycle cycle_counted_after_a_step(SceneBuilder builder, double dt) {
  Cycle cycle = cycle_of(std::move(builder), dt);
  cycle.step();
  return Cycle(with_ledger(cycle.release()), fixed_step(dt));
}

// A clump that falls and turns freely: gravity does m g h, and the rest keeps its energy.
TEST(ClumpLedger, OfAFreeFall) {
  SceneBuilder builder;
  const model::ClumpShape shape = odd_shape();
  builder.clump(shape, {.position = {0, 0, 5}, .velocity = {1, 0, 2}, .spin = {0.3, -0.2, 0.5}});
  builder.scene().gravity = {0, 0, -9.81};
  Cycle cycle = cycle_counted_after_a_step(std::move(builder), 1e-3);
  const double begin = cycle.state().model.bodies.clumps.position[0].z();
  cycle.run(1000);
  const Ledger ledger = measures::ledger_of(cycle.state());
  const double end = cycle.state().model.bodies.clumps.position[0].z();
  const double fallen = begin - end;
  EXPECT_NEAR(ledger.integrals.gravity, shape.mass * 9.81 * fallen,
              1e-11 * std::abs(ledger.integrals.gravity));
  EXPECT_NEAR(ledger.gravitational, shape.mass * 9.81 * end, 1e-10);
  // The splitting of the free rotation keeps its energy to second order: (ω Δt)² of ½ ω·L.
  EXPECT_LT(std::abs(ledger.balance_error), 1e-6 * 0.5 * 0.38 * shape.inertia.maxCoeff());
}

// A constant moment about the axis of a symmetric top, from rest: ω = M t/I, and the work is M θ = ½ I ω².
TEST(ClumpLedger, OfAnAppliedMoment) {
  SceneBuilder builder;
  const model::ClumpShape shape = dumbbell();
  const Vec3 axis = Vec3::UnitX();  // the first principal axis
  builder.clump(shape, {.moment = 0.7 * axis});
  Cycle cycle = cycle_counted_after_a_step(std::move(builder), 1e-2);
  cycle.run(299);
  const Ledger ledger = measures::ledger_of(cycle.state());
  const auto energy_at = [&](int step) {  // ½ I ω²
    const double omega = 0.7 * step * 1e-2 / shape.inertia[0];
    return 0.5 * shape.inertia[0] * omega * omega;
  };
  EXPECT_NEAR(ledger.integrals.applied, energy_at(300) - energy_at(1), 1e-10);
  EXPECT_LT(std::abs(ledger.balance_error), 1e-11);
}

// Prescribed motion: a clump that is held at a velocity against gravity gives back what gravity brings.
TEST(ClumpLedger, OfPrescribedMotion) {
  SceneBuilder builder;
  builder.clump(dumbbell(), {.velocity = {0, 0, -2}, .spin = {0, 1, 0}, .fixed = model::FixedComponents(63)});
  builder.scene().gravity = {0, 0, -9.81};
  Cycle cycle = cycle_with_ledger(std::move(builder), 1e-3);
  cycle.run(500);
  const Ledger ledger = measures::ledger_of(cycle.state());
  EXPECT_NEAR(ledger.integrals.gravity, dumbbell().mass * 9.81 * 1, 1e-10);
  EXPECT_NEAR(ledger.integrals.prescribed, -ledger.integrals.gravity, 1e-10);
  EXPECT_LT(std::abs(ledger.balance_error), 1e-10);
}

/// Clumps of two shapes that fall on each other and on a floor, with all that takes energy from them.
SceneBuilder heap() {
  SceneBuilder builder({.kn = 2e4, .ks = 1e4, .tension = false, .friction = 0.4});
  builder.ball({0.5, 0.5, 24}, 1, 4);
  std::mt19937_64 random(11);
  for (int k = 0; k < 6; ++k)
    builder.clump(k % 2 == 0 ? odd_shape() : dumbbell(), {.position = {0.3 * k, 0.2 * (k % 3), 2.6 + 3.2 * k},
                                                          .orientation = random_orientation(random),
                                                          .velocity = {0, 0, -1},
                                                          .spin = random_vector(random)});
  builder.plane(Vec3::Zero(), Vec3::UnitZ());
  builder.scene().gravity = {0, 0, -9.81};
  builder.scene().local_damping = 0.2;
  builder.scene().bodies.applied_force.assign(static_cast<std::size_t>(builder.scene().bodies.size()),
                                              Vec3::Zero());
  builder.scene().bodies.applied_force[1] = {0.5, 0, 0};  // the holder of the first clump
  return builder;
}

// The balance error of a heap falls by four with the step; its kinks are of either sign, so the mean of four
// refinements is held to it.
TEST(ClumpLedger, OfAHeapIsOfSecondOrder) {
  std::vector<double> errors;
  double passed = 0;
  for (const int fine : {1, 2, 4, 8, 16}) {
    Cycle cycle = cycle_with_ledger(heap(), 2e-3 / fine);
    cycle.run(750 * fine);
    const Ledger ledger = measures::ledger_of(cycle.state());
    EXPECT_GT(ledger.integrals.damping, 0);
    EXPECT_GT(ledger.integrals.contacts.slip, 0);
    passed = ledger.integrals.gravity;
    errors.push_back(std::abs(ledger.balance_error) / passed);
    std::printf("step 2e-3/%d: balance error %.3e of the work of gravity\n", fine, errors.back());
  }
  EXPECT_LT(errors.back(), 1e-4);
  EXPECT_LT(errors.back(), errors.front() / 64);  // 256 at second order
}

TEST(ClumpLedger, CostsNothingOfTheMotion) {
  Cycle plain(cycle::start(heap().scene()), fixed_step(1e-3));
  Cycle counted = cycle_with_ledger(heap(), 1e-3);
  plain.run(500);
  counted.run(500);
  const model::Clumps& a = plain.state().model.bodies.clumps;
  const model::Clumps& b = counted.state().model.bodies.clumps;
  for (std::size_t c = 0; c < a.position.size(); ++c) {
    EXPECT_EQ(a.position[c], b.position[c]);
    EXPECT_EQ(a.angular_momentum[c], b.angular_momentum[c]);
  }
}

}  // namespace
}  // namespace eigengrain::test
