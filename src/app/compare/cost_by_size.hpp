#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

namespace eigengrain::app {

/// What estimates cost in packings of growing size (generate/jittered_lattice.hpp).
struct CostOfSize {
  struct Cost {
    std::string name;
    double seconds = 0;
  };
  std::int64_t bodies = 0;
  std::int64_t contacts = 0;
  double product_seconds = 0;  ///< of one product with K
  double truth_seconds = 0;
  std::vector<Cost> estimates;
};

/// Seconds of one product with K, of the truth or of an estimate, by name; NaN where there is none.
inline constexpr const char* name_of_product = "one product with K";
inline constexpr const char* name_of_truth = "truth";
double seconds_of(const CostOfSize& cost, const std::string& name);

/// One entry a size, with a line for each on the error stream.
std::vector<CostOfSize> costs_by_size(const std::vector<std::int64_t>& sizes);

/// The exponent p of seconds ~ bodies^p, by least squares over the logarithms of all sizes from 1000 bodies
/// on (of all, where those are less than two): of one product with K, of the truth and of each estimate that
/// they have. What no longer fits into caches counts as growth. Empty for less than two sizes.
struct Growth {
  std::string name;
  double exponent = 0;
};
std::vector<Growth> growth_of(const std::vector<CostOfSize>& costs);
/// The sizes that the exponents are of.
std::span<const CostOfSize> sizes_of_growth(const std::vector<CostOfSize>& costs);

}  // namespace eigengrain::app
