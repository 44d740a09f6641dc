#include "eigengrain/timestep/comparison.hpp"

#include "eigengrain/assembly/linear_system.hpp"
#include "eigengrain/assembly/local_damping.hpp"
#include "eigengrain/base/timer.hpp"
#include "eigengrain/cycle/bounds.hpp"

#include <utility>

namespace eigengrain::timestep {
namespace {

/// Above the truth by more than its own error: an eigenvalue errs by about the square of its residual.
constexpr double tolerance = 1e-9;

template <class Compute>
Estimate judged(std::string name, bool proven, const Truth& truth, const Compute& compute) {
  const Stopwatch watch;
  const double dt = compute();
  return {.name = std::move(name),
          .proven = proven,
          .dt = dt,
          .ratio_to_true = dt / truth.dt,
          .safe = dt <= truth.dt * (1 + tolerance),
          .seconds = watch.seconds()};
}

}  // namespace

Comparison compare(const assembly::Model& model, const TruthOptions& options) {
  const assembly::LinearSystem system(model);
  Comparison result{.bodies = model.bodies.size(),
                    .contacts = static_cast<std::int64_t>(system.elements.size()),
                    .unknowns = static_cast<std::int64_t>(system.unknowns.free_components().size()),
                    .set_aside = static_cast<std::int64_t>(system.unknowns.set_aside().size()),
                    .truth = critical_timestep(system, assembly::largest_damping(model), options),
                    .estimates = {}};
  const auto add = [&](std::string name, bool proven, const auto& compute) {
    result.estimates.push_back(judged(std::move(name), proven, result.truth, compute));
  };
  // PFC3D's rule, eq. 1.31
  add("diagonal", false, [&] { return cycle::diagonal_estimate(system); });
  add("block-bound", true, [&] { return cycle::block_bound(system); });
  add("scaled-block-bound", true, [&] { return cycle::scaled_block_bound(system, 3); });
  return result;
}

}  // namespace eigengrain::timestep
