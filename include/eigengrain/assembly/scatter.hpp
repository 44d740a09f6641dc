#pragma once

#include "eigengrain/assembly/unknowns.hpp"
#include "eigengrain/contact/element.hpp"

namespace eigengrain::assembly {

/// The block with the rows and columns of fixed components set to zero.
inline Mat3 masked(const Unknowns& unknowns, std::int32_t row, std::int32_t column, Mat3 block) {
  for (int k = 0; k < Unknowns::block_size; ++k) {
    if (unknowns.is_fixed(row, k)) block.row(k).setZero();
    if (unknowns.is_fixed(column, k)) block.col(k).setZero();
  }
  return block;
}

/// Calls add(row block, column block, 3×3 block) for every part of a 6×6 on (u, θ) of two bodies that has
/// unknowns; θ along the axes of the unknowns.
template <class Add>
void scatter_pair(std::int32_t row_body, std::int32_t column_body, const Mat6& block,
                  const Unknowns& unknowns, const Add& add) {
  const auto rows = unknowns.of(row_body);
  const auto columns = unknowns.of(column_body);
  for (std::size_t i = 0; i < 2; ++i)
    for (std::size_t j = 0; j < 2; ++j) {
      if (rows[i] == Unknowns::none || columns[j] == Unknowns::none) continue;
      const Mat3 part = block.block<3, 3>(static_cast<int>(3 * i), static_cast<int>(3 * j));
      add(rows[i], columns[j], masked(unknowns, rows[i], columns[j], part));
    }
}

/// The same for every part of a contact's K: 16 calls between two balls with rotations, 4 at a wall, fewer
/// without rotations. For a body that touches its own image the same block is met several times; the parts
/// add up.
template <class Add>
void scatter(const contact::ContactElement& element, const Unknowns& unknowns, const Add& add) {
  contact::ContactBlocks k = contact::stiffness_blocks(element);
  if (unknowns.has_axes()) {
    k.aa = unknowns.in_own_axes(element.a, element.a, k.aa);
    k.ab = unknowns.in_own_axes(element.a, element.b, k.ab);
    k.bb = unknowns.in_own_axes(element.b, element.b, k.bb);
  }
  scatter_pair(element.a, element.a, k.aa, unknowns, add);
  if (element.b == contact::no_body) return;
  scatter_pair(element.a, element.b, k.ab, unknowns, add);
  scatter_pair(element.b, element.a, k.ab.transpose(), unknowns, add);
  scatter_pair(element.b, element.b, k.bb, unknowns, add);
}

}  // namespace eigengrain::assembly
