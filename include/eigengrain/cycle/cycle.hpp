#pragma once

#include "eigengrain/assembly/cell_motion.hpp"
#include "eigengrain/assembly/forces.hpp"
#include "eigengrain/assembly/state.hpp"

#include <cstdint>
#include <functional>
#include <utility>
#include <vector>

/// The explicit cycle: leapfrog (PFC3D eqs. 1.25-1.27) with local damping (eq. 1.47).
namespace eigengrain::cycle {

/// The step to take from a state on, s. It is asked before the first step, after every new list of contacts
/// and every `every` steps (0: not in between; while radii change every 20 steps at least), so that what
/// adapts depends on counts alone.
struct TimestepPolicy {
  std::function<double(const assembly::State&)> dt;
  std::int64_t every = 0;
  /// What is done to the state before it is asked; empty: nothing (see cycle/mass_scaling.hpp).
  std::function<void(assembly::State&)> prepare{};
  /// A step chosen anew is taken where it is shorter, or longer by this factor: one that changes with every
  /// contact costs accuracy and gains nothing.
  double worth_a_change = 1.05;
  /// Whether `prepare` keeps a guard of the step (assembly::StepGuard) in the state.
  bool keeps_guard = false;
};

/// A scene at rest in time: bodies sorted, near pairs listed, forces of the first moment. Velocities are
/// those of the scene. Throws InputError as build_model does.
assembly::State start(const model::Scene& scene);

/// Steps a state through time.
///
///   force at t          F = Σ contacts + m g + applied force; M = Σ contacts + applied moment
///   local damping       F_d = -α |F| sign(v₋), component by component
///   velocity            v₊ = v₋ + ½(Δt_old + Δt) (F + F_d)/m           fixed components keep theirs
///   position            x += v₊ Δt
///   clumps              L₊ = L₋ + ½(Δt_old + Δt) M with damping along the principal axes, then the free
///                       rotation with L₊ (cycle/free_rotation.hpp)
///   orientation         q <- exp(v₊ Δt of the spin) q, where the scene has orientations
///   walls               by the velocity that is given for the middle of the step, servo walls by their load
///                       at t
///   radii               those of t + Δt, where some are ramped; masses follow
///   periodic cell       where it has a velocity gradient (assembly/cell_motion.hpp): H₊ = exp(L Δt) H, and
///                       bodies take part in its flow
///   contacts            the list, where a body or wall has moved by half the skin; forces from the new
///                       positions, the increments v₊ Δt and the old history, which is committed at once
///
/// A state that starts has Δt_old = 0: its velocity v₀ at t = 0 becomes v₀ + ½Δt a₀ at the half step, which
/// keeps the scheme at second order. A state with an energy ledger keeps it; without, nothing of it is
/// computed. The same program gives the same bits on any number of threads, and from a state that was saved
/// and read again.
class Cycle {
 public:
  /// Throws InputError where the policy finds no step.
  Cycle(assembly::State state, TimestepPolicy policy);

  void step();
  void run(std::int64_t steps) {
    for (std::int64_t k = 0; k < steps; ++k) step();
  }

  const assembly::State& state() const { return state_; }
  /// Bonds that broke since this was last asked, in their order; the state forgets them.
  std::vector<assembly::BondBreak> take_breaks() { return std::exchange(state_.breaks, {}); }
  /// The state, moved out; the cycle is over.
  assembly::State release() { return std::move(state_); }

 private:
  /// Kick of all bodies for a duration and drift for dt; the speed of the fastest, m/s. By what the bodies
  /// have of their own, whether a ledger is kept, and whether the cell moves.
  template <class Cell>
  double move(double duration, double dt, const Cell& cell);
  template <class Work, class Properties, class Cell>
  double move(double duration, double dt, const Cell& cell);
  /// How far every body may still move before one leaves its room, m; negative where one has. That is the
  /// room of the guard, and without one `room` about where the list was made, in a cell that moves about
  /// where that took it.
  template <class Cell>
  double least_slack(double room, const Cell& cell) const;
  /// Whether a body or wall has moved by half the skin since the near list was made.
  bool list_is_old() const;
  void list_anew();
  void choose_timestep();

  assembly::State state_;
  TimestepPolicy policy_;
  assembly::ContactForceSum forces_;
  assembly::WallStep walls_;
  double slack_ = 0;  ///< no body can have left its room before it has moved by this, m
};

}  // namespace eigengrain::cycle
