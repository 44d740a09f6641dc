#pragma once

#include "eigengrain/measures/ledger.hpp"

#include "support/motion.hpp"

#include <cstring>
#include <utility>

/// Runs that keep an energy ledger.
namespace eigengrain::test {

inline assembly::State with_ledger(assembly::State state) {
  measures::begin_ledger(state);
  return state;
}

/// A scene at its start with its ledger, and a fixed step.
inline cycle::Cycle cycle_with_ledger(SceneBuilder builder, double dt) {
  return cycle::Cycle(with_ledger(cycle::start(builder.scene())), fixed_step(dt));
}

inline bool same_bits(const measures::Ledger& a, const measures::Ledger& b) {
  return std::memcmp(&a, &b, sizeof a) == 0;
}

}  // namespace eigengrain::test
