#pragma once

#include <cstdint>
#include <vector>

/// Memory layout shared by the matrix-free product and its kernels.
namespace eigengrain::assembly::product {

/// A contact without shear: K = (√k_n n)(√k_n n)ᵀ on the translations. Half a cache line.
struct alignas(32) CentralRecord {
  double scaled_normal[3];  ///< √k_n n
  std::int32_t near_body;
  std::int32_t far_body;
};

/// A contact of balls, whose levers lie along n: R_near = near n, R_far = -far n. One cache line.
struct alignas(64) BallRecord {
  double normal[3];
  double shear;          ///< k_s
  double normal_excess;  ///< k_n - k_s
  double near;           ///< m
  double far;            ///< m
  std::int32_t near_body;
  std::int32_t far_body;
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
  std::int32_t near_body;
  std::int32_t far_body;
  std::int32_t unused[4];
};

/// `inner` records have both ends in the chunk; `cut` records act on their near end only, because the other
/// lies in another chunk, or is fixed. Both are in the order of their near ends.
template <class Record>
struct Records {
  std::vector<Record> inner;
  std::vector<Record> cut;
};

struct Chunk {
  std::int32_t first_body = 0;
  std::int32_t last_body = 0;  ///< one past
  std::int32_t first_block = 0;
  std::int32_t last_block = 0;  ///< one past
  Records<CentralRecord> central;
  Records<BallRecord> ball;
  Records<GeneralRecord> general;
};

/// Doubles a body takes in the padded vectors that kernels work on: u and a zero, then θ and a zero.
inline constexpr int translation_stride = 4;
inline constexpr int rotation_stride = 8;

/// Where the unknowns stand in a padded vector, and S.
struct Layout {
  int stride = translation_stride;
  std::vector<std::int32_t> slot;  ///< [blocks] in units of four doubles
  std::vector<double> scale;       ///< [3 blocks] the diagonal of S
};

/// The loops of a product over a chunk, for one instruction set. Padded vectors are 32-byte aligned.
struct Kernel {
  /// Puts S x into the padded vector of all bodies.
  void (*pad)(const Layout& layout, const Chunk& chunk, const double* x, double* padded);
  /// Adds K x to the padded sums of the chunk's bodies.
  void (*multiply)(const Layout& layout, const Chunk& chunk, const double* padded, double* sums);
  /// Takes y = S sums out of them.
  void (*strip)(const Layout& layout, const Chunk& chunk, const double* sums, double* y);
};

/// The kernel for this processor, chosen once.
const Kernel& best_kernel();

}  // namespace eigengrain::assembly::product
