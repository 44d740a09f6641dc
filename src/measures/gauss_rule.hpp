#pragma once

#include <cmath>
#include <numbers>
#include <vector>

namespace eigengrain::measures {

/// Gauss's rule on [-1, 1] with n points: exact for polynomials of degree 2n - 1. Roots of the Legendre
/// polynomial by Newton's method, to rounding.
struct GaussRule {
  explicit GaussRule(int n) : place(static_cast<std::size_t>(n)), weight(place.size()) {
    for (int i = 0; i < n; ++i) {
      double x = std::cos(std::numbers::pi * (i + 0.75) / (n + 0.5));
      double slope = 1;
      for (int iteration = 0; iteration < 100; ++iteration) {
        double before = 1;
        double p = x;
        for (int k = 2; k <= n; ++k) {
          const double next = ((2 * k - 1) * x * p - (k - 1) * before) / k;
          before = p;
          p = next;
        }
        slope = n * (x * p - before) / (x * x - 1);
        const double step = p / slope;
        x -= step;
        if (std::abs(step) < 1e-15) break;
      }
      place[static_cast<std::size_t>(i)] = x;
      weight[static_cast<std::size_t>(i)] = 2 / ((1 - x * x) * slope * slope);
    }
  }

  std::vector<double> place;
  std::vector<double> weight;
};

}  // namespace eigengrain::measures
