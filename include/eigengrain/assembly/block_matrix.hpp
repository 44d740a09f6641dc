#pragma once

#include "eigengrain/assembly/linear_system.hpp"

#include <cstdint>
#include <vector>

namespace eigengrain::assembly {

/// A sparse matrix of 3×3 blocks in compressed rows (the BSR of other libraries), for whoever takes matrices
/// whole: scripts, files, other solvers.
struct BlockMatrix {
  std::int32_t block_rows = 0;
  std::int32_t block_columns = 0;
  std::vector<std::int32_t> offsets{0};  ///< [block_rows + 1] where the blocks of a row begin
  std::vector<std::int32_t> columns;     ///< [blocks] increasing in each row
  std::vector<double> values;            ///< [blocks × 3 × 3] each block row after row

  std::int64_t rows() const { return std::int64_t{3} * block_rows; }
  std::int64_t column_count() const { return std::int64_t{3} * block_columns; }
};

/// K [unknowns × unknowns], both triangles, N/m, N, N m; masked rows and columns are zero. To the bit
/// symmetric. Cost O(contacts).
BlockMatrix stiffness_blocks(const LinearSystem& system);

/// B [6 elements × unknowns]: rows of element e are its relative displacement δ (m) and rotation φ (rad),
/// docs/theory.md. Columns of masked components are zero, those of clumps along their axes: K = BᵀDB.
BlockMatrix kinematic_blocks(const LinearSystem& system);

/// D [6 elements × 6 elements], block diagonal: translation (N/m) and rotation (N m) of each element.
BlockMatrix elasticity_blocks(const LinearSystem& system);

}  // namespace eigengrain::assembly
