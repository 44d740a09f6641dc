// Bonds between the balls of clumps: total form, in which orientations of balls are those of their clumps.
#include "support/bonds.hpp"

#include "eigengrain/assembly/energies.hpp"
#include "eigengrain/assembly/tangent.hpp"

#include "support/clumps.hpp"
#include "support/motion.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>
#include <random>

namespace eigengrain::test {
namespace {

SceneBuilder bonded_pair(std::mt19937_64& random) {
  SceneBuilder builder = touching_pair({.kn = 1}, random);
  builder.without_law().bonded(Cemented{.kn = 1, .ks = 0.6, .gap = 1e-6}.rule());
  return builder;
}

/// Moves and turns the clumps of a model where they stand.
void deform_clumps(assembly::Model& model, std::mt19937_64& random, double shift, double turn) {
  assembly::Displacement moved = no_displacement(model);
  for (std::int32_t c = 0; c < model.bodies.clumps.size(); ++c) {
    const auto holder = static_cast<std::size_t>(model.bodies.clumps.holder(c));
    moved.translation[holder] = shift * random_vector(random);
    moved.rotation[holder] = turn * random_vector(random);
  }
  const assembly::Displacement of_holders = moved;
  assembly::carry_members(model.bodies, moved);
  model.bodies.orientation = assembly::turned_orientations(model.bodies, moved.rotation);
  assembly::commit_clumps(model.bodies, of_holders);
}

TEST(BondedClumps, HaveTheTangentOfTheirForces) {
  // Under loads of some percent: differences of 1e-6 err by 1e-10 of rounding.
  std::mt19937_64 random(51);
  for (int k = 0; k < 5; ++k) {
    assembly::Model model = bonded_pair(random).build();
    deform_clumps(model, random, 0.05, 0.05);
    const System s(std::move(model));
    ASSERT_EQ(s.elements.size(), 1U);
    UnknownTangent tangent(s.unknowns);
    const std::vector<Vec3> still(static_cast<std::size_t>(s.model.bodies.size()), Vec3::Zero());
    assembly::assemble_tangent(
        s.model, {s.model.bodies.position, still, still, 1.0, s.model.bodies.orientation}, tangent);
    const Eigen::MatrixXd derivative = numerical_stiffness(s, 1e-6);
    EXPECT_LT((derivative - tangent.k).cwiseAbs().maxCoeff(), 1e-8 * derivative.cwiseAbs().maxCoeff());
  }
}

TEST(BondedClumps, KeepTheirEnergyWhileTheyTumble) {
  std::mt19937_64 random(52);
  SceneBuilder builder = bonded_pair(random);
  model::Clumps& clumps = builder.scene().bodies.clumps;
  const Vec3 spin(0.02, 0.01, -0.015);
  for (std::int32_t c = 0; c < 2; ++c) {
    clumps.angular_momentum[static_cast<std::size_t>(c)] = model::angular_momentum(clumps, c, spin);
    clumps.velocity[static_cast<std::size_t>(c)] = spin.cross(clumps.position[static_cast<std::size_t>(c)]);
  }
  cycle::Cycle cycle = cycle_of(builder, 0.2);
  cycle.step();
  const auto energy = [&] {
    const assembly::Energies e = assembly::energies_of(cycle.state());
    return e.kinetic_product + e.elastic;
  };
  const double before = energy();
  const auto deviation = [&](int samples) {
    double most = 0;
    for (int k = 0; k < samples; ++k) {
      cycle.run(47);
      most = std::max(most, std::abs(energy() / before - 1));
    }
    return most;
  };
  const double early = deviation(400);
  cycle.run(200000);
  const double late = deviation(400);
  std::printf("bonded clumps: energy within %.2e, after 200,000 steps within %.2e\n", early, late);
  // Bounded, as a symplectic scheme with forces of a potential has it.
  EXPECT_LT(early, 1e-3);
  EXPECT_LT(late, 1.2 * early);
}

}  // namespace
}  // namespace eigengrain::test
