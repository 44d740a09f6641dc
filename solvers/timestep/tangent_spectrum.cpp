#include "eigengrain/timestep/tangent_spectrum.hpp"

#include "eigengrain/assembly/linear_system.hpp"
#include "eigengrain/assembly/tangent.hpp"
#include "eigengrain/base/timer.hpp"
#include "eigengrain/measures/acting_contacts.hpp"
#include "eigengrain/petsc/session.hpp"

#include "petsc/stiffness_matrix.hpp"

#include <Eigen/Eigenvalues>

#include <algorithm>
#include <cmath>
#include <vector>

namespace eigengrain::timestep {
namespace {

using Complex = std::complex<double>;

/// Imaginary parts below this part of the largest eigenvalue are rounding of a double one: a defective pair
/// splits by the root of it.
constexpr double rounding = 1e-7;

/// S A S, S = M^-½.
petsc::Matrix scaled(const petsc::StiffnessMatrix& blocks, const assembly::LinearSystem& system) {
  const std::vector<double> scale = system.inverse_sqrt_mass();
  petsc::Vector s;
  EIGENGRAIN_PETSC(MatCreateVecs(blocks.mat(), s.put(), nullptr));
  PetscScalar* values = nullptr;
  EIGENGRAIN_PETSC(VecGetArrayWrite(s.get(), &values));
  std::ranges::copy(scale, values);
  EIGENGRAIN_PETSC(VecRestoreArrayWrite(s.get(), &values));
  petsc::Matrix result;
  EIGENGRAIN_PETSC(MatDuplicate(blocks.mat(), MAT_COPY_VALUES, result.put()));
  EIGENGRAIN_PETSC(MatDiagonalScale(result.get(), s.get(), s.get()));
  return result;
}

/// S T S of a model.
petsc::Matrix scaled_tangent(const assembly::Model& model, const assembly::LinearSystem& system,
                             assembly::Slip slip) {
  petsc::StiffnessMatrix blocks(system.unknowns, system.parts());
  const auto bodies = static_cast<std::size_t>(model.bodies.size());
  const std::vector<Vec3> still(bodies, Vec3::Zero());
  blocks.begin();
  const assembly::Trial trial{model.bodies.position, still, still, 1.0, model.bodies.orientation};
  assembly::assemble_tangent(model, trial, blocks, slip);
  assembly::for_each_nodal_tangent(model, trial, system.unknowns,
                                   [&](std::int32_t row, std::int32_t column, const Mat3& block) {
                                     blocks.add_block(row, column, block);
                                   });
  blocks.end();
  return scaled(blocks, system);
}

/// The free rows and columns of an assembled matrix.
Eigen::MatrixXd dense(Mat matrix, const std::vector<std::int32_t>& free) {
  const auto n = static_cast<Eigen::Index>(free.size());
  Eigen::MatrixXd result(n, n);
  std::vector<PetscScalar> row(free.size());
  for (Eigen::Index i = 0; i < n; ++i) {
    const PetscInt number = free[static_cast<std::size_t>(i)];
    EIGENGRAIN_PETSC(MatGetValues(matrix, 1, &number, static_cast<PetscInt>(n), free.data(), row.data()));
    result.row(i) = Eigen::Map<const Eigen::RowVectorXd>(row.data(), n);
  }
  return result;
}

/// One end of the spectrum by Krylov-Schur iteration; not found where it does not converge.
Eigenvalue iterate(Mat matrix, EPSWhich which, PetscInt vectors = 60) {
  petsc::Eigensolver solver;
  EIGENGRAIN_PETSC(EPSCreate(PETSC_COMM_SELF, solver.put()));
  EIGENGRAIN_PETSC(EPSSetOperators(solver.get(), matrix, nullptr));
  EIGENGRAIN_PETSC(EPSSetProblemType(solver.get(), EPS_NHEP));
  EIGENGRAIN_PETSC(EPSSetType(solver.get(), EPSKRYLOVSCHUR));
  EIGENGRAIN_PETSC(EPSSetWhichEigenpairs(solver.get(), which));
  EIGENGRAIN_PETSC(EPSSetDimensions(solver.get(), 1, vectors, PETSC_DEFAULT));
  EIGENGRAIN_PETSC(EPSSetConvergenceTest(solver.get(), EPS_CONV_NORM));
  EIGENGRAIN_PETSC(EPSSetTolerances(solver.get(), 1e-9, 18000 / vectors));
  EIGENGRAIN_PETSC(EPSSolve(solver.get()));
  PetscInt converged = 0;
  EIGENGRAIN_PETSC(EPSGetConverged(solver.get(), &converged));
  if (converged < 1) return {};
  PetscScalar real = 0;
  PetscScalar imaginary = 0;
  Eigenvalue result;
  EIGENGRAIN_PETSC(EPSGetEigenvalue(solver.get(), 0, &real, &imaginary));
  EIGENGRAIN_PETSC(EPSComputeError(solver.get(), 0, EPS_ERROR_RELATIVE, &result.residual));
  result.value = Complex(real, std::abs(imaginary));
  return result;
}

/// All eigenvalues of a small matrix.
Eigen::VectorXcd all_of(const Eigen::MatrixXd& matrix) {
  return Eigen::EigenSolver<Eigen::MatrixXd>(matrix, false).eigenvalues();
}

/// The one of all that is greatest by a measure. Each errs by rounding of the largest.
template <class Measure>
Eigenvalue extreme(const Eigen::VectorXcd& all, const Measure& measure) {
  Eigen::Index best = 0;
  for (Eigen::Index k = 1; k < all.size(); ++k)
    if (measure(all[k]) > measure(all[best])) best = k;
  const double size = all.cwiseAbs().maxCoeff();
  Complex value(all[best].real(), std::abs(all[best].imag()));
  if (value.imag() <= rounding * size) value = value.real();
  return {.value = value, .residual = 1e-15 * static_cast<double>(all.size())};
}

SpectrumEnds ends_of(const Eigen::VectorXcd& all) {
  return {.largest = extreme(all, [](const Complex& z) { return z.real(); }),
          .least = extreme(all, [](const Complex& z) { return -z.real(); })};
}

SpectrumEnds ends_of(Mat matrix) {
  return {.largest = iterate(matrix, EPS_LARGEST_REAL), .least = iterate(matrix, EPS_SMALLEST_REAL)};
}

/// K itself through the same door.
petsc::Matrix scaled_stiffness(const assembly::LinearSystem& system) {
  petsc::StiffnessMatrix blocks(system.unknowns, system.parts());
  blocks.begin();
  for (const contact::ContactElement& e : system.elements) blocks.add(e);
  assembly::for_each_block(system.nodal.k, [&](std::int32_t row, std::int32_t column, const Mat3& block) {
    blocks.add_block(row, column, block);
  });
  blocks.end();
  return scaled(blocks, system);
}

}  // namespace

TangentSpectrum tangent_spectrum(const assembly::Model& model) {
  TangentSpectrum result;
  const assembly::LinearSystem system(model);
  const std::vector<std::int32_t> free = system.unknowns.free_components();
  result.contacts = static_cast<std::int64_t>(system.elements.size());
  result.sliding =
      std::ranges::count_if(measures::acting_contacts(model), [](const auto& c) { return c.slides; });
  if (free.empty()) return result;
  petsc::start();
  const Stopwatch watch;
  const petsc::Matrix elastic = scaled_stiffness(system);
  const petsc::Matrix sticking = scaled_tangent(model, system, assembly::Slip::none);
  const petsc::Matrix slipping = scaled_tangent(model, system, assembly::Slip::continuing);
  if (static_cast<std::int64_t>(free.size()) <= dense_tangent_unknowns) {
    result.elastic = ends_of(all_of(dense(elastic.get(), free)));
    result.sticking = ends_of(all_of(dense(sticking.get(), free)));
    const Eigen::VectorXcd all = all_of(dense(slipping.get(), free));
    result.slipping = ends_of(all);
    result.widest = extreme(all, [](const Complex& z) { return std::abs(z.imag()); });
    const double floor = rounding * all.cwiseAbs().maxCoeff();
    result.complex_pairs = std::ranges::count_if(all, [&](const Complex& z) { return z.imag() > floor; });
  } else {
    result.elastic.largest = iterate(elastic.get(), EPS_LARGEST_REAL);  // none of K is negative
    result.sticking = ends_of(sticking.get());
    result.slipping = result.sliding > 0 ? ends_of(slipping.get()) : result.sticking;
    result.complex_pairs = -1;
    // Imaginary parts are small beside real ones, and a real eigenvalue may come for want of a complex one.
    if (result.sliding > 0) result.widest = iterate(slipping.get(), EPS_LARGEST_IMAGINARY, 200);
    if (result.widest.value.imag() == 0) result.widest = {};
  }
  result.seconds = watch.seconds();
  return result;
}

double growth_per_step(std::complex<double> lambda, double dt) {
  const Complex w = 1.0 - 0.5 * dt * dt * lambda;
  const Complex root = std::sqrt(w * w - 1.0);
  return std::max(std::abs(w + root), std::abs(w - root));
}

}  // namespace eigengrain::timestep
