#pragma once

#include "eigengrain/assembly/state.hpp"

#include <cstdint>
#include <memory>
#include <optional>

namespace eigengrain::cycle {

/// How often a proof is made anew while nothing asks for it, in steps.
inline constexpr std::int64_t steps_between_proofs = 500;

/// Keeps a step of a state proven that is as large as the contacts allow that act now, or that can while no
/// body leaves its room (assembly::StepGuard).
///
/// Stiffnesses are those at the deepest that a contact can come to within the rooms, and blocks count for
/// more by what the angle can add by which contacts can turn within them (docs/theory.md, "Tracking").
class StepTracker {
 public:
  /// every  steps after which all is proven anew
  explicit StepTracker(std::int64_t every = steps_between_proofs);
  ~StepTracker();

  /// Proves a step from what the guard of the state knows, where it has one: its step, and the weights that
  /// proved it. None where a proof of this kind does not hold: while radii change or the cell deforms, and
  /// with surfaces; then proven_step() is what does. Where nothing can touch yet its step is proven_step(),
  /// too.
  std::optional<assembly::StepGuard> prove(const assembly::State& state);
  /// Renews the guard of a state whose bodies may have left their rooms: of these alone where they are few
  /// and their step can be kept, and else as prove() does. What becomes of it depends on the state and on
  /// nothing that is kept here.
  void renew(assembly::State& state);
  /// To be called where masses, or the guard of a state, are changed by others.
  void forget();

 private:
  struct Standing;
  bool renew_some(const assembly::State& state, assembly::StepGuard& guard);

  std::int64_t every_;
  std::unique_ptr<Standing> standing_;  ///< what the last proof was made with, or nothing
};

/// Mass scaling `selective` beside policy `tracked`: proves the step by the masses as they are for all that
/// can touch while no body leaves its room, and chooses masses anew, for these contacts, only where that
/// fails. Where nothing is tracked (surfaces, cells that deform, radii that change) it is scale_masses().
void track_masses(assembly::State& state, StepTracker& tracker);

}  // namespace eigengrain::cycle
