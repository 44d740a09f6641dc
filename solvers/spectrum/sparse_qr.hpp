#pragma once

#include <Eigen/Core>

#include <cstdint>
#include <memory>
#include <span>

/// Rank-revealing decompositions of sparse matrices by SuiteSparseQR.
namespace eigengrain::spectrum {

struct Entry {
  std::int64_t row = 0;
  std::int64_t column = 0;
  double value = 0;
};

struct QrResult {
  std::int64_t rank = 0;
  /// [rows of what was decomposed × rows - rank] orthonormal: what is orthogonal to its columns. Empty unless
  /// asked for.
  Eigen::MatrixXd null_space;
};

class SparseQr {
 public:
  SparseQr();
  ~SparseQr();
  SparseQr(const SparseQr&) = delete;
  SparseQr& operator=(const SparseQr&) = delete;

  /// The matrix of these entries [rows × columns], those of one place added up, or its transpose. What is
  /// below the tolerance counts as zero. Throws SolverError where it does not fit into memory.
  QrResult decompose(std::span<const Entry> entries, std::int64_t rows, std::int64_t columns, bool transposed,
                     double tolerance, bool null_space);

 private:
  struct Common;
  std::unique_ptr<Common> common_;
};

/// √(‖S‖₁ ‖S‖_∞), which bounds the largest singular value.
double largest_row_and_column(std::span<const Entry> entries, std::int64_t rows, std::int64_t columns);

/// The largest |S x|, or |Sᵀ x|, of the columns x; `rows` are those of the result.
double largest_image(std::span<const Entry> entries, std::int64_t rows, const Eigen::MatrixXd& columns,
                     bool transposed);

}  // namespace eigengrain::spectrum
