#include "standing.hpp"
#include "timesteps_report.hpp"

#include <nlohmann/json.hpp>

#include <cmath>

namespace eigengrain::app {
namespace {

using nlohmann::ordered_json;

/// JSON has no infinity: a step without limit is null.
ordered_json number(double value) {
  return std::isfinite(value) ? ordered_json(value) : ordered_json(nullptr);
}

ordered_json json_of(const ComparedScene& scene, const timestep::Estimate& e) {
  ordered_json result{{"name", e.name},
                      {"dt", number(e.dt)},
                      {"ratio_to_true", number(e.ratio_to_true)},
                      {"safe", e.safe},
                      {"claim", timestep::name_of(e.claim)},
                      {"source", e.source},
                      {"seconds", e.seconds},
                      {"products", e.products},
                      {"equivalent_products", number(equivalent_products(scene, e))}};
  if (e.claim == timestep::Claim::probable) result["failure"] = e.failure;
  if (e.range) result["range"] = {number(e.range->least), number(e.range->largest)};
  return result;
}

ordered_json json_of(const ComparedScene& scene) {
  if (!scene.skipped.empty()) return {{"name", scene.name}, {"file", scene.file}, {"skipped", scene.skipped}};
  const timestep::Comparison& c = scene.comparison;
  ordered_json result{{"name", scene.name},
                      {"file", scene.file},
                      {"bodies", c.bodies},
                      {"contacts", c.contacts},
                      {"unknowns", c.unknowns},
                      {"set_aside", c.set_aside},
                      {"product_seconds", scene.product_seconds},
                      {"true",
                       {{"dt", c.truth.dt},
                        {"limit", c.truth.limit},
                        {"lambda_max", c.truth.lambda_max},
                        {"residual", c.truth.residual},
                        {"certified", c.truth.certified},
                        {"seconds", c.truth.seconds},
                        {"products", c.truth.products}}},
                      {"estimates", ordered_json::array()},
                      {"left_out", ordered_json::array()},
                      {"policies", ordered_json::array()}};
  for (const timestep::Estimate& e : c.estimates) result["estimates"].push_back(json_of(scene, e));
  for (const timestep::LeftOut& none : c.left_out)
    result["left_out"].push_back({{"name", none.name}, {"reason", none.reason}});
  for (const PolicyStep& policy : scene.policies)
    result["policies"].push_back({{"name", policy.name},
                                  {"dt", number(policy.dt)},
                                  {"ratio_to_limit", number(policy.dt / c.truth.limit)},
                                  {"safe", policy.safe}});
  return result;
}

ordered_json json_of(const Standing& s) {
  return {{"name", s.name},
          {"source", s.source},
          {"claim", timestep::name_of(s.claim)},
          {"scenes", s.scenes},
          {"unsafe", s.unsafe},
          {"smallest_ratio", number(s.smallest)},
          {"median_ratio", number(s.median)},
          {"largest_ratio", number(s.largest)},
          {"largest_in", s.largest_in},
          {"median_equivalent_products", number(s.median_products)}};
}

ordered_json json_of(const RunLengths& lengths) {
  ordered_json result{
      {"name", lengths.name}, {"median", number(lengths.median())}, {"scenes", ordered_json::array()}};
  for (const RunLength& length : lengths.lengths)
    result["scenes"].push_back(
        {{"name", length.scene}, {"relative_steps", number(length.relative_steps)}, {"safe", length.safe}});
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
    growth.push_back({{"name", g.name}, {"exponent", number(g.exponent)}});
  return {{"subject", "timesteps"},
          {"scenes", json_of_all(report.scenes)},
          {"estimates", json_of_all(standings_of(report.scenes))},
          {"relative_steps", json_of_all(run_lengths(report.scenes))},
          {"sizes", json_of_all(report.sizes)},
          {"growth", growth}};
}

}  // namespace eigengrain::app
