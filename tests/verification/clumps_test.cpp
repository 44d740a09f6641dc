// Clumps in what PETSc and SLEPc solve: matrix, true timestep, equilibrium.
#include "support/clumps.hpp"

#include "eigengrain/base/error.hpp"
#include "eigengrain/cycle/cycle.hpp"
#include "eigengrain/cycle/policy.hpp"
#include "eigengrain/relaxation/relax.hpp"
#include "eigengrain/timestep/truth.hpp"

#include "petsc/stiffness_matrix.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

namespace eigengrain::test {
namespace {

/// A loose heap of dumbbells, odd shapes and balls over a floor, in a cell that repeats sideways.
SceneBuilder heap(std::uint64_t seed, int layers, const Springs& springs) {
  std::mt19937_64 random(seed);
  SceneBuilder builder(springs);
  constexpr double pitch = 4.2;  // no two bodies touch, however they are turned
  for (int k = 0; k < 4 * layers; ++k) {
    const Vec3 at(pitch * (k % 2) + 1, pitch * (k / 2 % 2) + 1, pitch * (k / 4) + 2.3);
    if (k % 4 == 3)
      builder.ball(at, 0.9, 3);
    else
      builder.clump(k % 2 == 0 ? dumbbell() : odd_shape(),
                    {.position = at, .orientation = random_orientation(random)});
  }
  builder.plane(Vec3::Zero(), Vec3::UnitZ()).periodic({2 * pitch, 2 * pitch, 1}, {true, true, false});
  builder.gravity({0, 0, -1}).damped(0.7);
  return builder;
}

TEST(ClumpMatrix, OfPetscIsTheOneOfEigen) {
  SceneBuilder builder = heap(1, 3, {.kn = 1e4, .ks = 4e3, .tension = false});
  cycle::Cycle cycle(cycle::start(builder.scene()), cycle::policy_of(builder.scene()));
  cycle.run(4000);
  const System s(cycle.state().model);
  ASSERT_GT(s.elements.size(), 12U);
  petsc::StiffnessMatrix matrix(s.unknowns, s.elements);
  matrix.begin();
  assembly::assemble_stiffness(s.model, matrix);
  matrix.end();
  const Eigen::MatrixXd expected = assembly::stiffness_matrix(s);
  double worst = 0;
  for (PetscInt row = 0; row < expected.rows(); ++row)
    for (PetscInt column = 0; column < expected.cols(); ++column) {
      PetscScalar value = 0;
      EIGENGRAIN_PETSC(MatGetValues(matrix.mat(), 1, &row, 1, &column, &value));
      worst = std::max(worst, std::abs(value - expected(row, column)));
    }
  EXPECT_LT(worst, 1e-15 * expected.cwiseAbs().maxCoeff());
  // And its largest eigenvalue by the product without a matrix.
  const timestep::Truth truth = timestep::critical_timestep(s);
  EXPECT_NEAR(truth.limit * std::sqrt(s.spectrum().maxCoeff()) / 2, 1, 1e-9);
}

TEST(ClumpRelax, PutsADumbbellOnItsSide) {
  SceneBuilder builder({.kn = 1e4, .ks = 5e3, .tension = false});
  builder.clump(dumbbell(),
                {.position = {0, 0, 1.4}, .orientation = Quat(Eigen::AngleAxisd(0.3, Vec3::UnitY()))});
  builder.plane(Vec3::Zero(), Vec3::UnitZ()).gravity({0, 0, -10});
  assembly::State state = cycle::start(builder.scene());
  const relaxation::RelaxResult result = relaxation::relax(state);
  EXPECT_TRUE(result.converged);
  EXPECT_NE(result.method.find("newton"), std::string::npos) << result.method;
  // Half of the weight under each ball.
  const double sunk = dumbbell().mass * 10 / 2 / 1e4;
  for (const Vec3& x : state.model.bodies.position) EXPECT_NEAR(x.z(), 1 - sunk, 1e-10);
  EXPECT_NEAR(state.model.bodies.clumps.position[0].z(), 1 - sunk, 1e-10);
  EXPECT_EQ(state.model.bodies.clumps.angular_momentum[0], Vec3(Vec3::Zero()));
}

TEST(ClumpRelax, FindsTheEquilibriumOfAHeapAndItStays) {
  SceneBuilder builder = heap(2, 8, {.kn = 1e4, .ks = 4e3, .tension = false});
  builder.scene().timestep.policy = model::TimestepPolicy::bound;
  assembly::State state = cycle::start(builder.scene());
  relaxation::RelaxOptions options;
  options.max_steps = 400000;
  const relaxation::RelaxResult result = relaxation::relax(state, options);
  EXPECT_TRUE(result.converged) << result.end.mean << ' ' << result.end.moment_mean << ' '
                                << result.explicit_steps;
  EXPECT_NE(result.method.find("newton"), std::string::npos) << result.method;
  EXPECT_EQ(result.end.bodies, 32);
  EXPECT_LE(assembly::balance_of(state).mean, 1e-10);
  // Members are where their clumps say.
  model::Bodies placed = state.model.bodies;
  model::place_members(placed);
  for (std::size_t i = 0; i < placed.position.size(); ++i)
    EXPECT_LT((placed.position[i] - state.model.bodies.position[i]).norm(), 1e-12);
  cycle::Cycle cycle(std::move(state), cycle::policy_of(builder.scene()));
  cycle.run(1000);
  EXPECT_LE(assembly::balance_of(cycle.state()).mean, 1e-10);
}

}  // namespace
}  // namespace eigengrain::test
