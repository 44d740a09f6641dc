#include "certificate.hpp"

#include "eigengrain/base/error.hpp"

#include "memory.hpp"
#include "sparse_factor.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <fstream>
#include <limits>
#include <string>
#include <vector>

namespace eigengrain::timestep {
namespace {

using assembly::Unknowns;
using contact::ContactElement;

constexpr double unit_roundoff = 0.5 * std::numeric_limits<double>::epsilon();

/// Contacts of the body that has most of them.
double most_contacts(const Unknowns& unknowns, const assembly::StiffnessParts& parts) {
  std::vector<std::int32_t> count(static_cast<std::size_t>(unknowns.bodies()), 0);
  std::int32_t most = 0;
  for (const ContactElement& e : parts.contacts) {
    most = std::max(most, ++count[static_cast<std::size_t>(e.a)]);
    if (e.b != contact::no_body) most = std::max(most, ++count[static_cast<std::size_t>(e.b)]);
  }
  if (parts.nodal == nullptr) return most;
  // A block of a row is met once in the sum of its elements; a row has no more of these than blocks.
  const std::vector<std::int32_t>& offsets = parts.nodal->k.offsets;
  std::int32_t longest = 0;
  for (std::size_t row = 1; row < offsets.size(); ++row)
    longest = std::max(longest, offsets[row] - offsets[row - 1]);
  return most + 4 * longest;  // a tetrahedron has four integration points at most, a brick twice as many as
                              // nodes share
}

/// What the entries of S K S may have lost of its eigenvalues. Each is a sum over c contacts of products of
/// some twenty numbers, and errs by (c + 30)u of the sum of what they contribute, at most what they
/// contribute to the diagonal; a row has 6(c + 1) entries.
double lost_in_entries(double contacts, double largest_diagonal) {
  return 6 * (contacts + 1) * (contacts + 30) * unit_roundoff * largest_diagonal;
}

}  // namespace

std::optional<double> prove_below(const Unknowns& unknowns, const assembly::StiffnessParts& parts,
                                  std::span<const double> scale, double sigma) {
  const SparseMatrix matrix = shifted_stiffness(unknowns, parts, scale, sigma, -1);
  const Eigen::VectorXd diagonal = matrix.diagonal();
  // A diagonal entry that is not positive is an eigenvalue above sigma.
  if (!(diagonal.minCoeff() > 0)) return std::nullopt;
  SparseFactor factor;
  factor.analyzePattern(matrix);
  if (factor.info() != Eigen::Success || factor.cholmod().status != CHOLMOD_OK)
    throw SolverError(fmt::format(
        "CHOLMOD could not order the matrix of the proof (status {}); do without it (no --certify)",
        factor.cholmod().status));
  require_memory(factor.numbers(), available_memory());
  factor.factorize(matrix);
  const int status = factor.cholmod().status;
  if (status == CHOLMOD_NOT_POSDEF || factor.info() == Eigen::NumericalIssue) return std::nullopt;
  if (status != CHOLMOD_OK)
    throw SolverError(
        fmt::format("CHOLMOD failed with status {} in the proof ({}); do without it (no --certify)", status,
                    status == CHOLMOD_OUT_OF_MEMORY ? "not enough memory" : "see cholmod.h for its meaning"));
  const double terms = (factor.longest_row() + 2) * unit_roundoff;
  const double gamma = terms / (1 - terms);
  return sigma + gamma / (1 - gamma) * diagonal.sum() +
         lost_in_entries(most_contacts(unknowns, parts), sigma);
}

}  // namespace eigengrain::timestep
