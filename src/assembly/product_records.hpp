#pragma once

#include <cstdint>
#include <vector>

/// Memory layout shared by the matrix-free product and its kernels.
namespace eigengrain::assembly::product {

/// A contact without shear: K = (√k_n n)(√k_n n)ᵀ on the translations. Half a cache line.
struct alignas(32) CentralRecord {
  double scaled_normal[3];  ///< √k_n n
  std::int32_t other;       ///< body at the far end
  std::int32_t unused;
};

/// A contact of balls, whose levers lie along n: R_near = near n, R_far = -far n. One cache line.
struct alignas(64) BallRecord {
  double normal[3];
  double shear;          ///< k_s
  double normal_excess;  ///< k_n - k_s
  double near;           ///< m
  double far;            ///< m
  std::int32_t other;
  std::int32_t unused;
};

/// Any contact. Two cache lines.
struct alignas(64) GeneralRecord {
  double normal[3];
  double shear;          ///< k_s
  double lever_near[3];  ///< R at the near end
  double normal_excess;  ///< k_n - k_s
  double lever_far[3];   ///< R at the far end
  double bending;        ///< κ_s
  double twist_excess;   ///< κ_n - κ_s
  std::int32_t other;
  std::int32_t unused[5];
};

/// Where the records of each body of a chunk begin; `inner` records have both ends in the chunk and stand
/// with one of them, `cut` records act on their near end only (the other lies in another chunk, or is fixed).
struct Rows {
  std::vector<std::int64_t> inner;  ///< [bodies of the chunk + 1]
  std::vector<std::int64_t> cut;    ///< [bodies of the chunk + 1]
};

template <class Record>
struct Records {
  Rows rows;
  std::vector<Record> inner;
  std::vector<Record> cut;
};

struct Chunk {
  std::int32_t first = 0;  ///< bodies [first, last)
  std::int32_t last = 0;
  Records<CentralRecord> central;
  Records<BallRecord> ball;
  Records<GeneralRecord> general;
};

/// Doubles a body takes in the padded vectors that kernels work on: u and a zero, then θ and a zero.
inline constexpr int translation_stride = 4;
inline constexpr int rotation_stride = 8;

/// Adds the chunk's K x to y. x, y: padded vectors, 32-byte aligned, with `stride` doubles a body.
using Kernel = void (*)(const Chunk& chunk, int stride, const double* x, double* y);

/// The kernel for this processor, chosen once.
Kernel best_kernel();

}  // namespace eigengrain::assembly::product
