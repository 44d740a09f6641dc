#include "eigengrain/base/largest_eigenvalue.hpp"

#include <Eigen/Eigenvalues>

#include <algorithm>
#include <cmath>
#include <limits>

namespace eigengrain {
namespace {

constexpr double epsilon = std::numeric_limits<double>::epsilon();

/// A symmetric tridiagonal matrix of order one.
struct Tridiagonal {
  Vec6 d;
  Vec6 e;  ///< e[i] couples i and i + 1; e[5] = 0
};

/// Rows [first, last) of T that couple with no other rows.
struct Segment {
  int first;
  int last;
};

/// Right of all eigenvalues of the segment (Gershgorin).
double upper_end(const Tridiagonal& t, Segment s) {
  double end = 0;
  for (int i = s.first; i < s.last; ++i)
    end = std::max(end, t.d[i] + std::abs(t.e[i]) + (i > s.first ? std::abs(t.e[i - 1]) : 0.0));
  return end;
}

/// p(x) = det(x - T) of a segment and its first two derivatives, by the three-term recurrence.
struct Polynomial {
  double value, first, second;
};
Polynomial characteristic(const Tridiagonal& t, Segment s, double x) {
  Polynomial before{0, 0, 0};
  Polynomial p{1, 0, 0};
  for (int i = s.first; i < s.last; ++i) {
    const double shift = x - t.d[i];
    const double e2 = i > s.first ? t.e[i - 1] * t.e[i - 1] : 0.0;
    const Polynomial next{shift * p.value - e2 * before.value, p.value + shift * p.first - e2 * before.first,
                          2 * p.first + shift * p.second - e2 * before.second};
    before = p;
    p = next;
  }
  return p;
}

/// Laguerre's iteration from the right: x <- x - n / (g + sqrt((n-1)(n h - g²))), g = p'/p, h = g² - p''/p.
double largest_root(const Tridiagonal& t, Segment s) {
  double x = upper_end(t, s);
  const double n = s.last - s.first;
  for (int iteration = 0; iteration < 60; ++iteration) {
    const Polynomial p = characteristic(t, s, x);
    if (!(p.value > 0) || !(p.first > 0)) break;
    const double g = p.first / p.value;
    const double h = g * g - p.second / p.value;
    const double step = n / (g + std::sqrt(std::max(0.0, (n - 1) * (n * h - g * g))));
    if (!(step > 8 * epsilon * x)) break;
    x -= step;
  }
  return x;
}

/// Whether x - T is positive definite: all pivots of its LDLᵀ factorisation positive (a stable test).
bool above_all(const Tridiagonal& t, double x) {
  double pivot = 1;
  for (int i = 0; i < 6; ++i) {
    pivot = x - t.d[i] - (i > 0 ? t.e[i - 1] * t.e[i - 1] / pivot : 0.0);
    if (!(pivot > 0)) return false;
  }
  return true;
}

}  // namespace

double largest_eigenvalue(const Mat6& matrix) {
  if (!matrix.allFinite()) return std::numeric_limits<double>::quiet_NaN();
  const double size = matrix.diagonal().maxCoeff();
  if (!(size > 0)) return 0.0;
  const Eigen::Tridiagonalization<Mat6> reduced(matrix / size);
  Tridiagonal t{reduced.diagonal(), Vec6::Zero()};
  t.e.head<5>() = reduced.subDiagonal();

  // Multiple eigenvalues (symmetric surroundings are common) belong to different segments, where each is a
  // simple root; within one a double root would be found to half the digits only.
  double x = 0;
  for (int first = 0; first < 6;) {
    int last = first + 1;
    while (last < 6 && std::abs(t.e[last - 1]) > epsilon) ++last;
    x = std::max(x, largest_root(t, {first, last}));
    first = last;
  }
  // Close roots may still have left x a little to the left of the last one.
  double slack = 8 * epsilon;
  while (!above_all(t, x * (1 + slack)) && slack < 1) slack *= 4;
  return size * x * (1 + slack);
}

}  // namespace eigengrain
