// Linear solvers of Newton's systems, each alone on matrices of packings that are hard for some of them, and
// the order in which one takes over from another.
#include "relaxation/linear_solver.hpp"

#include "eigengrain/assembly/linear_system.hpp"

#include "packings.hpp"
#include "petsc/stiffness_matrix.hpp"
#include "support/scenes.hpp"

#include <gmock/gmock.h>

#include <algorithm>
#include <random>
#include <string>
#include <string_view>
#include <vector>

namespace eigengrain::test {
namespace {

using petsc::Vector;
using relaxation::LinearMethod;
using relaxation::LinearOutcome;
using relaxation::LinearSolver;
using relaxation::LinearTraits;
using testing::ElementsAre;
using testing::HasSubstr;

constexpr double tolerance = 1e-8;

/// Every 20th contact is so many times as stiff.
struct Case {
  const char* name;
  PackedBox box;
  double contrast = 1;
};
const std::vector<Case>& cases() {
  static const std::vector<Case> all{
      {"in a box", {}},
      {"on a floor", {.walls = "walls: [{plane: {point: [0, 0, 0], normal: [0, 0, 1]}, material: grain}]"}},
      {"with weak shear", {.contacts = "law: linear, kn: 1.0e5, ks: 1.0e3, friction: 0.5"}},
      {"bonded",
       {.contacts = "law: linear, kn: 1.0e5, ks: 5.0e4, friction: 0.5, bond: {kind: parallel, kn: 5.0e9, "
                    "ks: 2.0e9, radius: 1}"}},
      {"frictionless", {.contacts = "law: linear, kn: 1.0e5"}},
      {"contrast of a million", {}, 1e6}};
  return all;
}

/// A x = b with x random: K of the contacts with a shift of a millionth of what a contact has, as Newton's
/// systems have one.
class Problem {
 public:
  explicit Problem(const Case& wanted)
      : model(assembly::build_model(packed(wanted.box))),
        system(model),
        contrast(wanted.contrast),
        matrix_(system.unknowns, system.elements) {
    double stiffness = 0;
    for (std::size_t c = 0; c < system.elements.size(); ++c) {
      stiffness = system.elements[c].stiffness.normal;
      if (c % 20 == 0) system.elements[c].stiffness = wanted.contrast * system.elements[c].stiffness;
    }
    fill(1e-6 * stiffness);
  }

  /// -k_n µ t nᵀ at every tenth contact, which slides along t.
  void let_some_slide() {
    std::mt19937_64 random(3);
    matrix_.begin();
    for (std::size_t c = 0; c < system.elements.size(); ++c) {
      const contact::ContactElement& e = system.elements[c];
      Mat12 k = contact::stiffness_matrix(e);
      if (c % 10 == 0) {
        const Vec3 t = e.normal.cross(random_vector(random)).normalized();
        const Eigen::Matrix<double, 3, 12> b = contact::strain_displacement(e).topRows<3>();
        k += 0.3 * e.stiffness.normal * b.transpose() * t * e.normal.transpose() * b;
      }
      matrix_.add(e.a, e.b, k);
    }
    finish(1e-6 * system.elements[1].stiffness.normal);
  }

  void fill(double shift) {
    matrix_.begin();
    for (const contact::ContactElement& e : system.elements) matrix_.add(e);
    finish(shift);
  }

  Mat mat() const { return matrix_.mat(); }
  Vec b() const { return b_.get(); }

  LinearOutcome solve(std::vector<LinearMethod> methods) {
    LinearSolver solver(mat(), {.contrast = contrast, .methods = std::move(methods), .rigid_motions = [this] {
                                  return rigid_motions();
                                }});
    Vector x;
    EIGENGRAIN_PETSC(VecDuplicate(b(), x.put()));
    return solver.solve(b(), x.get(), tolerance);
  }
  /// |b - A x|/|b| of what a method finds.
  double residual(LinearMethod method) {
    LinearSolver solver(mat(), {.methods = {method}, .rigid_motions = [this] { return rigid_motions(); }});
    Vector x;
    EIGENGRAIN_PETSC(VecDuplicate(b(), x.put()));
    const LinearOutcome outcome = solver.solve(b(), x.get(), tolerance);
    iterations = outcome.iterations;
    for (const std::string& failure : outcome.failures) ADD_FAILURE() << failure;
    Vector r;
    EIGENGRAIN_PETSC(VecDuplicate(b(), r.put()));
    EIGENGRAIN_PETSC(MatMult(mat(), x.get(), r.get()));
    EIGENGRAIN_PETSC(VecAYPX(r.get(), -1, b()));
    PetscReal left = 0;
    PetscReal all = 0;
    EIGENGRAIN_PETSC(VecNorm(r.get(), NORM_2, &left));
    EIGENGRAIN_PETSC(VecNorm(b(), NORM_2, &all));
    return left / all;
  }

  assembly::Model model;
  assembly::LinearSystem system;
  double contrast;
  int iterations = 0;

 private:
  void finish(double shift) {
    matrix_.end();
    Vector x;
    EIGENGRAIN_PETSC(MatCreateVecs(mat(), x.put(), b_.put()));
    EIGENGRAIN_PETSC(VecSet(x.get(), shift));
    EIGENGRAIN_PETSC(MatDiagonalSet(mat(), x.get(), ADD_VALUES));
    std::mt19937_64 random(7);
    std::normal_distribution<double> gaussian;
    PetscScalar* values = nullptr;
    EIGENGRAIN_PETSC(VecGetArrayWrite(x.get(), &values));
    for (std::int64_t k = 0; k < system.unknowns.size(); ++k) values[k] = gaussian(random);
    EIGENGRAIN_PETSC(VecRestoreArrayWrite(x.get(), &values));
    EIGENGRAIN_PETSC(MatMult(mat(), x.get(), b_.get()));
  }
  std::vector<Vector> rigid_motions() const {
    std::vector<Vector> motions(6);
    for (int k = 0; k < 6; ++k) {
      EIGENGRAIN_PETSC(VecDuplicate(b(), motions[static_cast<std::size_t>(k)].put()));
      PetscScalar* values = nullptr;
      EIGENGRAIN_PETSC(VecGetArrayWrite(motions[static_cast<std::size_t>(k)].get(), &values));
      for (std::int32_t block = 0; block < system.unknowns.blocks(); ++block) {
        const bool turns = system.unknowns.is_rotation(block);
        const Vec3& x = model.bodies.position[static_cast<std::size_t>(system.unknowns.body(block))];
        const Vec3 axis = Vec3::Unit(k % 3);
        Vec3 motion = k < 3 ? Vec3(turns ? Vec3(Vec3::Zero()) : axis) : turns ? axis : Vec3(axis.cross(x));
        Eigen::Map<Vec3>(values + 3 * block) = motion;
      }
      EIGENGRAIN_PETSC(VecRestoreArrayWrite(motions[static_cast<std::size_t>(k)].get(), &values));
    }
    return motions;
  }

  petsc::StiffnessMatrix matrix_;
  Vector b_;
};

class EachLinearMethod : public testing::TestWithParam<LinearMethod> {};

/// Iteration that begins anew after so many vectors stalls where thousands of motions are resisted by the
/// shift alone.
bool stalls_on_mechanisms(LinearMethod method) {
  using enum LinearMethod;
  return method == ilu_gmres || method == jacobi_gmres || method == gamg;
}

TEST_P(EachLinearMethod, SolvesPackings) {
  for (const Case& wanted : cases()) {
    if (stalls_on_mechanisms(GetParam()) && wanted.name == std::string_view("frictionless")) continue;
    SCOPED_TRACE(wanted.name);
    Problem problem(wanted);
    // Ten times as much is what rounding may take from a method that watches its own residual.
    EXPECT_LE(problem.residual(GetParam()), 10 * tolerance);
    RecordProperty(wanted.name, problem.iterations);
  }
}

TEST_P(EachLinearMethod, SolvesSlidingPackingsUnlessItIsForSymmetricOnes) {
  using enum LinearMethod;
  Problem problem(cases()[0]);
  problem.let_some_slide();
  if (GetParam() == icc_cg || GetParam() == jacobi_cg || GetParam() == cholmod) GTEST_SKIP();
  EXPECT_LE(problem.residual(GetParam()), 10 * tolerance);
}

INSTANTIATE_TEST_SUITE_P(LinearSolver, EachLinearMethod,
                         testing::Values(LinearMethod::icc_cg, LinearMethod::ilu_bicgstab,
                                         LinearMethod::ilu_gmres, LinearMethod::jacobi_cg,
                                         LinearMethod::jacobi_gmres, LinearMethod::gamg, LinearMethod::hypre,
                                         LinearMethod::cholmod, LinearMethod::mumps),
                         [](const auto& method) {
                           std::string name(relaxation::name_of(method.param));
                           std::replace(name.begin(), name.end(), '-', '_');
                           return name;
                         });

TEST(LinearSolver, IsChosenBySizeContrastAndSymmetry) {
  using enum LinearMethod;
  const auto first = [](const LinearTraits& traits) { return relaxation::methods_for(traits).front(); };
  EXPECT_EQ(first({.size = 60000, .symmetric = true}), icc_cg);
  EXPECT_EQ(first({.size = 60000, .symmetric = false}), ilu_bicgstab);
  EXPECT_EQ(first({.size = 60000, .symmetric = true, .contrast = 1e4}), cholmod);
  EXPECT_EQ(first({.size = 60000, .symmetric = false, .contrast = 1e4}), mumps);
  EXPECT_EQ(first({.size = 600000, .symmetric = true, .contrast = 1e4}), icc_cg);  // no memory for a factor
  EXPECT_EQ(first({.size = 600, .symmetric = true}), cholmod);
  EXPECT_EQ(first({.size = 30000000, .symmetric = true}), gamg);
}

TEST(LinearSolver, FindsOutWhetherTheMatrixIsSymmetric) {
  Problem problem(cases()[0]);
  EXPECT_EQ(problem.solve({}).method, LinearMethod::icc_cg);
  problem.let_some_slide();
  EXPECT_EQ(problem.solve({}).method, LinearMethod::ilu_bicgstab);
}

// A shift that makes K indefinite: conjugate gradients and Cholesky break down, LU does not.
TEST(LinearSolver, AnotherTakesOverFromOneThatBreaksDown) {
  using enum LinearMethod;
  Problem problem(cases()[0]);
  problem.fill(-0.3 * problem.system.elements[0].stiffness.normal);
  const LinearOutcome outcome = problem.solve({icc_cg, cholmod, mumps, jacobi_gmres});
  EXPECT_TRUE(outcome.solved);
  EXPECT_EQ(outcome.method, mumps);
  EXPECT_THAT(outcome.failures, ElementsAre(HasSubstr("icc-cg: "), HasSubstr("cholmod: ")));
}

TEST(LinearSolver, BeginsWithTheOneThatTookOver) {
  using enum LinearMethod;
  Problem problem(cases()[0]);
  problem.fill(-0.3 * problem.system.elements[0].stiffness.normal);
  LinearSolver solver(problem.mat(), {.methods = {icc_cg, mumps}});
  Vector x;
  EIGENGRAIN_PETSC(VecDuplicate(problem.b(), x.put()));
  EXPECT_EQ(solver.solve(problem.b(), x.get(), tolerance).failures.size(), 1U);
  solver.matrix_changed();
  EXPECT_EQ(solver.solve(problem.b(), x.get(), tolerance).failures.size(), 0U);
}

TEST(LinearSolver, SaysWhyNoneSolvedTheSystem) {
  using enum LinearMethod;
  Problem problem(cases()[0]);
  problem.fill(-0.3 * problem.system.elements[0].stiffness.normal);
  const LinearOutcome outcome = problem.solve({icc_cg, cholmod});
  EXPECT_FALSE(outcome.solved);
  EXPECT_EQ(outcome.failures.size(), 2U);
}

TEST(LinearSolver, StopsWhenItIsInterrupted) {
  Problem problem(cases()[0]);
  int asked = 0;
  LinearSolver solver(problem.mat(),
                      {.methods = {LinearMethod::jacobi_cg}, .interrupted = [&] { return ++asked > 3; }});
  Vector x;
  EIGENGRAIN_PETSC(VecDuplicate(problem.b(), x.put()));
  EXPECT_ANY_THROW(solver.solve(problem.b(), x.get(), tolerance));
  EXPECT_LT(asked, 10);
}

}  // namespace
}  // namespace eigengrain::test
