// PFC3D's incremental parallel bond: the same stiffness and the same force as the total form for small
// motions.
#include "eigengrain/assembly/bonds.hpp"
#include "eigengrain/assembly/tangent.hpp"

#include "support/bonds.hpp"

#include <gtest/gtest.h>

#include <random>

namespace eigengrain::test {
namespace {

using assembly::Model;

/// Small random displacements, given at once.
void move(Model& model, std::mt19937_64& random, double size) {
  assembly::Displacement d = no_displacement(model);
  for (std::size_t i = 0; i < d.translation.size(); ++i) {
    d.translation[i] = size * random_vector(random);
    d.rotation[i] = size * random_vector(random);
    model.bodies.position[i] += d.translation[i];
  }
  model.bodies.orientation = assembly::turned_orientations(model.bodies, d.rotation);
  assembly::BodyForces sum;
  assembly::ContactForceSum(model, true)
      .advance(model, {model.bodies.position, d.translation, d.rotation, 1.0, model.bodies.orientation}, sum);
}

TEST(IncrementalParallelBond, IsTheTotalFormForSmallMotions) {
  for (const double size : {1e-4, 1e-5}) {
    std::mt19937_64 random(1);
    SceneBuilder builder = random_cluster(random, 5, {}).without_law();
    const auto forces = [&](bool incremental) {
      std::mt19937_64 again(2);
      Model model = SceneBuilder(builder).bonded(Cemented{.incremental = incremental}.rule()).build();
      move(model, again, size);
      return force_vector(model, no_displacement(model));
    };
    const Eigen::VectorXd total = forces(false);
    // Second order in the motion, and forces are of the first.
    EXPECT_LT((forces(true) - total).norm(), 20 * size * total.norm());
    EXPECT_GT(total.norm(), size);
  }
}

TEST(IncrementalParallelBond, TangentIsTheDerivativeOfTheForces) {
  std::mt19937_64 random(3);
  for (int scene = 0; scene < 5; ++scene) {
    Model model =
        random_cluster(random, 5, {}).without_law().bonded(Cemented{.incremental = true}.rule()).build();
    for (int step = 0; step < 3; ++step) move(model, random, 1e-2);
    const assembly::Displacement zero = no_displacement(model);
    DenseTangent sink(model);
    assembly::assemble_tangent(model, {model.bodies.position, zero.translation, zero.rotation, 1.0}, sink);
    const Eigen::MatrixXd expected = numerical_tangent(model);
    ASSERT_GT(force_vector(model, zero).cwiseAbs().maxCoeff(), 1e-2);
    // The small-angle carrying turns its vectors in their plane only up to what the plane itself has turned,
    // second order; rounding of 1e-9.
    EXPECT_LT((sink.k - expected).cwiseAbs().maxCoeff(), 2e-8);
  }
}

TEST(IncrementalParallelBond, UnloadedItHasTheSameStiffnessAndEnergy) {
  std::mt19937_64 random(4);
  SceneBuilder builder = random_cluster(random, 4, {}).without_law();
  const Model total = SceneBuilder(builder).bonded(Cemented{}.rule()).build();
  const Model incremental = SceneBuilder(builder).bonded(Cemented{.incremental = true}.rule()).build();
  const auto a = assembly::contact_elements(total);
  const auto b = assembly::contact_elements(incremental);
  ASSERT_EQ(a.size(), b.size());
  for (std::size_t c = 0; c < a.size(); ++c)
    EXPECT_EQ(contact::stiffness_matrix(a[c]), contact::stiffness_matrix(b[c]));
  assembly::Displacement d = no_displacement(total);
  for (Vec3& u : d.translation) u = 1e-5 * random_vector(random);
  for (Vec3& theta : d.rotation) theta = 1e-5 * random_vector(random);
  const double energy = assembly::elastic_energy(total, d);
  // First order in the motion.
  EXPECT_NEAR(assembly::elastic_energy(incremental, d), energy, 1e-3 * energy);
}

}  // namespace
}  // namespace eigengrain::test
