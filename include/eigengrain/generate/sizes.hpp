#pragma once

#include "eigengrain/generate/random.hpp"

#include <limits>
#include <variant>
#include <vector>

/// Distributions of radii, in m, by number unless said otherwise. The same seed gives the same radii on every
/// machine.
namespace eigengrain::generate {

struct ConstantSize {
  double radius = 0;
};

struct UniformSizes {
  double least = 0;
  double most = 0;
};

/// Gaussian, cut off outside of [least, most]: mean and deviation are those before the cut.
struct NormalSizes {
  double mean = 0;
  double deviation = 0;
  double least = 0;
  double most = std::numeric_limits<double>::infinity();
};

/// log r is Gaussian; mean and deviation are those of r, before the cut to [least, most].
struct LognormalSizes {
  double mean = 0;
  double deviation = 0;
  double least = 0;
  double most = std::numeric_limits<double>::infinity();
};

/// Density of numbers proportional to r^exponent in [least, most].
struct PowerLawSizes {
  double exponent = 0;
  double least = 0;
  double most = 0;
};

/// A part `share` of the numbers, or of the mass, spread evenly over radii in [least, most], which may be one
/// radius.
struct SizeClass {
  double least = 0;
  double most = 0;
  double share = 0;  ///< the sum over classes need not be 1
};

struct TableSizes {
  std::vector<SizeClass> classes;
  bool by_mass = false;
};

using SizeDistribution =
    std::variant<ConstantSize, UniformSizes, NormalSizes, LognormalSizes, PowerLawSizes, TableSizes>;

/// Draws radii, one after the other, independent of each other.
class SizeSampler {
 public:
  /// Throws InputError where less than a hundredth of a Gaussian lies in [least, most]: drawing would take
  /// for ever, and hardly be meant.
  explicit SizeSampler(SizeDistribution distribution);

  double draw(Random& random) const;

 private:
  SizeDistribution distribution_;
};

/// Radii drawn until one more sphere would take their volume farther from the one asked for, in m³, than one
/// less: the two differ by no more than half of a ball. Throws InputError where that makes no ball, or more
/// than most_balls.
std::vector<double> draw_radii(const SizeSampler& sampler, double volume, Random& random);

}  // namespace eigengrain::generate
