#include "eigengrain/spectrum/moduli.hpp"

#include "eigengrain/assembly/linear_system.hpp"
#include "eigengrain/assembly/product.hpp"
#include "eigengrain/base/error.hpp"
#include "eigengrain/base/timer.hpp"
#include "eigengrain/petsc/session.hpp"
#include "eigengrain/spectrum/modes.hpp"

#include "timestep/memory.hpp"
#include "timestep/product_shell.hpp"
#include "timestep/sparse_factor.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <memory>

namespace eigengrain::spectrum {
namespace {

using assembly::LinearSystem;
using assembly::StiffnessProduct;
using assembly::Unknowns;
using contact::ContactElement;
using timestep::SparseFactor;

/// The shift of the factor over λ_max: conjugate gradients see λ/(λ + σ), which is nearly 1 for all that
/// matters.
constexpr double shift = 1e-9;
constexpr double tolerance = 1e-13;
/// What rounding may leave of it.
constexpr double largest_residual = 1e-9;
constexpr PetscInt most_iterations = 20000;

/// The strain of unit j as a matrix.
Mat3 unit_strain(int j) {
  constexpr std::array<std::array<int, 2>, 6> place{{{0, 0}, {1, 1}, {2, 2}, {1, 2}, {0, 2}, {0, 1}}};
  Mat3 strain = Mat3::Zero();
  const auto [row, column] = place[static_cast<std::size_t>(j)];
  strain(row, column) += 0.5;
  strain(column, row) += 0.5;
  return strain;
}

/// M^-½ f of a strain.
Eigen::VectorXd push(const LinearSystem& system, std::span<const double> scale, const Mat3& strain) {
  const Unknowns& unknowns = system.unknowns;
  Eigen::VectorXd f = Eigen::VectorXd::Zero(static_cast<Eigen::Index>(scale.size()));
  const auto add = [&](std::int32_t body, double sign, const Vec3& lever, const Vec3& force) {
    const auto [u, theta] = unknowns.of(body);
    if (u != Unknowns::none) f.segment<3>(3 * u) += sign * force;
    if (theta == Unknowns::none) return;
    Vec3 moment = sign * lever.cross(force);
    if (const Mat3* axes = unknowns.axes(body)) moment = axes->transpose() * moment;
    f.segment<3>(3 * theta) += moment;
  };
  for (const ContactElement& e : system.elements) {
    const Vec3 force = e.stiffness.translation(e.normal) * (strain * (e.lever_a - e.lever_b));
    add(e.a, -1, e.lever_a, force);
    add(e.b, 1, e.lever_b, force);
  }
  for (Eigen::Index k = 0; k < f.size(); ++k) f[k] *= scale[static_cast<std::size_t>(k)];
  return f;
}

using LinearSolver = petsc::Owner<KSP, KSPDestroy>;

PetscErrorCode precondition(PC pc, Vec x, Vec y) {
  SparseFactor* factor = nullptr;
  PetscCall(PCShellGetContext(pc, &factor));
  const PetscScalar* from = nullptr;
  PetscScalar* to = nullptr;
  PetscInt size = 0;
  PetscCall(VecGetSize(x, &size));
  PetscCall(VecGetArrayRead(x, &from));
  PetscCall(VecGetArrayWrite(y, &to));
  Eigen::Map<Eigen::VectorXd>(to, size) = factor->solve(Eigen::Map<const Eigen::VectorXd>(from, size));
  PetscCall(VecRestoreArrayRead(x, &from));
  PetscCall(VecRestoreArrayWrite(y, &to));
  return 0;
}

/// A y = b for b in the range of A.
class Response {
 public:
  Response(const LinearSystem& system, std::span<const double> scale, double largest)
      : product_(system.unknowns, system.parts(), scale), shell_(product_) {
    EIGENGRAIN_PETSC(KSPCreate(PETSC_COMM_SELF, solver_.put()));
    EIGENGRAIN_PETSC(KSPSetOperators(solver_.get(), shell_.mat(), shell_.mat()));
    EIGENGRAIN_PETSC(KSPSetType(solver_.get(), KSPCG));
    EIGENGRAIN_PETSC(KSPSetNormType(solver_.get(), KSP_NORM_UNPRECONDITIONED));
    EIGENGRAIN_PETSC(
        KSPSetTolerances(solver_.get(), tolerance, PETSC_DEFAULT, PETSC_DEFAULT, most_iterations));
    PC pc = nullptr;
    EIGENGRAIN_PETSC(KSPGetPC(solver_.get(), &pc));
    if (system.unknowns.size() > factored_unknowns) {
      EIGENGRAIN_PETSC(PCSetType(pc, PCNONE));
      return;
    }
    factor_ = std::make_unique<SparseFactor>();
    const timestep::SparseMatrix matrix =
        timestep::shifted_stiffness(system.unknowns, system.parts(), scale, shift * largest, 1);
    factor_->analyzePattern(matrix);
    timestep::require_memory(factor_->numbers(), timestep::available_memory(), "the elastic response",
                             "ask for a scene of fewer bodies");
    factor_->factorize(matrix);
    if (factor_->info() != Eigen::Success)
      throw SolverError("the matrix of the elastic response could not be factored (CHOLMOD)");
    EIGENGRAIN_PETSC(PCSetType(pc, PCSHELL));
    EIGENGRAIN_PETSC(PCShellSetContext(pc, factor_.get()));
    EIGENGRAIN_PETSC(PCShellSetApply(pc, precondition));
  }

  /// y, and |A y - b| / |b|.
  std::pair<Eigen::VectorXd, double> solve(const Eigen::VectorXd& b, Moduli& result) {
    petsc::Vector right;
    petsc::Vector left;
    EIGENGRAIN_PETSC(MatCreateVecs(shell_.mat(), left.put(), right.put()));
    timestep::copy(b, right.get());
    EIGENGRAIN_PETSC(KSPSolve(solver_.get(), right.get(), left.get()));
    PetscInt iterations = 0;
    EIGENGRAIN_PETSC(KSPGetIterationNumber(solver_.get(), &iterations));
    result.iterations += iterations;
    const PetscScalar* values = nullptr;
    EIGENGRAIN_PETSC(VecGetArrayRead(left.get(), &values));
    Eigen::VectorXd y = Eigen::Map<const Eigen::VectorXd>(values, b.size());
    EIGENGRAIN_PETSC(VecRestoreArrayRead(left.get(), &values));
    Eigen::VectorXd image(b.size());
    const auto size = static_cast<std::size_t>(b.size());
    product_.apply({y.data(), size}, {image.data(), size});
    return {std::move(y), (image - b).norm() / b.norm()};
  }

 private:
  StiffnessProduct product_;
  timestep::ProductShell shell_;
  std::unique_ptr<SparseFactor> factor_;
  LinearSolver solver_;
};

void check(const assembly::Model& model) {
  if (!(model.cell.periodic[0] && model.cell.periodic[1] && model.cell.periodic[2]))
    throw InputError(
        "moduli are those of a cell that repeats along all axes; write periodic: {box: [...]} without axes, "
        "and no walls");
  for (std::size_t row = 0; row < model.bodies.fixed.size(); ++row)
    if (model.bodies.fixed[row].bits() != 0)
      throw InputError(fmt::format(
          "moduli: ball {} has fixed components, which cannot follow a strain; leave out its `fix`",
          model.bodies.identity[row]));
}

void check(const LinearSystem& system) {
  if (std::ranges::any_of(system.elements, [](const ContactElement& e) { return e.b == contact::no_body; }))
    throw InputError("moduli are those of bodies alone, and here some touch a wall; leave out the walls");
}

}  // namespace

Moduli elastic_moduli(const assembly::Model& model) {
  const Stopwatch watch;
  check(model);
  const LinearSystem system(model);
  check(system);
  Moduli result;
  result.volume = model.cell.volume();
  result.contacts = std::ssize(system.elements);
  for (int i = 0; i < 6; ++i)
    for (int j = 0; j < 6; ++j) {
      double sum = 0;
      for (const ContactElement& e : system.elements) {
        const Vec3 branch = e.lever_a - e.lever_b;
        sum += (unit_strain(i) * branch).dot(e.stiffness.translation(e.normal) * (unit_strain(j) * branch));
      }
      result.affine(i, j) = sum / result.volume;
    }
  result.affine = Mat6(0.5 * (result.affine + result.affine.transpose()));
  result.stiffness = result.affine;
  const std::vector<double> scale = system.inverse_sqrt_mass();
  const Modes top = highest_modes(system, 1);
  if (top.lambda.empty()) return result;

  Response response(system, scale, top.lambda.front());
  Eigen::Matrix<double, Eigen::Dynamic, 6> pushes(static_cast<Eigen::Index>(scale.size()), 6);
  for (int j = 0; j < 6; ++j) pushes.col(j) = push(system, scale, unit_strain(j));
  Eigen::Matrix<double, Eigen::Dynamic, 6> answers = decltype(pushes)::Zero(pushes.rows(), 6);
  // Of lattices in which all bodies follow the strain, rounding alone.
  const double nothing =
      1e-12 * std::sqrt(top.lambda.front() * result.affine.diagonal().maxCoeff() * result.volume);
  for (int j = 0; j < 6; ++j) {
    if (!(pushes.col(j).norm() > nothing)) continue;
    const auto [y, residual] = response.solve(pushes.col(j), result);
    if (!(residual <= largest_residual))
      throw SolverError(
          fmt::format("moduli: the response to strain {} has a residual of {:.1e} after {} iterations, and "
                      "{:.0e} is wanted; contacts are too far apart in stiffness",
                      j, residual, result.iterations, largest_residual));
    answers.col(j) = y;
    result.residual[static_cast<std::size_t>(j)] = residual;
  }
  const Mat6 relaxed = pushes.transpose() * answers / result.volume;
  result.stiffness -= 0.5 * (relaxed + relaxed.transpose());
  for (int j = 0; j < 6; ++j) {
    std::vector<double> u(scale.size());
    for (std::size_t k = 0; k < u.size(); ++k) u[k] = -scale[k] * answers(static_cast<Eigen::Index>(k), j);
    BodyMotion motion = motion_of_bodies(system, u);
    result.displacement[static_cast<std::size_t>(j)] = std::move(motion.displacement);
    result.rotation[static_cast<std::size_t>(j)] = std::move(motion.rotation);
  }
  result.seconds = watch.seconds();
  return result;
}

}  // namespace eigengrain::spectrum
