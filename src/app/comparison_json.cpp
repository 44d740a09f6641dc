#include "comparison_json.hpp"

#include <cmath>

namespace eigengrain::app {

using nlohmann::ordered_json;

namespace {

ordered_json json_of(const timestep::Proof& proof) {
  if (proof.by == timestep::ProofBy::none) return nullptr;
  return {{"by", timestep::name_of(proof.by)},
          {"dt", proof.dt},
          {"sigma", proof.sigma},
          {"seconds", proof.seconds}};
}

ordered_json json_of(const timestep::Truth& truth) {
  return {{"dt", json_number(truth.dt)},
          {"limit", json_number(truth.limit)},
          {"lambda_max", truth.lambda_max},
          {"residual", truth.residual},
          {"limit_residual", truth.limit_residual},
          {"certified", truth.certified},
          {"proof", json_of(truth.proof)},
          {"limit_proof", json_of(truth.limit_proof)},
          {"seconds", truth.seconds},
          {"products", truth.products}};
}

ordered_json json_of(const timestep::Estimate& e) {
  ordered_json result{{"name", e.name},
                      {"dt", json_number(e.dt)},
                      {"ratio_to_true", json_number(e.ratio_to_true)},
                      {"safe", e.safe},
                      {"claim", timestep::name_of(e.claim)},
                      {"source", e.source},
                      {"seconds", e.seconds},
                      {"products", e.products}};
  if (e.claim == timestep::Claim::probable) result["failure"] = e.failure;
  if (e.range) result["range"] = {json_number(e.range->least), json_number(e.range->largest)};
  return result;
}

}  // namespace

ordered_json json_number(double value) {
  return std::isfinite(value) ? ordered_json(value) : ordered_json(nullptr);
}

ordered_json comparison_json(const timestep::Comparison& c) {
  ordered_json result{{"bodies", c.bodies},
                      {"contacts", c.contacts},
                      {"unknowns", c.unknowns},
                      {"set_aside", c.set_aside},
                      {"true", json_of(c.truth)},
                      {"estimates", ordered_json::array()},
                      {"left_out", ordered_json::array()}};
  for (const timestep::Estimate& e : c.estimates) result["estimates"].push_back(json_of(e));
  for (const timestep::LeftOut& none : c.left_out)
    result["left_out"].push_back({{"name", none.name}, {"reason", none.reason}});
  return result;
}

}  // namespace eigengrain::app
