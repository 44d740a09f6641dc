#include "standing.hpp"

#include "by_name.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace eigengrain::app {

using timestep::Estimate;

double median_of(std::vector<double> values) {
  if (values.empty()) return std::numeric_limits<double>::quiet_NaN();
  std::sort(values.begin(), values.end());
  const std::size_t half = values.size() / 2;
  return values.size() % 2 == 1 ? values[half] : 0.5 * (values[half - 1] + values[half]);
}

std::vector<Standing> standings_of(const std::vector<ComparedScene>& scenes) {
  struct Collected {
    Standing standing;
    std::vector<double> ratios;
    std::vector<double> products;
  };
  ByName<Collected> all;
  for (const ComparedScene& scene : scenes) {
    if (!scene.skipped.empty()) continue;
    for (const Estimate& estimate : scene.comparison.estimates) {
      Collected& mine = all.of(estimate.name);
      Standing& standing = mine.standing;
      if (standing.scenes == 0 || estimate.ratio_to_true > standing.largest) {
        standing.largest = estimate.ratio_to_true;
        standing.largest_in = scene.name;
      }
      standing.name = estimate.name;
      standing.source = estimate.source;
      standing.claim = estimate.claim;
      standing.scenes += 1;
      standing.unsafe += estimate.safe ? 0 : 1;
      mine.ratios.push_back(estimate.ratio_to_true);
      mine.products.push_back(equivalent_products(scene, estimate));
    }
  }
  std::vector<Standing> standings;
  for (Collected& mine : all.items) {
    mine.standing.smallest = *std::min_element(mine.ratios.begin(), mine.ratios.end());
    mine.standing.median = median_of(mine.ratios);
    mine.standing.median_products = median_of(mine.products);
    standings.push_back(mine.standing);
  }
  return standings;
}

}  // namespace eigengrain::app
