#pragma once

/// Logarithm and exponential from operations that IEEE 754 defines to the bit, so that what is drawn with
/// them is the same on every machine; those of the C library differ in the last bit from one version or
/// processor to the next. Errors are a few units in the last place.
namespace eigengrain::generate::elementary {

/// x > 0, finite.
double log(double x);
/// |x| < 700.
double exp(double x);
/// base > 0; |exponent log(base)| < 700.
inline double pow(double base, double exponent) {
  return exp(exponent * log(base));
}

}  // namespace eigengrain::generate::elementary
