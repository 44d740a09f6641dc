#include "eigengrain/timestep/comparison.hpp"

#include "eigengrain/assembly/linear_system.hpp"
#include "eigengrain/base/timer.hpp"
#include "eigengrain/cycle/bounds.hpp"

#include <utility>

namespace eigengrain::timestep {
namespace {

/// Above the truth by more than its own error: an eigenvalue errs by about the square of its residual.
constexpr double tolerance = 1e-9;

template <class Compute>
Estimate judged(std::string name, std::string basis, bool proven, const Truth& truth,
                const Compute& compute) {
  const Stopwatch watch;
  const double dt = compute();
  return {.name = std::move(name),
          .basis = std::move(basis),
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
                    .truth = critical_timestep(system, model.local_damping, options),
                    .estimates = {}};
  const auto add = [&](std::string name, std::string basis, bool proven, const auto& compute) {
    result.estimates.push_back(judged(std::move(name), std::move(basis), proven, result.truth, compute));
  };
  add("diagonal", "the seed's rule, eq. 1.31", false, [&] { return cycle::diagonal_estimate(system); });
  add("block-bound", "6x6 blocks, walls counted once", true, [&] { return cycle::block_bound(system); });
  add("scaled-block-bound", "the same after 3 Collatz-Wielandt sweeps", true,
      [&] { return cycle::scaled_block_bound(system, 3); });
  return result;
}

}  // namespace eigengrain::timestep
