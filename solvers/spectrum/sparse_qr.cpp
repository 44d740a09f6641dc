#include "sparse_qr.hpp"

#include "eigengrain/base/error.hpp"

#include <SuiteSparseQR.hpp>
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

namespace eigengrain::spectrum {

struct SparseQr::Common {
  Common() { cholmod_l_start(&of); }
  ~Common() { cholmod_l_finish(&of); }
  Common(const Common&) = delete;
  Common& operator=(const Common&) = delete;
  cholmod_common of{};
};

namespace {

/// Gives a piece of CHOLMOD's memory back.
template <class T, class Free>
class Kept {
 public:
  Kept(T* pointer, cholmod_common& common, const char* what, Free free)
      : pointer_(pointer), common_(common), free_(free) {
    if (pointer_ == nullptr)
      throw SolverError(fmt::format("SuiteSparseQR failed with status {} at {}{}", common.status, what,
                                    common.status == CHOLMOD_OUT_OF_MEMORY ? " (not enough memory)" : ""));
  }
  ~Kept() { free_(&pointer_, &common_); }
  Kept(const Kept&) = delete;
  Kept& operator=(const Kept&) = delete;
  T* get() const { return pointer_; }

 private:
  T* pointer_;
  cholmod_common& common_;
  Free free_;
};

}  // namespace

SparseQr::SparseQr() : common_(std::make_unique<Common>()) {
  common_->of.print = 0;
}
SparseQr::~SparseQr() = default;

QrResult SparseQr::decompose(std::span<const Entry> entries, std::int64_t rows, std::int64_t columns,
                             bool transposed, double tolerance, bool null_space) {
  cholmod_common& common = common_->of;
  if (transposed) std::swap(rows, columns);
  const Kept triplet(
      cholmod_l_allocate_triplet(static_cast<std::size_t>(rows), static_cast<std::size_t>(columns),
                                 entries.size(), 0, CHOLMOD_REAL, &common),
      common, "the entries", cholmod_l_free_triplet);
  auto* i = static_cast<SuiteSparse_long*>(triplet.get()->i);
  auto* j = static_cast<SuiteSparse_long*>(triplet.get()->j);
  auto* x = static_cast<double*>(triplet.get()->x);
  for (std::size_t k = 0; k < entries.size(); ++k) {
    i[k] = transposed ? entries[k].column : entries[k].row;
    j[k] = transposed ? entries[k].row : entries[k].column;
    x[k] = entries[k].value;
  }
  triplet.get()->nnz = entries.size();
  const Kept matrix(cholmod_l_triplet_to_sparse(triplet.get(), entries.size(), &common), common, "the matrix",
                    cholmod_l_free_sparse);
  QrResult result;
  if (!null_space) {
    result.rank =
        SuiteSparseQR<double>(SPQR_ORDERING_DEFAULT, tolerance, 0, 0, matrix.get(), nullptr, nullptr, nullptr,
                              nullptr, nullptr, nullptr, nullptr, nullptr, nullptr, &common);
    if (result.rank < 0 || common.status < 0)
      throw SolverError(fmt::format("SuiteSparseQR failed with status {}{}", common.status,
                                    common.status == CHOLMOD_OUT_OF_MEMORY ? " (not enough memory)" : ""));
    return result;
  }
  const Kept factors(SuiteSparseQR_factorize<double>(SPQR_ORDERING_DEFAULT, tolerance, matrix.get(), &common),
                     common, "the decomposition", SuiteSparseQR_free<double>);
  result.rank = factors.get()->rank;
  const std::int64_t left = rows - result.rank;
  result.null_space.resize(rows, left);
  if (left == 0) return result;
  const Kept units(
      cholmod_l_zeros(static_cast<std::size_t>(rows), static_cast<std::size_t>(left), CHOLMOD_REAL, &common),
      common, "the null space", cholmod_l_free_dense);
  auto* unit = static_cast<double*>(units.get()->x);
  for (std::int64_t k = 0; k < left; ++k) unit[k * rows + result.rank + k] = 1;
  const Kept beyond(SuiteSparseQR_qmult<double>(SPQR_QX, factors.get(), units.get(), &common), common,
                    "the null space", cholmod_l_free_dense);
  result.null_space =
      Eigen::Map<const Eigen::MatrixXd>(static_cast<const double*>(beyond.get()->x), rows, left);
  return result;
}

double largest_row_and_column(std::span<const Entry> entries, std::int64_t rows, std::int64_t columns) {
  std::vector<double> row(static_cast<std::size_t>(rows), 0.0);
  std::vector<double> column(static_cast<std::size_t>(columns), 0.0);
  for (const Entry& e : entries) {
    row[static_cast<std::size_t>(e.row)] += std::abs(e.value);
    column[static_cast<std::size_t>(e.column)] += std::abs(e.value);
  }
  return std::sqrt(*std::ranges::max_element(row) * *std::ranges::max_element(column));
}

double largest_image(std::span<const Entry> entries, std::int64_t rows, const Eigen::MatrixXd& columns,
                     bool transposed) {
  if (columns.cols() == 0) return 0;
  Eigen::MatrixXd image = Eigen::MatrixXd::Zero(rows, columns.cols());
  for (const Entry& e : entries) {
    if (transposed)
      image.row(e.column) += e.value * columns.row(e.row);
    else
      image.row(e.row) += e.value * columns.row(e.column);
  }
  return image.colwise().norm().maxCoeff();
}

}  // namespace eigengrain::spectrum
