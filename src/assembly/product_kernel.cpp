// The inner loop of the matrix-free product. This file is compiled once for each instruction set
// (CMakeLists.txt); EIGENGRAIN_KERNEL is the name of what it offers there. A vector of space is one
// 4-wide register whose last lane is padding: it is zero in x, and what lands there in y is never read.
#include "product_records.hpp"

#include <iterator>

namespace eigengrain::assembly::product {
namespace {

using Lanes = double __attribute__((vector_size(32)));
using UnalignedLanes = double __attribute__((vector_size(32), aligned(8)));

inline Lanes load(const double* from) {
  return *reinterpret_cast<const Lanes*>(from);
}
inline Lanes load_unaligned(const double* from) {
  return *reinterpret_cast<const UnalignedLanes*>(from);
}
inline void store(double* to, Lanes v) {
  *reinterpret_cast<Lanes*>(to) = v;
}
inline void store_unaligned(double* to, Lanes v) {
  *reinterpret_cast<UnalignedLanes*>(to) = v;
}
inline void add_to(double* to, Lanes v) {
  *reinterpret_cast<Lanes*>(to) += v;
}
inline Lanes spread(double s) {
  return Lanes{s, s, s, s};
}

inline double dot(Lanes a, Lanes b) {
  const Lanes p = a * b;
  return p[0] + p[1] + p[2];
}

inline Lanes cross(Lanes a, Lanes b) {
  const Lanes a_yzx = __builtin_shufflevector(a, a, 1, 2, 0, 3);
  const Lanes b_yzx = __builtin_shufflevector(b, b, 1, 2, 0, 3);
  const Lanes zxy = a * b_yzx - a_yzx * b;
  return __builtin_shufflevector(zxy, zxy, 1, 2, 0, 3);
}

struct Vector6 {
  Lanes u;
  Lanes theta;
};

/// What a contact does to its two ends.
struct EndForces {
  Vector6 near;
  Vector6 far;
};

inline EndForces force(const CentralRecord& c, const Vector6& near, const double* far) {
  const Lanes n = load(c.scaled_normal);
  const Lanes f = spread(dot(load(far) - near.u, n)) * n;
  return {{-f, Lanes{}}, {f, Lanes{}}};
}

inline EndForces force(const BallRecord& c, const Vector6& near, const double* far) {
  const Lanes n = load(c.normal);
  const Lanes turn = spread(c.near) * near.theta + spread(c.far) * load(far + 4);
  // δ = u_b - u_a + θ_b × R_b - θ_a × R_a with R_a = near n, R_b = -far n
  const Lanes delta = load(far) - near.u - cross(turn, n);
  const Lanes f = spread(c.shear) * delta + spread(c.normal_excess * dot(delta, n)) * n;
  const Lanes moment = cross(n, f);
  return {{-f, -spread(c.near) * moment}, {f, -spread(c.far) * moment}};
}

inline EndForces force(const GeneralRecord& c, const Vector6& near, const double* far) {
  const Lanes n = load(c.normal);
  const Lanes lever_near = load_unaligned(c.lever_near);
  const Lanes lever_far = load_unaligned(c.lever_far);
  const Lanes far_theta = load(far + 4);
  const Lanes delta = load(far) - near.u + cross(far_theta, lever_far) - cross(near.theta, lever_near);
  const Lanes phi = far_theta - near.theta;
  const Lanes f = spread(c.shear) * delta + spread(c.normal_excess * dot(delta, n)) * n;
  const Lanes m = spread(c.bending) * phi + spread(c.twist_excess * dot(phi, n)) * n;
  return {{-f, -(cross(lever_near, f) + m)}, {f, cross(lever_far, f) + m}};
}

/// Records ahead of the present one whose far ends are asked for. They lie anywhere in the neighbourhood;
/// asking for none makes a product of 100,000 balls half as long again, asking 8 ahead gains less than 24.
constexpr std::ptrdiff_t lookahead = 24;

template <bool Rotation, bool BothEnds, class Record>
inline void multiply_list(const std::vector<Record>& records, std::int64_t first_body, const double* x,
                          double* sums) {
  constexpr std::int64_t stride = Rotation ? rotation_stride : translation_stride;
  const Record* const last = records.data() + std::ssize(records) - 1;
  for (const Record* c = records.data(); c <= last; ++c) {
    const Record& ahead = last - c > lookahead ? c[lookahead] : *last;
    __builtin_prefetch(x + stride * ahead.far_body);
    if constexpr (BothEnds) __builtin_prefetch(sums + stride * (ahead.far_body - first_body), 1);

    const double* x_near = x + stride * c->near_body;
    Vector6 near{load(x_near), Lanes{}};
    if constexpr (Rotation) near.theta = load(x_near + 4);
    const EndForces f = force(*c, near, x + stride * c->far_body);
    double* sum_near = sums + stride * (c->near_body - first_body);
    add_to(sum_near, f.near.u);
    if constexpr (Rotation) add_to(sum_near + 4, f.near.theta);
    if constexpr (BothEnds) {
      double* sum_far = sums + stride * (c->far_body - first_body);
      add_to(sum_far, f.far.u);
      if constexpr (Rotation) add_to(sum_far + 4, f.far.theta);
    }
  }
}

template <bool Rotation, class Record>
inline void multiply_records(const Records<Record>& records, std::int64_t first_body, const double* x,
                             double* sums) {
  if (!records.inner.empty()) multiply_list<Rotation, true>(records.inner, first_body, x, sums);
  if (!records.cut.empty()) multiply_list<Rotation, false>(records.cut, first_body, x, sums);
}

void multiply(const Layout& layout, const Chunk& chunk, const double* padded, double* sums) {
  if (layout.stride == translation_stride)
    return multiply_records<false>(chunk.central, chunk.first_body, padded, sums);
  multiply_records<true>(chunk.central, chunk.first_body, padded, sums);
  multiply_records<true>(chunk.ball, chunk.first_body, padded, sums);
  multiply_records<true>(chunk.general, chunk.first_body, padded, sums);
}

// Vectors are packed, three numbers a block, and are read and written four at a time: the fourth belongs to
// the next block and is dropped, or overwritten when its turn comes. The last block of a chunk must stop
// short.

void pad(const Layout& layout, const Chunk& chunk, const double* x, double* padded) {
  const std::int32_t* slot = layout.slot.data();
  const double* scale = layout.scale.data();
  std::int64_t block = chunk.first_block;
  for (; block + 1 < chunk.last_block; ++block) {
    const Lanes scaled = load_unaligned(scale + 3 * block) * load_unaligned(x + 3 * block);
    store(padded + std::int64_t{4} * slot[block], __builtin_shufflevector(scaled, Lanes{}, 0, 1, 2, 4));
  }
  for (; block < chunk.last_block; ++block)
    for (std::int64_t k = 0; k < 3; ++k)
      padded[std::int64_t{4} * slot[block] + k] = scale[3 * block + k] * x[3 * block + k];
}

void strip(const Layout& layout, const Chunk& chunk, const double* sums, double* y) {
  const std::int32_t* slot = layout.slot.data();
  const double* scale = layout.scale.data();
  const std::int64_t start = std::int64_t{layout.stride} * chunk.first_body;
  std::int64_t block = chunk.first_block;
  for (; block + 1 < chunk.last_block; ++block)
    store_unaligned(y + 3 * block,
                    load_unaligned(scale + 3 * block) * load(sums + (std::int64_t{4} * slot[block] - start)));
  for (; block < chunk.last_block; ++block)
    for (std::int64_t k = 0; k < 3; ++k)
      y[3 * block + k] = scale[3 * block + k] * sums[std::int64_t{4} * slot[block] - start + k];
}

}  // namespace

extern const Kernel EIGENGRAIN_KERNEL;
const Kernel EIGENGRAIN_KERNEL{pad, multiply, strip};

}  // namespace eigengrain::assembly::product
