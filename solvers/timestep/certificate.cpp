#include "certificate.hpp"

#include "eigengrain/assembly/scatter.hpp"
#include "eigengrain/base/error.hpp"

#include <Eigen/CholmodSupport>
#include <Eigen/SparseCore>
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
using SparseMatrix = Eigen::SparseMatrix<double, Eigen::ColMajor, SuiteSparse_long>;

constexpr double unit_roundoff = 0.5 * std::numeric_limits<double>::epsilon();

/// A factor whose size is known before it is computed.
class Factor : public Eigen::CholmodSupernodalLLT<SparseMatrix, Eigen::Lower> {
 public:
  Factor() {
    cholmod().print = 0;  // a matrix that is not positive definite is an answer here
  }
  double numbers() const { return static_cast<double>(m_cholmodFactor->xsize); }

  /// The most numbers in a row. A supernode is a dense trapezoid: its columns and the rows that they share.
  double longest_row() const {
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
};

/// The lower triangle of sigma - S K S.
SparseMatrix shifted(const Unknowns& unknowns, std::span<const ContactElement> elements,
                     std::span<const double> scale, double sigma) {
  std::vector<Eigen::Triplet<double, SuiteSparse_long>> entries;
  entries.reserve(elements.size() * 78 + scale.size());
  for (std::size_t k = 0; k < scale.size(); ++k) entries.emplace_back(k, k, sigma);
  for (const ContactElement& element : elements)
    assembly::scatter(element, unknowns, [&](std::int32_t row, std::int32_t column, const Mat3& block) {
      if (row < column) return;
      for (int i = 0; i < 3; ++i)
        for (int j = 0; j < 3; ++j) {
          const std::int64_t r = std::int64_t{3} * row + i;
          const std::int64_t c = std::int64_t{3} * column + j;
          if (r >= c)
            entries.emplace_back(
                r, c, -scale[static_cast<std::size_t>(r)] * block(i, j) * scale[static_cast<std::size_t>(c)]);
        }
    });
  SparseMatrix matrix(unknowns.size(), unknowns.size());
  matrix.setFromTriplets(entries.begin(), entries.end());
  return matrix;
}

/// Bytes that the machine can give without swapping; infinite where it does not say.
double available_memory() {
  std::ifstream file("/proc/meminfo");
  std::string key;
  double kilobytes = 0;
  for (std::string rest; file >> key >> kilobytes; std::getline(file, rest))
    if (key == "MemAvailable:") return 1024 * kilobytes;
  return std::numeric_limits<double>::infinity();
}

/// Contacts of the body that has most of them.
double most_contacts(const Unknowns& unknowns, std::span<const ContactElement> elements) {
  std::vector<std::int32_t> count(static_cast<std::size_t>(unknowns.bodies()), 0);
  std::int32_t most = 0;
  for (const ContactElement& e : elements) {
    most = std::max(most, ++count[static_cast<std::size_t>(e.a)]);
    if (e.b != contact::no_body) most = std::max(most, ++count[static_cast<std::size_t>(e.b)]);
  }
  return most;
}

/// What the entries of S K S may have lost of its eigenvalues. Each is a sum over c contacts of products of
/// some twenty numbers, and errs by (c + 30)u of the sum of what they contribute, at most what they
/// contribute to the diagonal; a row has 6(c + 1) entries.
double lost_in_entries(double contacts, double largest_diagonal) {
  return 6 * (contacts + 1) * (contacts + 30) * unit_roundoff * largest_diagonal;
}

}  // namespace

void require_memory(double numbers, double available) {
  // The factor, and what supernodes are updated in: a tenth of it on packings.
  const double wanted = 1.2 * sizeof(double) * numbers;
  if (wanted > available)
    throw SolverError(
        fmt::format("the proof wants a sparse factor of {:.2g} numbers, about {:.1f} GB, and {:.1f} GB of "
                    "memory are free; do without it (no --certify), or prove the scene on a larger machine",
                    numbers, wanted / 1e9, available / 1e9));
}

std::optional<double> prove_below(const Unknowns& unknowns, std::span<const ContactElement> elements,
                                  std::span<const double> scale, double sigma) {
  const SparseMatrix matrix = shifted(unknowns, elements, scale, sigma);
  const Eigen::VectorXd diagonal = matrix.diagonal();
  // A diagonal entry that is not positive is an eigenvalue above sigma.
  if (!(diagonal.minCoeff() > 0)) return std::nullopt;
  Factor factor;
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
         lost_in_entries(most_contacts(unknowns, elements), sigma);
}

}  // namespace eigengrain::timestep
