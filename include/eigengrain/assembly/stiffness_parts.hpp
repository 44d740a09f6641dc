#pragma once

#include "eigengrain/base/vec.hpp"
#include "eigengrain/contact/element.hpp"

#include <cstdint>
#include <span>
#include <vector>

namespace eigengrain::assembly {

/// A sparse matrix of 3×3 blocks in compressed rows (the BSR of other libraries).
struct BlockMatrix {
  std::int32_t block_rows = 0;
  std::int32_t block_columns = 0;
  std::vector<std::int32_t> offsets{0};  ///< [block_rows + 1] where the blocks of a row begin
  std::vector<std::int32_t> columns;     ///< [blocks] increasing in each row
  std::vector<double> values;            ///< [blocks × 3 × 3] each block row after row

  std::int64_t rows() const { return std::int64_t{3} * block_rows; }
  std::int64_t column_count() const { return std::int64_t{3} * block_columns; }
};

/// A pattern of blocks from their columns, row after row and in any order; values are zero.
BlockMatrix with_pattern(std::vector<std::vector<std::int32_t>> rows, std::int32_t columns);
/// Adds to a block of the pattern.
void add_to(BlockMatrix& matrix, std::int32_t row, std::int32_t column, const Mat3& block);

/// The part of K whose elements have more than two bodies: finite elements, and contacts with their skins. It
/// is assembled, as nodes of a mesh share most of their blocks.
struct NodalStiffness {
  BlockMatrix k;  ///< [unknowns × unknowns] both triangles, N/m, N, N m; masked rows and columns are zero
  std::vector<double> viscous;  ///< [as k.values] dashpots, N s/m, N s, N m s; empty: there are none
  /// [bodies] Σ n_e K_e,ii over the elements e of a body, n_e their bodies that can move: K is nowhere larger
  /// than this block diagonal, as (Σ x_i)² <= n Σ x_i². On (u, θ) along the axes of space.
  std::vector<Mat6> bound;
  std::vector<Mat6> viscous_bound;  ///< the same of `viscous`

  bool empty() const { return k.block_rows == 0; }
};

/// All that K is made of.
struct StiffnessParts {
  // NOLINTBEGIN(google-explicit-constructor): contacts alone are the usual case
  StiffnessParts(std::span<const contact::ContactElement> elements) : contacts(elements) {}
  StiffnessParts(const std::vector<contact::ContactElement>& elements) : contacts(elements) {}
  // NOLINTEND(google-explicit-constructor)
  StiffnessParts(std::span<const contact::ContactElement> elements, const NodalStiffness& of_nodes)
      : contacts(elements), nodal(of_nodes.empty() ? nullptr : &of_nodes) {}

  std::span<const contact::ContactElement> contacts;
  const NodalStiffness* nodal = nullptr;  ///< null: nothing but contacts of two bodies
};

/// Calls add(row block, column block, 3×3 block) for every block of a nodal part.
template <class Add>
void for_each_block(const BlockMatrix& matrix, const Add& add) {
  using RowMajor3 = Eigen::Matrix<double, 3, 3, Eigen::RowMajor>;
  for (std::int32_t row = 0; row < matrix.block_rows; ++row)
    for (std::int32_t k = matrix.offsets[static_cast<std::size_t>(row)];
         k < matrix.offsets[static_cast<std::size_t>(row) + 1]; ++k)
      add(row, matrix.columns[static_cast<std::size_t>(k)],
          Mat3(Eigen::Map<const RowMajor3>(&matrix.values[9 * static_cast<std::size_t>(k)])));
}

}  // namespace eigengrain::assembly
