#include "mass_matrix.hpp"

#include "eigengrain/assembly/mass.hpp"
#include "eigengrain/petsc/session.hpp"

#include <vector>

namespace eigengrain::petsc {

Matrix mass_matrix(const model::Bodies& bodies, const assembly::Unknowns& unknowns) {
  start();
  const std::vector<double> diagonal = assembly::mass_diagonal(bodies, unknowns);
  const auto size = static_cast<PetscInt>(diagonal.size());
  Matrix matrix;
  EIGENGRAIN_PETSC(MatCreateSeqBAIJ(PETSC_COMM_SELF, assembly::Unknowns::block_size, size, size, 1, nullptr,
                                    matrix.put()));
  for (PetscInt k = 0; k < size; ++k)
    EIGENGRAIN_PETSC(MatSetValue(matrix.get(), k, k, diagonal[static_cast<std::size_t>(k)], INSERT_VALUES));
  EIGENGRAIN_PETSC(MatAssemblyBegin(matrix.get(), MAT_FINAL_ASSEMBLY));
  EIGENGRAIN_PETSC(MatAssemblyEnd(matrix.get(), MAT_FINAL_ASSEMBLY));
  return matrix;
}

}  // namespace eigengrain::petsc
