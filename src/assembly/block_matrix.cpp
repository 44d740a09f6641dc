#include "eigengrain/assembly/block_matrix.hpp"

#include "eigengrain/assembly/scatter.hpp"
#include "eigengrain/base/error.hpp"

#include <Eigen/Core>

#include <algorithm>
#include <cstddef>
#include <utility>

namespace eigengrain::assembly {
namespace {

using contact::ContactElement;
using RowMajor3 = Eigen::Matrix<double, 3, 3, Eigen::RowMajor>;

constexpr std::size_t block_numbers = 9;

Eigen::Map<RowMajor3> block_at(BlockMatrix& matrix, std::size_t index) {
  return Eigen::Map<RowMajor3>(matrix.values.data() + block_numbers * index);
}

void require_contacts_alone(const LinearSystem& system) {
  if (!system.nodal.empty())
    throw InputError(
        "B and D are those of contacts, and the scene has deformable bodies, so K is not BᵀDB; ask for K and "
        "M alone");
}

}  // namespace

BlockMatrix stiffness_blocks(const LinearSystem& system) {
  const Unknowns& unknowns = system.unknowns;
  std::vector<std::vector<std::int32_t>> rows(static_cast<std::size_t>(unknowns.blocks()));
  const auto couple = [&](std::int32_t row_body, std::int32_t column_body) {
    for (const std::int32_t row : unknowns.of(row_body))
      for (const std::int32_t column : unknowns.of(column_body))
        if (row != Unknowns::none && column != Unknowns::none) rows[row].push_back(column);
  };
  for (const ContactElement& e : system.elements)
    for (const std::int32_t first : {e.a, e.b})
      for (const std::int32_t second : {e.a, e.b})
        if (first != contact::no_body && second != contact::no_body) couple(first, second);
  for_each_block(system.nodal.k,
                 [&](std::int32_t row, std::int32_t column, const Mat3&) { rows[row].push_back(column); });
  BlockMatrix matrix = with_pattern(std::move(rows), unknowns.blocks());
  for_each_block(system.nodal.k, [&](std::int32_t row, std::int32_t column, const Mat3& block) {
    if (row >= column) add_to(matrix, row, column, block);
  });
  for (const ContactElement& e : system.elements)
    scatter(e, unknowns, [&](std::int32_t row, std::int32_t column, const Mat3& block) {
      if (row >= column) add_to(matrix, row, column, block);
    });
  // The upper triangle is a copy of the lower one, and the diagonal its own mean: what is summed in another
  // order rounds otherwise.
  for (std::int32_t row = 0; row < matrix.block_rows; ++row)
    for (std::int32_t k = matrix.offsets[row]; k < matrix.offsets[row + 1]; ++k) {
      const std::int32_t column = matrix.columns[k];
      const Mat3 block = block_at(matrix, static_cast<std::size_t>(k));
      if (row == column)
        block_at(matrix, static_cast<std::size_t>(k)) = 0.5 * (block + block.transpose());
      else if (row > column)
        add_to(matrix, column, row, block.transpose());
    }
  return matrix;
}

BlockMatrix kinematic_blocks(const LinearSystem& system) {
  require_contacts_alone(system);
  const Unknowns& unknowns = system.unknowns;
  std::vector<std::vector<std::int32_t>> rows(2 * system.elements.size());
  for (std::size_t e = 0; e < system.elements.size(); ++e)
    for (const std::int32_t body : {system.elements[e].a, system.elements[e].b}) {
      const auto [u, theta] = unknowns.of(body);
      if (u != Unknowns::none) rows[2 * e].push_back(u);
      if (theta == Unknowns::none) continue;
      rows[2 * e].push_back(theta);
      rows[2 * e + 1].push_back(theta);
    }
  BlockMatrix matrix = with_pattern(std::move(rows), unknowns.blocks());
  const auto add = [&](std::size_t row, std::int32_t column, Mat3 block) {
    if (column == Unknowns::none) return;
    for (int k = 0; k < Unknowns::block_size; ++k)
      if (unknowns.is_fixed(column, k)) block.col(k).setZero();
    add_to(matrix, static_cast<std::int32_t>(row), column, block);
  };
  for (std::size_t e = 0; e < system.elements.size(); ++e) {
    const ContactElement& element = system.elements[e];
    const auto add_end = [&](std::int32_t body, double sign, const Vec3& lever) {
      const auto [u, theta] = unknowns.of(body);
      const Mat3* axes = unknowns.axes(body);
      const Mat3 turn = axes != nullptr ? *axes : Mat3(Mat3::Identity());
      add(2 * e, u, sign * Mat3::Identity());
      add(2 * e, theta, -sign * cross_matrix(lever) * turn);
      add(2 * e + 1, theta, sign * turn);
    };
    add_end(element.a, -1, element.lever_a);
    if (element.b != contact::no_body) add_end(element.b, 1, element.lever_b);
  }
  return matrix;
}

BlockMatrix elasticity_blocks(const LinearSystem& system) {
  require_contacts_alone(system);
  BlockMatrix matrix;
  matrix.block_rows = matrix.block_columns = static_cast<std::int32_t>(2 * system.elements.size());
  matrix.values.resize(block_numbers * 2 * system.elements.size());
  for (std::int32_t k = 0; k < matrix.block_rows; ++k) {
    matrix.columns.push_back(k);
    matrix.offsets.push_back(k + 1);
  }
  for (std::size_t e = 0; e < system.elements.size(); ++e) {
    const ContactElement& element = system.elements[e];
    const Mat3 along = element.stiffness.translation(element.normal);
    const Mat3 about = element.stiffness.rotation(element.normal);
    block_at(matrix, 2 * e) = 0.5 * (along + along.transpose());  // symmetric to the bit
    block_at(matrix, 2 * e + 1) = 0.5 * (about + about.transpose());
  }
  return matrix;
}

}  // namespace eigengrain::assembly
