// Every law inside a model of balls and a wall: the consistent tangent and K are derivatives of the forces of
// the assembly, also of moments between the sides.
#include "eigengrain/assembly/linear_system.hpp"

#include "support/laws.hpp"
#include "support/tangents.hpp"

#include <gtest/gtest.h>

#include <random>
#include <string>
#include <vector>

namespace eigengrain::test {
namespace {

using assembly::Displacement;
using assembly::Model;
using assembly::Trial;

Eigen::MatrixXd tangent_at(const Model& model, const Displacement& at) {
  std::vector<Vec3> position = model.bodies.position;
  for (std::size_t i = 0; i < position.size(); ++i) position[i] += at.translation[i];
  DenseTangent tangent(model);
  assembly::assemble_tangent(model, Trial{position, at.translation, at.rotation, 1.0}, tangent);
  return tangent.k;
}

/// Three balls and a floor that touch each other with some overlap.
SceneBuilder heap(SceneBuilder builder, double overlap) {
  const auto down = [&](double distance) { return distance - overlap; };
  builder.ball({0, 0, down(1)});
  const double slope = down(1.75);
  builder.ball({0.6 * slope, 0, down(1) + 0.8 * slope}, 0.75);
  builder.ball({0.6 * slope - 0.48 * down(1.25), 0.64 * down(1.25), down(1) + 0.8 * slope + 0.6 * down(1.25)},
               0.5);
  return builder.plane({0, 0, 0}, {0, 0, 1});
}

/// Moves the bodies by u, θ and commits.
void commit(Model& model, const Displacement& d) {
  for (std::size_t i = 0; i < d.translation.size(); ++i) model.bodies.position[i] += d.translation[i];
  assembly::BodyForces sum;
  assembly::ContactForceSum(model, true)
      .advance(model, Trial{model.bodies.position, d.translation, d.rotation, 1.0}, sum);
}

/// A motion that presses all together by a little or pulls them apart, shears and rolls.
Displacement motion_of(const Model& model, std::mt19937_64& random, double along, double across) {
  Displacement d = no_displacement(model);
  for (std::size_t i = 0; i < d.translation.size(); ++i) {
    d.translation[i] = Vec3(0, 0, -along * model.bodies.position[i].z()) + across * random_vector(random);
    d.rotation[i] = across * random_vector(random);
  }
  return d;
}

struct Case {
  std::string what;
  SceneBuilder builder;
  double along = 1e-3;  ///< pressed together by this before the tangent
};

std::vector<Case> sticking() {
  return {
      {"linear", with_law("linear", {{"kn", 2}, {"ks", 1}, {"friction", 50}})},
      {"rolling",
       with_law(
           "linear",
           {{"kn", 2}, {"ks", 1}, {"friction", 50}, {"kr", 0.5}, {"rolling_friction", 50}, {"beta_n", 0.3}})},
      // Under shear Hertz's law has a kink between loading and unloading.
      {"hertz",
       with_law("hertz",
                {{"effective_young", 2}, {"restitution", 0.5}, {"kr", 0.5}, {"rolling_friction", 50}})},
      {"hysteretic", with_law("hysteretic", {{"kn", 2}, {"restitution", 0.7}, {"ks", 1}, {"friction", 50}}),
       -1e-3},
  };
}

TEST(LawsInAModel, TheConsistentTangentIsTheDerivativeOfTheForces) {
  for (const Case& each : sticking()) {
    std::mt19937_64 random(1);
    Model model = heap(each.builder, 0.02).build();
    commit(model, no_displacement(model));
    commit(model, motion_of(model, random, each.along, 1e-4));
    const Eigen::MatrixXd expected = numerical_tangent(model);
    EXPECT_GT(expected.norm(), 1) << each.what;
    // Forces of order 0.1 over 2e-6 round to 1e-10; h² times third derivatives: 1e-12 k/U² = 1e-8.
    EXPECT_LT((tangent_at(model, no_displacement(model)) - expected).cwiseAbs().maxCoeff(),
              2e-8 * expected.norm())
        << each.what;
  }
}

// On the cone a step sticks in one direction and slips in the other, so that there the tangent is that of a
// trial off the committed state: exact up to the increment over the radius, 1e-3.
TEST(LawsInAModel, TheConsistentTangentOfSlipIsTheDerivativeUpToTheIncrement) {
  const std::vector<Case> slipping{
      {"linear", with_law("linear", {{"kn", 2}, {"ks", 1}, {"friction", 2e-3}})},
      {"rolling",
       with_law("linear",
                {{"kn", 2}, {"ks", 1}, {"friction", 2e-3}, {"kr", 0.5}, {"rolling_friction", 1e-3}})},
      {"hertz", with_law("hertz", {{"effective_young", 20},
                                   {"effective_shear", 9},
                                   {"friction", 2e-3},
                                   {"kr", 0.5},
                                   {"rolling_friction", 1e-3}})},
  };
  for (const Case& each : slipping) {
    std::mt19937_64 random(1);
    Model model = heap(each.builder, 0.02).build();
    commit(model, no_displacement(model));
    const Displacement at = motion_of(model, random, 0, 1e-3);
    const Eigen::MatrixXd expected = numerical_tangent(model, at, 1e-7);
    const Eigen::MatrixXd found = tangent_at(model, at);
    EXPECT_GT((found - found.transpose()).norm(), 1e-3 * found.norm()) << each.what << " does not slip";
    EXPECT_LT((found - expected).cwiseAbs().maxCoeff(), 2e-3 * expected.norm()) << each.what;
  }
}

// K leaves out what turns with the contact frame: of relative size U/R.
TEST(LawsInAModel, TheStiffnessIsTheDerivativeOfTheForcesUpToTheOverlap) {
  for (const Case& each : sticking()) {
    std::vector<double> errors;
    for (const double overlap : {1e-3, 1e-4}) {
      const Model model = [&] {
        Model built = heap(each.builder, overlap).build();
        commit(built, no_displacement(built));
        Displacement d =
            no_displacement(built);  // lift all a little: the hysteretic law is elastic on its way back
        for (std::size_t i = 0; i < d.translation.size(); ++i)
          d.translation[i].z() = 0.01 * overlap * built.bodies.position[i].z();
        commit(built, d);
        return built;
      }();
      const assembly::LinearSystem system(model);
      Eigen::MatrixXd k = Eigen::MatrixXd::Zero(18, 18);
      for (const contact::ContactElement& e : system.elements) {
        const Mat12 block = contact::stiffness_matrix(e);
        DenseTangent sink(model);
        sink.add(e.a, e.b, block);
        k += sink.k;
      }
      const Eigen::MatrixXd expected = numerical_tangent(model, no_displacement(model), 1e-3 * overlap);
      errors.push_back((k - expected).norm() / expected.norm());
    }
    EXPECT_LT(errors[0], 1e-2) << each.what;
    EXPECT_LT(errors[1], 1e-3) << each.what;
  }
}

// What the sides of every contact get is opposite and equal: without a wall the sums are zero.
TEST(LawsInAModel, ForcesAndMomentsOfAllBodiesAddToZero) {
  for (const Case& each : sticking()) {
    std::mt19937_64 random(2);
    SceneBuilder builder = each.builder;
    builder.ball({0, 0, 0}).ball({1.7, 0, 0}, 0.75).ball({0.9, 1.2, 0.1}, 0.5);
    Model model = builder.build();
    commit(model, no_displacement(model));
    commit(model, motion_of(model, random, 0, 1e-3));
    const assembly::BodyForces f = assembly::contact_forces(model);
    Vec3 force = Vec3::Zero();
    Vec3 moment = Vec3::Zero();
    for (std::size_t i = 0; i < f.force.size(); ++i) {
      force += f.force[i];
      moment += f.moment[i] + model.bodies.position[i].cross(f.force[i]);
    }
    EXPECT_GT(f.force[0].norm(), 1e-3) << each.what;
    EXPECT_LT(force.norm() + moment.norm(), 1e-14) << each.what;
  }
}

}  // namespace
}  // namespace eigengrain::test
