#pragma once

#include "eigengrain/assembly/model.hpp"
#include "eigengrain/timestep/estimates.hpp"
#include "eigengrain/timestep/truth.hpp"

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

/// Estimated against true critical timesteps: the main job.
namespace eigengrain::timestep {

/// An estimate of the undamped critical timestep, before any safety factor, judged against the truth.
struct Estimate {
  std::string name;
  std::string source;  ///< paper, equation or program
  Claim claim = Claim::none;
  double failure = 0;  ///< Estimator::failure
  double dt = 0;       ///< s
  std::optional<Range> range{};
  double ratio_to_true = 0;  ///< dt over Truth::dt
  bool safe = false;         ///< whether it does not exceed the truth in this scene
  double seconds = 0;
  std::int64_t products = 0;  ///< products with K
};

/// An estimate that this scene has not.
struct LeftOut {
  std::string name;
  std::string reason;
};

struct Comparison {
  std::int64_t bodies = 0;
  std::int64_t contacts = 0;
  std::int64_t unknowns = 0;   ///< free components
  std::int64_t set_aside = 0;  ///< bodies without acting contacts, which are no part of it
  Truth truth;
  std::vector<Estimate> estimates;
  std::vector<LeftOut> left_out;
};

/// Whether an estimate does not exceed the truth by more than what that errs by itself: an eigenvalue errs by
/// about the square of its residual.
inline bool is_safe(double dt, double truth) {
  return dt <= truth * (1 + 1e-9);
}

/// The estimate with this name; null where the scene has none.
const Estimate* find_estimate(const Comparison& comparison, std::string_view name);

/// The true critical timestep of the model as it stands, and every estimate beside it.
///
/// materials  of the scene; without them the estimates that ask for moduli are left out
Comparison compare(const assembly::Model& model, const TruthOptions& options = {},
                   std::span<const model::Material> materials = {});

}  // namespace eigengrain::timestep
