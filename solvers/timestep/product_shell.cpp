#include "product_shell.hpp"

#include "eigengrain/timestep/truth.hpp"

#include "gaussian_start.hpp"

#include <algorithm>
#include <cmath>

namespace eigengrain::timestep {
namespace {

PetscErrorCode multiply(Mat matrix, Vec x, Vec y) {
  ProductShell* shell = nullptr;
  PetscCall(MatShellGetContext(matrix, &shell));
  shell->multiply(x, y);
  return 0;
}

}  // namespace

ProductShell::ProductShell(assembly::StiffnessProduct& product, double factor)
    : product_(product), factor_(factor) {
  const auto size = static_cast<PetscInt>(product.size());
  EIGENGRAIN_PETSC(MatCreateShell(PETSC_COMM_SELF, size, size, size, size, this, matrix_.put()));
  EIGENGRAIN_PETSC(MatShellSetOperation(mat(), MATOP_MULT, reinterpret_cast<void (*)()>(timestep::multiply)));
  EIGENGRAIN_PETSC(MatSetOption(mat(), MAT_SYMMETRIC, PETSC_TRUE));
}

void ProductShell::multiply(Vec x, Vec y) {
  const PetscScalar* from = nullptr;
  PetscScalar* to = nullptr;
  EIGENGRAIN_PETSC(VecGetArrayRead(x, &from));
  EIGENGRAIN_PETSC(VecGetArrayWrite(y, &to));
  const auto size = static_cast<std::size_t>(product_.size());
  product_.apply({from, size}, {to, size});
  EIGENGRAIN_PETSC(VecRestoreArrayRead(x, &from));
  EIGENGRAIN_PETSC(VecRestoreArrayWrite(y, &to));
  if (factor_ != 1) EIGENGRAIN_PETSC(VecScale(y, factor_));
}

Eigen::MatrixXd dense(assembly::StiffnessProduct& product) {
  const auto size = static_cast<std::size_t>(product.size());
  Eigen::MatrixXd matrix = Eigen::MatrixXd::Identity(product.size(), product.size());
  std::vector<double> column(size);
  for (std::size_t k = 0; k < size; ++k) {
    const std::span<double> unit(matrix.col(static_cast<Eigen::Index>(k)).data(), size);
    product.apply(unit, column);
    std::ranges::copy(column, unit.begin());
  }
  return matrix;
}

void copy(const Eigen::VectorXd& from, Vec to) {
  PetscScalar* values = nullptr;
  EIGENGRAIN_PETSC(VecGetArrayWrite(to, &values));
  std::ranges::copy(from, values);
  EIGENGRAIN_PETSC(VecRestoreArrayWrite(to, &values));
}

bool is_dense(std::int64_t unknowns) {
  return unknowns <= dense_unknowns;
}

petsc::Vector start_vector(Mat matrix, std::span<const double> scale, std::uint64_t seed) {
  petsc::Vector vector;
  EIGENGRAIN_PETSC(MatCreateVecs(matrix, vector.put(), nullptr));
  const std::vector<double> start = gaussian_start(scale, seed);
  copy(Eigen::Map<const Eigen::VectorXd>(start.data(), static_cast<Eigen::Index>(start.size())),
       vector.get());
  return vector;
}

double norm(Vec x) {
  PetscReal value = 0;
  EIGENGRAIN_PETSC(VecNorm(x, NORM_2, &value));
  return value;
}

petsc::Vector like(Vec x) {
  petsc::Vector vector;
  EIGENGRAIN_PETSC(VecDuplicate(x, vector.put()));
  return vector;
}

double dot(Vec x, Vec y) {
  PetscScalar value = 0;
  EIGENGRAIN_PETSC(VecDot(x, y, &value));
  return value;
}

std::vector<double> mode_of(Vec y, std::span<const double> scale) {
  const PetscScalar* values = nullptr;
  EIGENGRAIN_PETSC(VecGetArrayRead(y, &values));
  std::vector<double> mode(scale.begin(), scale.end());
  const double length = std::sqrt(dot(y, y));
  for (std::size_t k = 0; k < mode.size(); ++k) mode[k] *= values[k] / length;
  EIGENGRAIN_PETSC(VecRestoreArrayRead(y, &values));
  return mode;
}

}  // namespace eigengrain::timestep
