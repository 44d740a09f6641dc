#include "run_lengths.hpp"

#include "eigengrain/model/scene.hpp"

#include "by_name.hpp"

#include <algorithm>

namespace eigengrain::app {
namespace {

using timestep::Estimate;

constexpr const char* estimate_of_pfc3d = "diagonal";
constexpr double safety_of_rules = model::default_safety(model::TimestepPolicy::estimate);
constexpr double safety_of_bounds = model::default_safety(model::TimestepPolicy::tracked);

/// The step that one takes who trusts in an estimate.
double step_by(const Estimate& estimate, const timestep::Truth& truth) {
  return estimate.claim == timestep::Claim::none ? safety_of_rules * estimate.dt
                                                 : safety_of_bounds * estimate.dt * (truth.limit / truth.dt);
}

}  // namespace

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
    const auto add = [&](RunLengths& mine, double dt, bool safe) {
      mine.lengths.push_back({scene.name, compared / dt, safe});
    };
    for (const Estimate& estimate : scene.comparison.estimates) {
      RunLengths& mine = all.of(estimate.name);
      mine.name = estimate.name;
      const double dt = step_by(estimate, truth);
      add(mine, dt, timestep::is_safe(dt, truth.limit));
    }
    for (const PolicyStep& policy : scene.policies) {
      RunLengths& mine = all.of("policy: " + policy.name);
      mine.name = "policy: " + policy.name;
      mine.policy = true;
      add(mine, policy.dt, policy.safe);
    }
  }
  std::stable_sort(all.items.begin(), all.items.end(), [](const RunLengths& a, const RunLengths& b) {
    if (a.always_safe() != b.always_safe()) return a.always_safe();
    return a.median() < b.median();
  });
  return all.items;
}

}  // namespace eigengrain::app
