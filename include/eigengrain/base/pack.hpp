#pragma once

#include <Eigen/Core>

#include <cmath>
#include <cstdint>

/// Several numbers that are computed with at once, one in each lane of a vector register. Code that is
/// written for a type `Real` runs with double, and with Pack<lanes> for as many contacts as there are lanes.
/// Where lanes differ in what they do, both is computed and select() takes one of the two.
namespace eigengrain {
namespace detail {

template <class Number, int lanes>
struct VectorOf {
  typedef Number type __attribute__((vector_size(lanes * sizeof(Number))));  // NOLINT(modernize-use-using)
};

}  // namespace detail

/// The answer of a comparison: all bits of a lane that says yes, none of one that says no.
template <int lanes>
struct PackMask {
  using Bits = typename detail::VectorOf<std::int64_t, lanes>::type;

  Bits bits;

  bool operator[](int lane) const { return bits[lane] != 0; }
  friend PackMask operator&(PackMask l, PackMask r) { return {l.bits & r.bits}; }
  friend PackMask operator|(PackMask l, PackMask r) { return {l.bits | r.bits}; }
  friend bool none(PackMask m) {
    std::int64_t any = 0;
    for (int lane = 0; lane < lanes; ++lane) any |= m.bits[lane];
    return any == 0;
  }
};

template <int lanes>
struct Pack {
  using Vector = typename detail::VectorOf<double, lanes>::type;
  using Mask = PackMask<lanes>;
  static constexpr int size = lanes;

  Vector v;

  Pack() = default;
  // NOLINTNEXTLINE(google-explicit-constructor): a number stands for itself in all lanes
  Pack(double x) : v(x - Vector{}) {}
  explicit Pack(Vector x) : v(x) {}

  double operator[](int lane) const { return v[lane]; }

  Pack& operator+=(Pack x) { return v += x.v, *this; }
  Pack& operator-=(Pack x) { return v -= x.v, *this; }
  Pack& operator*=(Pack x) { return v *= x.v, *this; }
  Pack& operator/=(Pack x) { return v /= x.v, *this; }
  friend Pack operator-(Pack x) { return Pack(-x.v); }
  friend Pack operator+(Pack l, Pack r) { return Pack(l.v + r.v); }
  friend Pack operator-(Pack l, Pack r) { return Pack(l.v - r.v); }
  friend Pack operator*(Pack l, Pack r) { return Pack(l.v * r.v); }
  friend Pack operator/(Pack l, Pack r) { return Pack(l.v / r.v); }
  friend Mask operator<(Pack l, Pack r) { return {l.v < r.v}; }
  friend Mask operator>(Pack l, Pack r) { return {l.v > r.v}; }
  friend Mask operator<=(Pack l, Pack r) { return {l.v <= r.v}; }
  friend Mask operator>=(Pack l, Pack r) { return {l.v >= r.v}; }
  friend Mask operator==(Pack l, Pack r) { return {l.v == r.v}; }
  friend Mask operator!=(Pack l, Pack r) { return {l.v != r.v}; }
  friend Pack select(Mask yes, Pack a, Pack b) { return Pack(yes.bits ? a.v : b.v); }
  friend Pack sqrt(Pack x) {
    Pack root;
    for (int lane = 0; lane < lanes; ++lane) root.v[lane] = std::sqrt(x.v[lane]);
    return root;
  }
};

/// The type of comparisons of a Real.
template <class Real>
struct MaskOfReal {
  using type = typename Real::Mask;
};
template <>
struct MaskOfReal<double> {
  using type = bool;
};
template <class Real>
using MaskOf = typename MaskOfReal<Real>::type;

/// Whether no lane says yes.
inline bool none(bool yes) {
  return !yes;
}

inline double select(bool yes, double a, double b) {
  return yes ? a : b;
}

/// The same of three components.
template <class Real>
Eigen::Matrix<Real, 3, 1> select(MaskOf<Real> yes, const Eigen::Matrix<Real, 3, 1>& a,
                                 const Eigen::Matrix<Real, 3, 1>& b) {
  return {select(yes, a.x(), b.x()), select(yes, a.y(), b.y()), select(yes, a.z(), b.z())};
}

}  // namespace eigengrain

/// What Eigen wants to know of a type of numbers.
template <int lanes>
struct Eigen::NumTraits<eigengrain::Pack<lanes>> : Eigen::GenericNumTraits<eigengrain::Pack<lanes>> {
  using Real = eigengrain::Pack<lanes>;
  using NonInteger = Real;
  using Nested = Real;
  using Literal = double;
  enum {
    IsComplex = 0,
    IsInteger = 0,
    IsSigned = 1,
    RequireInitialization = 0,
    ReadCost = 1,
    AddCost = 1,
    MulCost = 1
  };
};
template <int lanes, class Operation>
struct Eigen::ScalarBinaryOpTraits<double, eigengrain::Pack<lanes>, Operation> {
  using ReturnType = eigengrain::Pack<lanes>;
};
template <int lanes, class Operation>
struct Eigen::ScalarBinaryOpTraits<eigengrain::Pack<lanes>, double, Operation> {
  using ReturnType = eigengrain::Pack<lanes>;
};
