#include "stiffness_matrix.hpp"

#include "eigengrain/assembly/scatter.hpp"
#include "eigengrain/petsc/session.hpp"

#include <algorithm>
#include <vector>

namespace eigengrain::petsc {
namespace {

using assembly::Unknowns;

/// Block columns of every block row, sorted, each once: the compressed rows that PETSc preallocates from.
struct BlockPattern {
  std::vector<PetscInt> offsets{0};
  std::vector<PetscInt> columns;
};

BlockPattern block_pattern(const Unknowns& unknowns, const assembly::StiffnessParts& parts) {
  std::vector<std::vector<PetscInt>> rows(static_cast<std::size_t>(unknowns.blocks()));
  const auto couple = [&](std::int32_t row_body, std::int32_t column_body) {
    for (const std::int32_t row : unknowns.of(row_body))
      for (const std::int32_t column : unknowns.of(column_body))
        if (row != Unknowns::none && column != Unknowns::none) rows[row].push_back(column);
  };
  if (parts.nodal != nullptr)
    assembly::for_each_block(parts.nodal->k, [&](std::int32_t row, std::int32_t column, const Mat3&) {
      rows[static_cast<std::size_t>(row)].push_back(column);
    });
  for (const contact::ContactElement& e : parts.contacts) {
    couple(e.a, e.a);
    if (e.b == contact::no_body) continue;
    couple(e.b, e.b);
    couple(e.a, e.b);
    couple(e.b, e.a);
  }
  BlockPattern pattern;
  for (std::vector<PetscInt>& row : rows) {
    std::sort(row.begin(), row.end());
    row.erase(std::unique(row.begin(), row.end()), row.end());
    pattern.columns.insert(pattern.columns.end(), row.begin(), row.end());
    pattern.offsets.push_back(static_cast<PetscInt>(pattern.columns.size()));
    row = {};
  }
  return pattern;
}

}  // namespace

StiffnessMatrix::StiffnessMatrix(const Unknowns& unknowns, const assembly::StiffnessParts& parts)
    : unknowns_(&unknowns) {
  start();
  const auto size = static_cast<PetscInt>(unknowns.size());
  EIGENGRAIN_PETSC(MatCreate(PETSC_COMM_SELF, matrix_.put()));
  EIGENGRAIN_PETSC(MatSetSizes(mat(), size, size, size, size));
  EIGENGRAIN_PETSC(MatSetType(mat(), MATSEQBAIJ));
  const BlockPattern pattern = block_pattern(unknowns, parts);
  EIGENGRAIN_PETSC(MatSeqBAIJSetPreallocationCSR(mat(), Unknowns::block_size, pattern.offsets.data(),
                                                 pattern.columns.data(), nullptr));
  // A contact outside of the pattern is a mistake of ours, never a reason to allocate.
  EIGENGRAIN_PETSC(MatSetOption(mat(), MAT_NEW_NONZERO_LOCATION_ERR, PETSC_TRUE));
  EIGENGRAIN_PETSC(MatSetOption(mat(), MAT_ROW_ORIENTED, PETSC_FALSE));  // Eigen's blocks are by columns
}

void StiffnessMatrix::begin() {
  EIGENGRAIN_PETSC(MatZeroEntries(mat()));
}

void StiffnessMatrix::add_block(std::int32_t row, std::int32_t column, const Mat3& block) {
  EIGENGRAIN_PETSC(MatSetValuesBlocked(mat(), 1, &row, 1, &column, block.data(), ADD_VALUES));
}

void StiffnessMatrix::add(const contact::ContactElement& element) {
  assembly::scatter(element, *unknowns_, [&](std::int32_t row, std::int32_t column, const Mat3& block) {
    add_block(row, column, block);
  });
}

void StiffnessMatrix::add(std::int32_t a, std::int32_t b, const Mat12& k) {
  const auto add = [&](std::int32_t row, std::int32_t column, const Mat3& block) {
    add_block(row, column, block);
  };
  assembly::scatter_pair(a, a, k.topLeftCorner<6, 6>(), *unknowns_, add);
  if (b == contact::no_body) return;
  assembly::scatter_pair(a, b, k.topRightCorner<6, 6>(), *unknowns_, add);
  assembly::scatter_pair(b, a, k.bottomLeftCorner<6, 6>(), *unknowns_, add);
  assembly::scatter_pair(b, b, k.bottomRightCorner<6, 6>(), *unknowns_, add);
}

void StiffnessMatrix::end() {
  EIGENGRAIN_PETSC(MatAssemblyBegin(mat(), MAT_FINAL_ASSEMBLY));
  EIGENGRAIN_PETSC(MatAssemblyEnd(mat(), MAT_FINAL_ASSEMBLY));
}

}  // namespace eigengrain::petsc
