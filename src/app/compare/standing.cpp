#include "standing.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <map>

namespace eigengrain::app {
namespace {

using timestep::Claim;
using timestep::Estimate;

constexpr const char* estimate_of_pfc3d = "diagonal";
constexpr double safety_of_rules = 0.8;
constexpr double safety_of_bounds = 0.98;
constexpr double rounding = 1e-9;

/// The step that one takes who trusts in an estimate.
double step_by(const Estimate& estimate, const timestep::Truth& truth) {
  return estimate.claim == Claim::none ? safety_of_rules * estimate.dt
                                       : safety_of_bounds * estimate.dt * (truth.limit / truth.dt);
}

/// Collects by name, in the order in which names are met.
template <class Item>
class ByName {
 public:
  Item& of(const std::string& name) {
    const auto [place, is_new] = index_.try_emplace(name, items.size());
    if (is_new) items.emplace_back();
    return items[place->second];
  }
  std::vector<Item> items;

 private:
  std::map<std::string, std::size_t> index_;
};

}  // namespace

Verdict verdict_on(const Estimate& estimate) {
  if (!estimate.safe) return Verdict::unsafe;
  switch (estimate.claim) {
    case Claim::proven:
      return Verdict::proven;
    case Claim::probable:
      return Verdict::probable;
    case Claim::none:
      break;
  }
  return Verdict::safe_here;
}

const char* text_of(Verdict verdict) {
  switch (verdict) {
    case Verdict::proven:
      return "safe, proven";
    case Verdict::probable:
      return "safe but for a stated probability";
    case Verdict::safe_here:
      return "safe here";
    case Verdict::unsafe:
      break;
  }
  return "UNSAFE";
}

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

double RunLengths::median() const {
  std::vector<double> values;
  for (const RunLength& length : lengths) values.push_back(length.relative_steps);
  return median_of(values);
}

bool RunLengths::always_safe() const {
  return std::all_of(lengths.begin(), lengths.end(), [](const RunLength& length) { return length.safe; });
}

std::vector<RunLengths> run_lengths(const std::vector<ComparedScene>& scenes) {
  ByName<RunLengths> all;
  for (const ComparedScene& scene : scenes) {
    if (!scene.skipped.empty()) continue;
    const timestep::Truth& truth = scene.comparison.truth;
    const Estimate* seed = timestep::find_estimate(scene.comparison, estimate_of_pfc3d);
    if (seed == nullptr) continue;
    const double compared = safety_of_rules * seed->dt;
    const auto add = [&](RunLengths& mine, double dt) {
      mine.lengths.push_back({scene.name, compared / dt, dt <= truth.limit * (1 + rounding)});
    };
    for (const Estimate& estimate : scene.comparison.estimates) {
      RunLengths& mine = all.of(estimate.name);
      mine.name = estimate.name;
      add(mine, step_by(estimate, truth));
    }
    for (const PolicyStep& policy : scene.policies) {
      RunLengths& mine = all.of("policy: " + policy.name);
      mine.name = "policy: " + policy.name;
      mine.policy = true;
      add(mine, policy.dt);
    }
  }
  std::stable_sort(all.items.begin(), all.items.end(), [](const RunLengths& a, const RunLengths& b) {
    if (a.always_safe() != b.always_safe()) return a.always_safe();
    return a.median() < b.median();
  });
  return all.items;
}

}  // namespace eigengrain::app
