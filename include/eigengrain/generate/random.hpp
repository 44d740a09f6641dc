#pragma once

#include <cstdint>
#include <random>

namespace eigengrain::generate {

/// Random numbers that are the same on every machine: the standard defines the bits of std::mt19937_64, and
/// leaves open those of its distributions, which are not used.
class Random {
 public:
  explicit Random(std::uint64_t seed) : engine_(seed) {}

  /// A multiple of 2^-53 in [0, 1).
  double uniform() { return static_cast<double>(engine_() >> 11U) * 0x1p-53; }
  /// Mean 0, variance 1: the polar method of Marsaglia & Bray (1964).
  double normal();

 private:
  std::mt19937_64 engine_;
};

}  // namespace eigengrain::generate
