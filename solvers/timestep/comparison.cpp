#include "eigengrain/timestep/comparison.hpp"

#include "eigengrain/assembly/linear_system.hpp"
#include "eigengrain/assembly/local_damping.hpp"
#include "eigengrain/base/timer.hpp"

#include <string>

namespace eigengrain::timestep {
namespace {

void judge(const Estimator& estimator, const Question& question, Comparison& result) {
  if (!question.system.nodal.empty() && !estimator.knows_nodes) {
    result.left_out.push_back(
        {std::string(estimator.name), "it knows contacts alone, and the scene has deformable bodies"});
    return;
  }
  const Stopwatch watch;
  const Answer answer = estimator.find(question);
  const double seconds = watch.seconds();
  if (!answer.left_out.empty()) {
    result.left_out.push_back({std::string(estimator.name), answer.left_out});
    return;
  }
  const double truth = result.truth.dt;
  result.estimates.push_back({.name = std::string(estimator.name),
                              .source = std::string(estimator.source),
                              .claim = estimator.claim,
                              .failure = estimator.failure,
                              .dt = answer.dt,
                              .range = answer.range,
                              .ratio_to_true = answer.dt / truth,
                              .safe = is_safe(answer.dt, truth),
                              .seconds = seconds,
                              .products = answer.products});
}

}  // namespace

const Estimate* find_estimate(const Comparison& comparison, std::string_view name) {
  for (const Estimate& estimate : comparison.estimates)
    if (estimate.name == name) return &estimate;
  return nullptr;
}

Comparison compare(const assembly::Model& model, const TruthOptions& options,
                   std::span<const model::Material> materials) {
  const assembly::LinearSystem system(model);
  Comparison result{
      .bodies = model.bodies.size(),
      .contacts = static_cast<std::int64_t>(system.elements.size()),
      .unknowns = static_cast<std::int64_t>(system.unknowns.free_components().size()),
      .set_aside = static_cast<std::int64_t>(system.unknowns.set_aside().size()),
      .truth = critical_timestep(system, assembly::damping_of_unknowns(model, system.unknowns), options),
      .estimates = {},
      .left_out = {}};
  for (const Estimator& estimator : estimators()) judge(estimator, {model, system, materials}, result);
  return result;
}

}  // namespace eigengrain::timestep
