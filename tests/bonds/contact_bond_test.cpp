// The contact bond: springs that pull and do not slip up to their strengths, and the linear law afterwards.
#include "eigengrain/assembly/bonds.hpp"
#include "eigengrain/assembly/tangent.hpp"

#include "support/bonds.hpp"
#include "support/laws.hpp"
#include "support/motion.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <iterator>
#include <limits>
#include <random>

namespace eigengrain::test {
namespace {

using contact::BreakMode;
using contact::ContactBond;
using contact::ContactForce;
using contact::ContactMotion;

constexpr double infinity = std::numeric_limits<double>::infinity();
const Vec3 n = Vec3::UnitZ();

ContactBond law(double tension, double shear, double friction = 0.3) {
  std::vector<double> values = values_of("linear", {{"kn", 2}, {"ks", 1.5}, {"friction", friction}});
  values.insert(values.end(), {tension, shear});
  return ContactBond::from_values(values);
}
ContactBond::State glued(const ContactBond& bond) {
  return bond.bond({.geometry = {n, 0, n, -n, 0.5}, .radius_a = 1, .radius_b = 1});
}
model::BondRule rule(double tension, double shear, double gap = 1e-9) {
  return {.kind = "contact", .parameters = {tension, shear}, .gap = gap};
}

TEST(ContactBond, PullsUpToItsStrengthAndThenNoMore) {
  const ContactBond bond = law(1.0, infinity);
  ContactBond::State next;
  const ContactMotion before{.normal = n, .overlap = -0.5 + 1e-12};
  EXPECT_NEAR(bond.evaluate(before, glued(bond), next).force.z(), -1, 1e-11);
  EXPECT_TRUE(next.bonded());
  const ContactMotion after{.normal = n, .overlap = -0.5};
  EXPECT_EQ(bond.failure(after, glued(bond)), BreakMode::tension);
  EXPECT_EQ(bond.evaluate(after, glued(bond), next).force, Vec3(0, 0, 0));
  EXPECT_FALSE(next.bonded());
  EXPECT_FALSE(bond.acts(after, next));
  EXPECT_EQ(bond.energy(after, glued(bond)), 0.0);
}

TEST(ContactBond, BrokenByShearItSlips) {
  const ContactBond bond = law(infinity, 0.9);
  ContactBond::State next;
  const auto sheared = [](double by) {
    return ContactMotion{.normal = n, .overlap = 0.5, .displacement = {by, 0, 0}};
  };
  // Far outside of the cone of μ F_n = 0.3.
  EXPECT_NEAR(bond.evaluate(sheared(0.59), glued(bond), next).force.x(), -0.885, 1e-15);
  EXPECT_TRUE(next.bonded());
  const ContactForce slipping = bond.evaluate(sheared(0.61), glued(bond), next);
  EXPECT_FALSE(next.bonded());
  EXPECT_NEAR(slipping.force.x(), -0.3, 1e-15);
  EXPECT_NEAR(slipping.force.z(), 1, 1e-15);
}

TEST(ContactBond, BrokenByShearWithinTheConeItKeepsItsForces) {
  const ContactBond bond = law(infinity, 0.2);
  ContactBond::State next;
  const ContactForce f =
      bond.evaluate({.normal = n, .overlap = 0.5, .displacement = {0.15, 0, 0}}, glued(bond), next);
  EXPECT_FALSE(next.bonded());
  EXPECT_NEAR(f.force.x(), -0.225, 1e-15);
}

TEST(ContactBond, BrokenByShearWhileItPullsItIsOpen) {
  const ContactBond bond = law(infinity, 0.2);
  ContactBond::State next;
  const ContactMotion motion{.normal = n, .overlap = -0.1, .displacement = {0.15, 0, 0}};
  EXPECT_EQ(bond.failure(motion, glued(bond)), BreakMode::shear);
  EXPECT_EQ(bond.evaluate(motion, glued(bond), next).force, Vec3(0, 0, 0));
}

TEST(ContactBond, HoldsShearWithoutFriction) {
  const ContactBond bond = law(infinity, infinity, 0);
  EXPECT_TRUE(bond.needs_rotation());
  EXPECT_EQ(bond.stiffness({.normal = n}, glued(bond)).shear, 1.5);
  EXPECT_EQ(bond.stiffness({.normal = n}, bond.formed(n)).shear, 0.0);
  SceneBuilder builder(Springs{.ks = 0, .tension = false});
  builder.scene().contacts[0].parameters[1] = 0.5;  // k_s, friction zero
  builder.ball({0, 0, 0}).ball({2, 0, 0});
  EXPECT_FALSE(cycle::start(builder.scene()).turns());
  EXPECT_TRUE(cycle::start(builder.bonded(rule(1, 1)).scene()).turns());
}

TEST(ContactBond, UnbondedItIsTheLinearLaw) {
  // Balls that fly into each other from where nothing touches: no bond is made, then or later.
  std::mt19937_64 random(1);
  SceneBuilder builder(Springs{.kn = 1, .ks = 0.5, .tension = false});
  for (int corner = 0; corner < 8; ++corner) {
    const Vec3 x = 1.1 * Vec3(corner % 2 * 2 - 1, corner / 2 % 2 * 2 - 1, corner / 4 * 2 - 1);
    builder.ball(x).moving(-0.01 * x + 1e-3 * random_vector(random));
  }
  const auto run = [](SceneBuilder scene) {
    cycle::Cycle cycle = cycle_of(std::move(scene), 0.1);
    cycle.run(120);
    return cycle.release();
  };
  const assembly::State plain = run(builder);
  const assembly::State unbonded = run(SceneBuilder(builder).bonded(rule(1, 1, 0)));
  EXPECT_EQ(assembly::count_bonds(unbonded.model), 0);
  EXPECT_GT(std::ssize(shears_of(plain)), 5);
  // The law alone is evaluated several contacts at a time, which rounds differently: some 120 steps of 1e-16,
  // carried on by their motion.
  for (std::size_t i = 0; i < 8; ++i) {
    EXPECT_LT((positions_of(plain)[i] - positions_of(unbonded)[i]).norm(), 1e-13);
    EXPECT_LT((plain.model.bodies.spin[i] - unbonded.model.bodies.spin[i]).norm(), 1e-13);
  }
}

TEST(ContactBond, TangentIsTheDerivativeOfTheForces) {
  std::mt19937_64 random(2);
  for (int scene = 0; scene < 5; ++scene) {
    assembly::Model model = random_cluster(random, 5, {.kn = 1, .ks = 0.6, .tension = false})
                                .bonded(rule(infinity, infinity))
                                .build();
    ASSERT_GE(assembly::count_bonds(model), 4);
    // Some shear and some tension, committed.
    assembly::Displacement d = no_displacement(model);
    for (std::size_t i = 0; i < d.translation.size(); ++i) {
      d.translation[i] = 1e-2 * random_vector(random);
      d.rotation[i] = 1e-2 * random_vector(random);
      model.bodies.position[i] += d.translation[i];
    }
    assembly::BodyForces sum;
    assembly::ContactForceSum(model, true)
        .advance(model, {model.bodies.position, d.translation, d.rotation, 1.0}, sum);
    const assembly::Displacement zero = no_displacement(model);
    DenseTangent sink(model);
    assembly::assemble_tangent(model, {model.bodies.position, zero.translation, zero.rotation, 1.0}, sink);
    // As in tests/verification/tangent_test.cpp: rounding of 1e-9.
    EXPECT_LT((sink.k - numerical_tangent(model)).cwiseAbs().maxCoeff(), 2e-8);
  }
}

TEST(ContactBond, PullsFromTheStartOverAGap) {
  SceneBuilder builder(Springs{.kn = 2, .tension = false});
  builder.ball({0, 0, 0}).ball({2.01, 0, 0}).bonded(rule(infinity, infinity, 0.02));
  EXPECT_NEAR(assembly::contact_forces(builder.build()).force[0].x(), 0.02, 1e-14);
  // Too much of it for a weak bond: broken at the very start, and said so.
  const assembly::State state = cycle::start(builder.bonded(rule(0.01, infinity, 0.02)).scene());
  ASSERT_EQ(state.breaks.size(), 1U);
  EXPECT_EQ(state.breaks[0].mode, BreakMode::tension);
  EXPECT_EQ(state.breaks[0].step, 0);
  EXPECT_EQ(state.force[0], Vec3(0, 0, 0));
}

TEST(ContactBond, HasTheDashpotsOfItsLawThatDoNotCountAgainstIt) {
  std::vector<double> values = values_of("linear", {{"kn", 2}, {"ks", 1.5}, {"beta_n", 0.5}, {"beta_s", 1}});
  values.insert(values.end(), {1.0, infinity});
  ASSERT_FALSE(ContactBond::serves(values));
  ASSERT_TRUE(contact::DampedContactBond::serves(values));
  const auto bond = contact::DampedContactBond::from_values(values);
  const auto held = bond.bond({.geometry = {n, 0, n, -n, 0.5}, .radius_a = 1, .radius_b = 1});
  contact::DampedContactBond::State next;
  // The springs pull with 0.8, below the strength of 1; the dashpots with 2 β √(m k) V, far above it.
  const ContactMotion motion{.normal = n, .overlap = -0.4, .velocity = {3, 0, 5}, .reduced_mass = 2};
  const ContactForce f = bond.evaluate(motion, held, next);
  EXPECT_TRUE(next.bonded());
  EXPECT_NEAR(f.force.z(), -0.8 - 2 * 0.5 * std::sqrt(2 * 2.0) * 5, 1e-14);
  EXPECT_NEAR(f.force.x(), -2 * std::sqrt(2 * 1.5) * 3, 1e-14);
  EXPECT_EQ(bond.damping().normal, 0.5);
}

TEST(ContactBond, CarriesNoMoment) {
  SceneBuilder builder(Springs{.kn = 2, .ks = 1, .tension = false});
  builder.ball({0, 0, 0}).ball({2, 0, 0}).bonded(rule(infinity, infinity));
  const assembly::Model model = builder.build();
  // Rolling without sliding, and twist: neither is resisted.
  assembly::Displacement d = no_displacement(model);
  d.rotation[0] = Vec3(0.01, 0, 0.01);
  d.rotation[1] = Vec3(-0.01, 0, -0.01);
  const assembly::BodyForces f = assembly::contact_forces(model, d);
  EXPECT_LT(f.moment[0].norm() + f.moment[1].norm() + f.force[0].norm(), 1e-15);
}

}  // namespace
}  // namespace eigengrain::test
