#include "elementary.hpp"

#include <cmath>
#include <numbers>

namespace eigengrain::generate::elementary {
namespace {

/// log 2 as a sum: a multiple k of the first part is exact for |k| < 2^20.
constexpr double log_2_high = 0x1.62e42fee00000p-1;
constexpr double log_2_low = 0x1.a39ef35793c76p-33;

}  // namespace

double log(double x) {
  int exponent = 0;
  double m = std::frexp(x, &exponent);
  if (m < std::numbers::sqrt2 / 2) {
    m *= 2;
    --exponent;
  }
  // log m = 2 artanh z, |z| <= 0.172: the first term left out, z^25/25, is below 1e-20.
  const double z = (m - 1) / (m + 1);
  double sum = 0;
  for (int k = 23; k >= 3; k -= 2) sum = (sum + 1.0 / k) * (z * z);
  const double k = exponent;
  return k * log_2_high + (2 * z + (2 * z * sum + k * log_2_low));
}

double exp(double x) {
  const double k = std::floor(x / std::numbers::ln2 + 0.5);
  const double r = (x - k * log_2_high) - k * log_2_low;
  // |r| <= 0.35: the first term left out, r^16/16!, is below 1e-20.
  double sum = 1;
  for (int n = 15; n >= 1; --n) sum = 1 + sum * r / n;
  return std::ldexp(sum, static_cast<int>(k));
}

}  // namespace eigengrain::generate::elementary
