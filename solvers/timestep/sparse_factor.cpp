#include "sparse_factor.hpp"

#include "eigengrain/assembly/scatter.hpp"

#include <algorithm>
#include <cstdint>
#include <vector>

namespace eigengrain::timestep {

using assembly::Unknowns;
using contact::ContactElement;

SparseMatrix shifted_stiffness(const Unknowns& unknowns, const assembly::StiffnessParts& parts,
                               std::span<const double> scale, double shift, double factor) {
  std::vector<Eigen::Triplet<double, SuiteSparse_long>> entries;
  entries.reserve(parts.contacts.size() * 78 + scale.size());
  for (std::size_t k = 0; k < scale.size(); ++k) entries.emplace_back(k, k, shift);
  const auto add = [&](std::int32_t row, std::int32_t column, const Mat3& block) {
    if (row < column) return;
    for (int i = 0; i < 3; ++i)
      for (int j = 0; j < 3; ++j) {
        const std::int64_t r = std::int64_t{3} * row + i;
        const std::int64_t c = std::int64_t{3} * column + j;
        if (r >= c)
          entries.emplace_back(
              r, c,
              factor * scale[static_cast<std::size_t>(r)] * block(i, j) * scale[static_cast<std::size_t>(c)]);
      }
  };
  for (const ContactElement& element : parts.contacts) assembly::scatter(element, unknowns, add);
  if (parts.nodal != nullptr) assembly::for_each_block(parts.nodal->k, add);
  SparseMatrix matrix(unknowns.size(), unknowns.size());
  matrix.setFromTriplets(entries.begin(), entries.end());
  return matrix;
}

SparseFactor::SparseFactor() {
  cholmod().print = 0;  // a matrix that is not positive definite is an answer here
}

double SparseFactor::numbers() const {
  return static_cast<double>(m_cholmodFactor->xsize);
}

// A supernode is a dense trapezoid: its columns and the rows that they share.
double SparseFactor::longest_row() const {
  const cholmod_factor& l = *m_cholmodFactor;
  const auto* first_column = static_cast<const SuiteSparse_long*>(l.super);
  const auto* first_row = static_cast<const SuiteSparse_long*>(l.pi);
  const auto* rows = static_cast<const SuiteSparse_long*>(l.s);
  std::vector<SuiteSparse_long> length(l.n, 0);
  for (std::size_t node = 0; node < l.nsuper; ++node)
    for (SuiteSparse_long k = first_row[node]; k < first_row[node + 1]; ++k)
      length[static_cast<std::size_t>(rows[k])] += first_column[node + 1] - first_column[node];
  return static_cast<double>(*std::max_element(length.begin(), length.end()));
}

}  // namespace eigengrain::timestep
