#pragma once

#include "eigengrain/assembly/linear_system.hpp"

#include <cstdint>
#include <functional>
#include <vector>

namespace eigengrain::spectrum {

struct DensityOptions {
  int moments = 512;                    ///< Chebyshev moments; the resolution is π over it
  int vectors = 8;                      ///< random ones; errors fall with the root of their number
  int bins = 50;                        ///< of equal width in ω
  std::uint64_t seed = 1;               ///< of the vectors
  std::function<bool()> interrupted{};  ///< asked once a product; may be empty
};

/// How many modes lie in each interval of angular frequency ω = √λ.
struct Density {
  std::vector<double> edge;   ///< [bins + 1] rad/s, from 0 on
  std::vector<double> count;  ///< [bins] modes between two edges; all together the free components
  /// [bins] standard error of it: of the random vectors, and by how much it would be another with half of the
  /// moments.
  std::vector<double> error;
  double resolution = 0;   ///< width (standard deviation) that a single mode is smeared over, at most, rad/s
  std::int64_t modes = 0;  ///< free components
  std::int64_t products = 0;  ///< with K
  double seconds = 0;
  bool complete = true;  ///< false after an interrupt: fewer vectors than asked for, or none
};

/// Density of states by the kernel polynomial method (Weiße, Wellein, Alvermann and Fehske, Rev. Mod. Phys.
/// 78:275, 2006): moments μ_n = tr T_n(Ã)/N of Chebyshev polynomials of A = M^-½ K M^-½ scaled to [-1, 1],
/// from random vectors of signs, damped by the Jackson kernel. Where λ = ½ λ_b (1 + cos t) a mode is smeared
/// over π/moments in t; with ω = √λ_b cos(t/2) that is at most ½ √λ_b π/moments in ω. The integral over a bin
/// is taken exactly.
///
/// Zero modes are counted: they fill the first bins. λ_b is a proven bound. Cost: moments/2 products with K a
/// vector, and no more memory than some vectors: for systems too large for spectrum::all_modes. The same to
/// the bit on any number of threads.
///
/// Throws InputError for numbers that make no sense.
Density density_of_states(const assembly::LinearSystem& system, const DensityOptions& options = {});

/// The part of a mode λ that the method above counts in each bin: by it a known spectrum is smeared alike
/// [bins].
///
/// edge  [bins + 1] of ω;  bound  λ_b
std::vector<double> smeared(double lambda, double bound, int moments, const std::vector<double>& edge);

}  // namespace eigengrain::spectrum
