#pragma once

#include "eigengrain/assembly/state.hpp"

#include <nlohmann/json_fwd.hpp>

#include <cstdint>
#include <string>

/// How far two equilibria of the same bodies are from each other: friction admits many.
namespace eigengrain::app {

struct EquilibriumDifference {
  double mean_distance = 0;  ///< of the bodies: root mean square, over the mean radius
  double max_distance = 0;   ///< the same of the one that is farthest
  double forces = 0;  ///< root mean square difference of contact forces over the mean contact force; one that
                      ///< acts in one of them alone counts in full
  double stress = 0;  ///< |Σ F ⊗ ℓ of one - of the other| over that of the first
  std::int64_t only_first = 0;  ///< contacts that act in one of them alone
  std::int64_t only_second = 0;
};

/// The shortest way between two places that may stand for their images in the cell, m.
Vec3 shortest(const model::PeriodicCell& cell, const Vec3& difference);

/// The states have the same rows.
EquilibriumDifference difference_of(const assembly::State& first, const assembly::State& second);

nlohmann::ordered_json to_json(const EquilibriumDifference& difference);
std::string text_of(const EquilibriumDifference& difference);

}  // namespace eigengrain::app
