#include "../comparison_json.hpp"
#include "run_lengths.hpp"
#include "standing.hpp"
#include "timesteps_report.hpp"

#include <nlohmann/json.hpp>

#include <cmath>

namespace eigengrain::app {
namespace {

using nlohmann::ordered_json;

ordered_json json_of(const ComparedScene& scene) {
  ordered_json result{{"name", scene.name}, {"file", scene.file}};
  if (!scene.skipped.empty()) {
    result["skipped"] = scene.skipped;
    return result;
  }
  const timestep::Comparison& c = scene.comparison;
  result.update(comparison_json(c));
  result["product_seconds"] = scene.product_seconds;
  for (std::size_t k = 0; k < c.estimates.size(); ++k)
    result["estimates"][k]["equivalent_products"] = json_number(equivalent_products(scene, c.estimates[k]));
  result["policies"] = ordered_json::array();
  for (const PolicyStep& policy : scene.policies)
    result["policies"].push_back({{"name", policy.name},
                                  {"dt", json_number(policy.dt)},
                                  {"ratio_to_limit", json_number(policy.dt / c.truth.limit)},
                                  {"safe", policy.safe}});
  return result;
}

ordered_json json_of(const Standing& s) {
  return {{"name", s.name},
          {"source", s.source},
          {"claim", timestep::name_of(s.claim)},
          {"scenes", s.scenes},
          {"unsafe", s.unsafe},
          {"smallest_ratio", json_number(s.smallest)},
          {"median_ratio", json_number(s.median)},
          {"largest_ratio", json_number(s.largest)},
          {"largest_in", s.largest_in},
          {"median_equivalent_products", json_number(s.median_products)}};
}

ordered_json json_of(const RunLengths& lengths) {
  ordered_json result{
      {"name", lengths.name}, {"median", json_number(lengths.median())}, {"scenes", ordered_json::array()}};
  for (const RunLength& length : lengths.lengths)
    result["scenes"].push_back({{"name", length.scene},
                                {"relative_steps", json_number(length.relative_steps)},
                                {"safe", length.safe}});
  return result;
}

ordered_json json_of(const CostOfSize& cost) {
  ordered_json result{{"bodies", cost.bodies},
                      {"contacts", cost.contacts},
                      {"product_seconds", cost.product_seconds},
                      {"truth_seconds", cost.truth_seconds},
                      {"estimates", ordered_json::array()}};
  for (const CostOfSize::Cost& e : cost.estimates)
    result["estimates"].push_back({{"name", e.name}, {"seconds", e.seconds}});
  return result;
}

template <class Items>
ordered_json json_of_all(const Items& items) {
  ordered_json result = ordered_json::array();
  for (const auto& item : items) result.push_back(json_of(item));
  return result;
}

}  // namespace

nlohmann::ordered_json to_json(const TimestepsReport& report) {
  ordered_json growth = ordered_json::array();
  for (const Growth& g : growth_of(report.sizes))
    growth.push_back({{"name", g.name}, {"exponent", json_number(g.exponent)}});
  return {{"subject", "timesteps"},
          {"scenes", json_of_all(report.scenes)},
          {"estimates", json_of_all(standings_of(report.scenes))},
          {"relative_steps", json_of_all(run_lengths(report.scenes))},
          {"sizes", json_of_all(report.sizes)},
          {"growth", growth}};
}

}  // namespace eigengrain::app
