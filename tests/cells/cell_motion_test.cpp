// The motion of a cell and of bodies in it: closed forms for what is free, and that no result depends on
// which image of a body, or which edges of the lattice, a state happens to hold.
#include "eigengrain/assembly/cell_motion.hpp"

#include "eigengrain/assembly/contact_list.hpp"
#include "eigengrain/assembly/energies.hpp"

#include "cells/support.hpp"
#include "support/clumps.hpp"
#include "support/lattices.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>

namespace eigengrain::test {
namespace {

using assembly::State;
using cycle::Cycle;

// (exp(L Δt) - 1)/Δt where exp is known: L² = 0, diagonal, a rotation, and L² = 1.
TEST(MeanGradient, IsThatOfTheExponential) {
  constexpr double tolerance = 1e-15;
  const Mat3 shear = shear_rate(0, 2, 3);
  EXPECT_EQ(assembly::mean_gradient(shear, 0.7), shear);
  EXPECT_EQ(assembly::mean_gradient(Mat3::Zero(), 0.7), Mat3(Mat3::Zero()));
  for (const double dt : {1e-9, 1e-3, 0.4, 3.0}) {
    const Vec3 rates(1, -2, 0.3);
    const Vec3 wanted(std::expm1(dt) / dt, std::expm1(-2 * dt) / dt, std::expm1(0.3 * dt) / dt);
    const Mat3 found = assembly::mean_gradient(rates.asDiagonal(), dt);
    EXPECT_LT((found - Mat3(wanted.asDiagonal())).norm(), 4 * tolerance * wanted.norm());
    const Mat3 turn = shear_rate(0, 1, -1) + shear_rate(1, 0, 1);
    const double half = std::sin(0.5 * dt);
    const Mat3 turned = (std::sin(dt) * turn + 2 * half * half * turn * turn) / dt;
    EXPECT_LT((assembly::mean_gradient(turn, dt) - turned).norm(), 10 * tolerance * turned.norm());
    const Mat3 swap = shear_rate(0, 1, 1) + shear_rate(1, 0, 1);
    const double half_hyperbolic = std::sinh(0.5 * dt);
    const Mat3 stretched = (std::sinh(dt) * swap + 2 * half_hyperbolic * half_hyperbolic * swap * swap) / dt;
    EXPECT_LT((assembly::mean_gradient(swap, dt) - stretched).norm(), 10 * tolerance * stretched.norm());
  }
}

const Mat3 some_gradient = 0.01 * (Mat3() << 0.3, -0.8, 1.1, 0.4, -0.6, 0.2, -0.9, 0.7, 0.25).finished();

/// Balls that meet nobody, some with fixed components, and a clump.
SceneBuilder scattered() {
  std::mt19937_64 random(6);
  SceneBuilder builder;
  for (int i = 0; i < 20; ++i)
    builder.ball(20 * random_vector(random), 1e-3, 1, i % 3 == 0 ? fix_all : model::FixedComponents{});
  model::ClumpShape pair = given_shape({Vec3(-1e-3, 0, 0), Vec3(1e-3, 0, 0)}, {1e-3, 1e-3}, 2, Vec3::Ones());
  builder.clump(pair, {.position = {4, 5, 6}});
  builder.scene().cell = model::PeriodicCell::box({-3, 2, 1}, {30, 40, 50}, {true, true, true});
  builder.scene().cell.velocity_gradient = some_gradient;
  return builder;
}

// Without forces x - origin = H H_0⁻¹ (x_0 - origin), and H = exp(L t) H_0, whatever the steps are; the
// first starts the flow, and a gradient of zero ends it.
TEST(FreeBodies, MoveAsTheCellDoes) {
  const SceneBuilder builder = scattered();
  SceneBuilder copy = builder;
  std::int64_t calls = 0;
  const cycle::TimestepPolicy changing{[&](const State&) { return ++calls % 2 == 0 ? 0.13 : 0.08; }, 1};
  Cycle cycle(cycle::start(copy.scene()), changing);
  cycle.run(2000);
  State state = cycle.release();
  const model::PeriodicCell start = copy.scene().cell;
  model::PeriodicCell now = state.model.cell;
  EXPECT_GT(state.list.rebuilds, 20);
  // exp(L t) of the whole time in one: 2000 roundings of H against one.
  const Mat3 whole = Mat3::Identity() + state.time * assembly::mean_gradient(some_gradient, state.time);
  std::printf("t = %.3g, stretch %.3g, %lld lists\n", state.time, whole.norm(),
              static_cast<long long>(state.list.rebuilds));
  const Mat3 cells = (whole * start.edges).inverse() * now.edges;
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j) EXPECT_NEAR(cells(i, j), std::round(cells(i, j)), 1e-11);
  const std::vector<Vec3> moved = positions_of(state);
  const std::vector<Vec3> given = copy.scene().bodies.position;
  const assembly::Fluctuation fluctuation(now);
  for (std::size_t i = 0; i < 20; ++i) {
    const Vec3 wanted = start.origin + whole * (given[i] - start.origin);
    EXPECT_LT(apart_in(now, moved[i], wanted), 1e-11 * whole.norm() * 60) << i;
  }
  // Velocities of order one.
  EXPECT_LT(assembly::energies_of(state).kinetic, 1e-20);
  const Vec3 wanted = start.origin + whole * (Vec3(4, 5, 6) - start.origin);
  EXPECT_LT(apart_in(now, state.model.bodies.clumps.position[0], wanted), 1e-11 * whole.norm() * 60);

  state.model.cell.velocity_gradient.setZero();
  Cycle rest(std::move(state), fixed_step(0.1));
  rest.run(1);
  for (const Vec3& v : rest.state().model.bodies.velocity) EXPECT_LT(v.norm(), 1e-11);
  EXPECT_TRUE(rest.state().model.cell.rate.isZero(0));
  EXPECT_FALSE(rest.state().model.cell.deforms());
}

// A free body with a velocity c beside the flow of a steady shear: dc/dt = -L c, c_x loses what x gains.
TEST(FreeBodies, KeepTheirVelocityInSpace) {
  SceneBuilder builder;
  builder.ball({1, 1, 1}, 0.01).moving({0.1, 0.2, 0.3}).periodic(Vec3(7, 8, 9));
  builder.scene().cell.velocity_gradient = shear_rate(0, 2, 0.05);
  Cycle cycle = cycle_of(builder, 0.25);
  // v starts as c + L x, and nothing accelerates it, as L² = 0.
  cycle.run(20);
  const Vec3 velocity = Vec3(0.1, 0.2, 0.3) + Vec3(0.05, 0, 0);
  EXPECT_LT(apart_in(cycle.state().model.cell, position_of(cycle.state(), 0), Vec3(1, 1, 1) + 5 * velocity),
            1e-13);  // ten ulps of the way
}

/// Balls of two sizes on a lattice that they fill, with friction, rolling resistance or dashpots.
SceneBuilder granular(const std::vector<double>& parameters, std::uint64_t seed) {
  std::mt19937_64 random(seed);
  std::uniform_real_distribution<double> uniform(-1, 1);
  SceneBuilder builder;
  builder.scene().contacts.front().parameters = parameters;
  builder.damped(0.2);
  const Lattice lattice = face_centred();
  constexpr int cells = 2;
  for (int i = 0; i < cells; ++i)
    for (int j = 0; j < cells; ++j)
      for (int k = 0; k < cells; ++k)
        for (const Vec3& site : lattice.sites) {
          const double radius = 0.97 + 0.06 * uniform(random);
          builder
              .ball((site + Vec3(i, j, k)).cwiseProduct(lattice.cell) + 0.03 * random_vector(random), radius,
                    radius * radius * radius)
              .moving(0.01 * random_vector(random), 0.01 * random_vector(random));
        }
  builder.periodic(cells * lattice.cell);
  builder.scene().cell.velocity_gradient = 0.3 * some_gradient;
  return builder;
}

/// The same state with other images of its bodies, as if they had been wrapped elsewhere.
State by_other_images(const State& state, std::uint64_t seed) {
  std::mt19937_64 random(seed);
  std::uniform_int_distribution<int> cells(-2, 2);
  State other = state;
  model::Bodies& bodies = other.model.bodies;
  std::vector<Eigen::Vector3i> by;
  for (std::size_t i = 0; i < bodies.position.size(); ++i) {
    const Eigen::Vector3i& k = by.emplace_back(cells(random), cells(random), cells(random));
    bodies.position[i] += state.model.cell.edges * k.cast<double>();
    bodies.velocity[i] += state.model.cell.rate * k.cast<double>();
    other.list.position[i] += state.list.edges * k.cast<double>();
  }
  other.model.contacts.for_each_group([&](auto& group) {
    for (contact::Pair& pair : group.pairs)
      for (int k = 0; k < 3; ++k)
        pair.image[static_cast<std::size_t>(k)] =
            static_cast<std::int8_t>(pair.image[static_cast<std::size_t>(k)] - by[pair.b][k] + by[pair.a][k]);
  });
  return other;
}

/// The same state by edges that slant over one more cell; the next list reduces them again.
State by_other_edges(const State& state) {
  State other = state;
  for (const auto& [along, over] : {std::pair(0, 2), std::pair(2, 1)}) {
    lean_over(other.model.cell, along, over);
    other.list.edges.col(over) += other.list.edges.col(along);
    // N = 1 + e_along e_overᵀ, N⁻¹ = 1 - e_along e_overᵀ
    other.model.contacts.for_each_group([&, along = along, over = over](auto& group) {
      for (contact::Pair& pair : group.pairs)
        pair.image[along] = static_cast<std::int8_t>(pair.image[along] - pair.image[over]);
    });
  }
  return other;
}

struct Difference {
  double way = 0;           ///< of positions
  double acceleration = 0;  ///< in the last step
};

Difference difference_after(const State& first, const State& second, int steps) {
  Cycle a(first, fixed_step(0.1));
  Cycle b(second, fixed_step(0.1));
  a.run(steps);
  b.run(steps);
  Difference found{apart(a.state(), b.state()), 0};
  for (std::int64_t i = 0; i < a.state().model.bodies.size(); ++i)
    found.acceleration =
        std::max(found.acceleration,
                 (a.state().force[row_of(a.state(), i)] - b.state().force[row_of(b.state(), i)]).norm());
  return found;
}

// Rounding alone tells the states apart: an ulp of positions of up to 20 is 4e-15, in a step it makes forces
// of as much (k = 1), and collisions make some ten times more of it each.
TEST(Images, AreAllTheSame) {
  const std::vector<std::vector<double>> laws{
      {1, 0.5, 0.4, 0, 0, 0},                  // friction
      {1, 0, 0, 0, 0, 0},                      // none
      {1, 0.5, 0.4, 0, 0, 0, 0, 0.2, 0.2, 0},  // dashpots
  };
  for (const std::vector<double>& parameters : laws) {
    Cycle cycle = cycle_of(granular(parameters, 7), 0.1);
    cycle.run(300);
    const State& state = cycle.state();
    EXPECT_GT(state.list.rebuilds, 2);
    EXPECT_FALSE(state.model.cell.orthogonal());
    for (const State& other : {by_other_images(state, 8), by_other_edges(state)}) {
      const Difference once = difference_after(state, other, 1);
      const Difference later = difference_after(state, other, 200);
      std::printf("after a step %.1e (forces %.1e), after 200 %.1e (%.1e)\n", once.way, once.acceleration,
                  later.way, later.acceleration);
      EXPECT_LT(once.way, 1e-13);
      EXPECT_LT(once.acceleration, 1e-13);
      EXPECT_LT(later.way, 1e-11);
      EXPECT_LT(later.acceleration, 1e-11);
    }
  }
}

// A ball in contact with its own images alone: nothing pushes it, and the shear spring takes the whole shear
// of the cell. The list is renewed and the cell reduced on the way, which turns the contact round
// (its image lies behind then), and the spring does not notice.
TEST(Images, OfOneBallShearTheirContacts) {
  const auto run = [](double rate) {
    SceneBuilder builder({.kn = 1, .ks = 0.5, .tension = true});
    builder.ball({1, 1, 1}, 1, 1, fix_rotations).periodic(Vec3(8, 8, 1.99));
    builder.scene().cell.velocity_gradient = shear_rate(0, 2, rate);
    Cycle cycle = cycle_of(builder, 0.1);
    cycle.run(2600);
    return cycle.release();
  };
  for (const double sign : {1.0, -1.0}) {
    const double rate = sign * 0.01;
    const State state = run(rate);
    const double strain = rate * state.time;
    EXPECT_NEAR(strain, sign * 2.6, 1e-12);
    EXPECT_GT(state.list.rebuilds, 10);
    // Reduced: the edge would lean by 2.6 of its length over itself, and x is 8 long: 5.17 of 8 becomes
    // -2.83.
    EXPECT_LT(std::abs(state.model.cell.edges(0, 2)), 4.0);
    const std::vector<Vec3> shear = shears_of(state);
    ASSERT_GE(shear.size(), 1U);
    double most = 0;
    for (const Vec3& force : shear) most = std::max(most, force.norm());
    // The branch leans by α, tan α = γ, and the image moves along x by 1.99 dγ, cos α of it across the
    // branch: k_s 1.99 ∫ dγ/√(1 + γ²). The middle of a step of dγ = 1e-3 errs by dγ² of it.
    EXPECT_NEAR(most, 0.5 * 1.99 * std::asinh(2.6), 1e-6);
    EXPECT_NEAR(velocity_of(state, 0).x(), rate * position_of(state, 0).z(), 1e-13);
    EXPECT_LT(state.force[0].norm(), 1e-13);
  }
}

}  // namespace
}  // namespace eigengrain::test
