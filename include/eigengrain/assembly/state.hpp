#pragma once

#include "eigengrain/assembly/bond_break.hpp"
#include "eigengrain/assembly/ledger.hpp"
#include "eigengrain/assembly/model.hpp"
#include "eigengrain/assembly/step_guard.hpp"
#include "eigengrain/model/scene.hpp"

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

namespace eigengrain::assembly {

/// Which pairs the contacts were listed for: all that were no more than `skin` apart when the bodies were at
/// `position`. The list holds until some body, or some wall, has moved by half the skin; what a radius
/// changes counts as a way. In a cell that deforms, until some body has moved so far beyond what the cell
/// took it along by that, with the strain since, a pair might touch that is not listed.
struct NeighbourList {
  double skin = 0;             ///< m
  std::vector<Vec3> position;  ///< [bodies] where they were when the list was made, m
  Mat3 edges = Mat3::Zero();   ///< of the periodic cell then, m
  std::int64_t rebuilds = 0;   ///< lists made since the start
  double wall_way = 0;         ///< how far any wall may have moved since, at the bodies, m
  /// [wall_motions] the greatest distance of a body from the wall's centre while the list holds, m
  std::vector<double> wall_lever;
  double growth = 0;  ///< how much any radius may have changed since, m
};

/// A model in motion: all that the explicit cycle continues from, to the bit. Positions, contacts with their
/// history and forces belong to time t, velocities to t - dt/2 (leapfrog).
struct State {
  model::Scene settings;     ///< what the user asked for, without its bodies
  Model model;               ///< velocity always there; spin only where something turns
  std::vector<Vec3> force;   ///< [bodies] of contacts, gravity left out, at t, N
  std::vector<Vec3> moment;  ///< [bodies] about the centres, N m; empty where nothing turns
  NeighbourList list;
  double time = 0;                       ///< t, s
  std::int64_t step = 0;                 ///< cycles since the start
  double dt = 0;                         ///< of the last cycle, s; 0 before the first
  double next_dt = 0;                    ///< that the timestep policy chose for the next one, s
  std::vector<BondBreak> breaks{};       ///< bonds that broke, until somebody takes them; not in state files
  std::optional<EnergyLedger> ledger{};  ///< kept only where somebody has begun it (measures/ledger.hpp)
  std::optional<StepGuard> guard{};      ///< of the step, where it is tracked (policy `tracked`)
  std::vector<model::Group> groups{};    ///< that have been made so far
  model::StageProgress progress{};       ///< where the settings have stages

  bool turns() const { return !model.bodies.spin.empty(); }
};

/// What has to be called wherever something changes that the step rests upon: it is chosen anew, and what was
/// proven of it is no more.
inline void forget_step(State& state) {
  state.next_dt = 0;
  state.guard.reset();
}

/// Adds bonds that broke on the way to the state, with its step, time and entry.
inline void note_breaks(State& state, std::span<const BondBreak> broken) {
  for (BondBreak found : broken) {
    found.step = state.step;
    found.time = state.time;
    found.entry = state.settings.contacts[static_cast<std::size_t>(found.rule)].entry;
    state.breaks.push_back(found);
  }
}

}  // namespace eigengrain::assembly
