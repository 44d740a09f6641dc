#include "eigengrain/timestep/comparison.hpp"

#include "eigengrain/assembly/linear_system.hpp"
#include "eigengrain/assembly/local_damping.hpp"
#include "eigengrain/base/timer.hpp"

#include <string>

namespace eigengrain::timestep {
namespace {

/// Above the truth by more than its own error: an eigenvalue errs by about the square of its residual.
constexpr double tolerance = 1e-9;

Estimate judged(const Estimator& estimator, const Question& question, const Truth& truth) {
  const Stopwatch watch;
  const Answer answer = estimator.find(question);
  return {.name = std::string(estimator.name),
          .source = std::string(estimator.source),
          .claim = estimator.claim,
          .dt = answer.dt,
          .ratio_to_true = answer.dt / truth.dt,
          .safe = answer.dt <= truth.dt * (1 + tolerance),
          .seconds = watch.seconds(),
          .products = answer.products};
}

}  // namespace

Comparison compare(const assembly::Model& model, const TruthOptions& options) {
  const assembly::LinearSystem system(model);
  Comparison result{
      .bodies = model.bodies.size(),
      .contacts = static_cast<std::int64_t>(system.elements.size()),
      .unknowns = static_cast<std::int64_t>(system.unknowns.free_components().size()),
      .set_aside = static_cast<std::int64_t>(system.unknowns.set_aside().size()),
      .truth = critical_timestep(system, assembly::damping_of_unknowns(model, system.unknowns), options),
      .estimates = {}};
  for (const Estimator& estimator : estimators())
    result.estimates.push_back(judged(estimator, {model, system}, result.truth));
  return result;
}

}  // namespace eigengrain::timestep
