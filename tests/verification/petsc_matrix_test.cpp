#include "eigengrain/base/error.hpp"
#include "eigengrain/petsc/session.hpp"

#include "petsc/error.hpp"
#include "petsc/mass_matrix.hpp"
#include "petsc/stiffness_matrix.hpp"
#include "support/scenes.hpp"

#include <gtest/gtest.h>

#include <random>

namespace eigengrain::test {
namespace {

/// |K_petsc x - K_eigen x| / |K x| for a random x.
double difference(const petsc::StiffnessMatrix& matrix, const System& s, std::mt19937_64& random) {
  petsc::Vector x;
  petsc::Vector y;
  EIGENGRAIN_PETSC(MatCreateVecs(matrix.mat(), x.put(), y.put()));
  Eigen::VectorXd numbers(s.unknowns.size());
  std::normal_distribution<double> gaussian;
  for (Eigen::Index i = 0; i < numbers.size(); ++i) {
    numbers[i] = gaussian(random);
    EIGENGRAIN_PETSC(VecSetValue(x.get(), static_cast<PetscInt>(i), numbers[i], INSERT_VALUES));
  }
  EIGENGRAIN_PETSC(MatMult(matrix.mat(), x.get(), y.get()));
  const double* values = nullptr;
  EIGENGRAIN_PETSC(VecGetArrayRead(y.get(), &values));
  const Eigen::VectorXd found = Eigen::Map<const Eigen::VectorXd>(values, numbers.size());
  EIGENGRAIN_PETSC(VecRestoreArrayRead(y.get(), &values));
  const Eigen::VectorXd expected = assembly::stiffness_matrix(s) * numbers;
  return (found - expected).norm() / expected.norm();
}

void assemble(petsc::StiffnessMatrix& matrix, const System& s) {
  matrix.begin();
  assembly::assemble_stiffness(s.model, matrix);
  matrix.end();
}

TEST(PetscStiffnessMatrix, EqualsTheEigenMatrix) {
  std::mt19937_64 random(41);
  for (const double fixed : {0.0, 0.3}) {
    const System s(random_cluster(random, 200, {.kn = 1, .ks = 0.4}, 2, fixed));
    petsc::StiffnessMatrix matrix(s.unknowns, s.elements);
    assemble(matrix, s);
    EXPECT_LT(difference(matrix, s, random), 1e-14);
  }
}

TEST(PetscStiffnessMatrix, HoldsBodiesThatTouchTheirOwnImages) {
  std::mt19937_64 random(42);
  const System s(
      SceneBuilder({.kn = 2, .ks = 1}).ball({0.1, 0.2, 0.3}).ball({1.1, 0.7, 1.4}).periodic({1.9, 1.8, 2.2}));
  petsc::StiffnessMatrix matrix(s.unknowns, s.elements);
  assemble(matrix, s);
  EXPECT_LT(difference(matrix, s, random), 1e-14);
}

TEST(PetscStiffnessMatrix, IsAssembledAgainWithoutAllocation) {
  std::mt19937_64 random(43);
  const System s(random_cluster(random, 500, {.kn = 1, .ks = 0.4}));
  petsc::StiffnessMatrix matrix(s.unknowns, s.elements);
  MatInfo before;
  assemble(matrix, s);
  EIGENGRAIN_PETSC(MatGetInfo(matrix.mat(), MAT_LOCAL, &before));
  assemble(matrix, s);
  MatInfo after;
  EIGENGRAIN_PETSC(MatGetInfo(matrix.mat(), MAT_LOCAL, &after));
  EXPECT_EQ(after.mallocs, 0);
  EXPECT_EQ(after.nz_allocated, before.nz_allocated);
  EXPECT_EQ(after.nz_unneeded, 0);  // the pattern holds what is needed and nothing else
  EXPECT_LT(difference(matrix, s, random), 1e-14);
}

TEST(PetscMassMatrix, MakesTheGeneralisedProblemOfTheDefinition) {
  // K x = λ M x by a dense solver on the assembled matrices, against the scaled symmetric form.
  std::mt19937_64 random(44);
  const System s(random_cluster(random, 12, {.kn = 1, .ks = 0.4}));
  petsc::StiffnessMatrix stiffness(s.unknowns, s.elements);
  assemble(stiffness, s);
  const petsc::Matrix mass = petsc::mass_matrix(s);
  petsc::Eigensolver solver;
  EIGENGRAIN_PETSC(EPSCreate(PETSC_COMM_SELF, solver.put()));
  EIGENGRAIN_PETSC(EPSSetOperators(solver.get(), stiffness.mat(), mass.get()));
  EIGENGRAIN_PETSC(EPSSetProblemType(solver.get(), EPS_GHEP));
  EIGENGRAIN_PETSC(EPSSetType(solver.get(), EPSLAPACK));
  EIGENGRAIN_PETSC(EPSSetWhichEigenpairs(solver.get(), EPS_LARGEST_REAL));
  EIGENGRAIN_PETSC(EPSSolve(solver.get()));
  double lambda = 0;
  EIGENGRAIN_PETSC(EPSGetEigenvalue(solver.get(), 0, &lambda, nullptr));
  EXPECT_NEAR(lambda / s.spectrum().maxCoeff(), 1, 1e-12);
}

TEST(Petsc, ErrorsBecomeExceptionsWithTheirDescription) {
  petsc::start();
  try {
    petsc::Matrix matrix;
    EIGENGRAIN_PETSC(MatCreate(PETSC_COMM_SELF, matrix.put()));
    EIGENGRAIN_PETSC(MatSetType(matrix.get(), "no-such-type"));
    FAIL();
  } catch (const SolverError& error) {
    EXPECT_NE(std::string(error.what()).find("MatSetType"), std::string::npos) << error.what();
    EXPECT_NE(std::string(error.what()).find("Unknown type"), std::string::npos) << error.what();
  }
}

TEST(Petsc, OptionsThatNothingUsesAreTheUsersMistake) {
  EXPECT_THROW(petsc::set_options("eps_ncv 40"), InputError);  // no dash
  EXPECT_NO_THROW(petsc::set_options("-eps_ncw 40"));
  try {
    petsc::require_options_used();
    FAIL();
  } catch (const InputError& error) {
    EXPECT_NE(std::string(error.what()).find("-eps_ncw"), std::string::npos) << error.what();
  }
  EIGENGRAIN_PETSC(PetscOptionsClearValue(nullptr, "-eps_ncw"));
  EXPECT_NO_THROW(petsc::require_options_used());
}

}  // namespace
}  // namespace eigengrain::test
