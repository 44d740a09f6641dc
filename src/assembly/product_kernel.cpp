// The inner loop of the matrix-free product. This file is compiled once for each instruction set
// (CMakeLists.txt); EIGENGRAIN_KERNEL is the name that it gives its function there. A vector of space is one
// 4-wide register whose last lane is padding: it is zero in x, and what lands there in y is never read.
#include "product_records.hpp"

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

template <bool Rotation, class Record>
inline void apply_records(const Records<Record>& records, std::int32_t first, std::int32_t bodies,
                          const double* x, double* y) {
  constexpr int stride = Rotation ? rotation_stride : translation_stride;
  for (std::int32_t i = 0; i < bodies; ++i) {
    const auto row = static_cast<std::size_t>(i);
    const double* x_near = x + std::int64_t{stride} * (first + i);
    Vector6 near{load(x_near), Lanes{}};
    if constexpr (Rotation) near.theta = load(x_near + 4);
    Vector6 sum{Lanes{}, Lanes{}};
    for (std::int64_t c = records.rows.inner[row]; c < records.rows.inner[row + 1]; ++c) {
      const Record& record = records.inner[static_cast<std::size_t>(c)];
      const std::int64_t far = std::int64_t{stride} * record.other;
      const EndForces f = force(record, near, x + far);
      sum.u += f.near.u;
      add_to(y + far, f.far.u);
      if constexpr (Rotation) {
        sum.theta += f.near.theta;
        add_to(y + far + 4, f.far.theta);
      }
    }
    for (std::int64_t c = records.rows.cut[row]; c < records.rows.cut[row + 1]; ++c) {
      const Record& record = records.cut[static_cast<std::size_t>(c)];
      const EndForces f = force(record, near, x + std::int64_t{stride} * record.other);
      sum.u += f.near.u;
      if constexpr (Rotation) sum.theta += f.near.theta;
    }
    double* y_near = y + std::int64_t{stride} * (first + i);
    add_to(y_near, sum.u);
    if constexpr (Rotation) add_to(y_near + 4, sum.theta);
  }
}

}  // namespace

void EIGENGRAIN_KERNEL(const Chunk& chunk, int stride, const double* x, double* y) {
  const std::int32_t bodies = chunk.last - chunk.first;
  if (stride == translation_stride) {
    if (!chunk.central.rows.inner.empty()) apply_records<false>(chunk.central, chunk.first, bodies, x, y);
    return;
  }
  if (!chunk.central.rows.inner.empty()) apply_records<true>(chunk.central, chunk.first, bodies, x, y);
  if (!chunk.ball.rows.inner.empty()) apply_records<true>(chunk.ball, chunk.first, bodies, x, y);
  if (!chunk.general.rows.inner.empty()) apply_records<true>(chunk.general, chunk.first, bodies, x, y);
}

}  // namespace eigengrain::assembly::product
