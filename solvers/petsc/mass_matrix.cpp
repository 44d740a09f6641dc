#include "mass_matrix.hpp"

#include "eigengrain/petsc/session.hpp"

namespace eigengrain::petsc {

Matrix mass_matrix(const assembly::LinearSystem& system) {
  start();
  const auto size = static_cast<PetscInt>(system.mass.size());
  Matrix matrix;
  EIGENGRAIN_PETSC(MatCreateSeqBAIJ(PETSC_COMM_SELF, assembly::Unknowns::block_size, size, size, 1, nullptr,
                                    matrix.put()));
  for (PetscInt k = 0; k < size; ++k)
    EIGENGRAIN_PETSC(MatSetValue(matrix.get(), k, k, system.mass[k], INSERT_VALUES));
  EIGENGRAIN_PETSC(MatAssemblyBegin(matrix.get(), MAT_FINAL_ASSEMBLY));
  EIGENGRAIN_PETSC(MatAssemblyEnd(matrix.get(), MAT_FINAL_ASSEMBLY));
  return matrix;
}

}  // namespace eigengrain::petsc
