#pragma once

#include "eigengrain/assembly/cell_motion.hpp"
#include "eigengrain/assembly/ledger.hpp"
#include "eigengrain/assembly/local_damping.hpp"
#include "eigengrain/base/vec.hpp"

#include <cstdint>

namespace eigengrain::cycle {

/// Where nobody keeps an energy ledger.
struct NoWork {
  static constexpr bool counts = false;
  NoWork(double /*behind*/, double /*ahead*/) {}
  void free(double /*damping*/, double /*before*/, double /*after*/) {}
  void held(double /*force*/, double /*velocity*/) {}
  void gravity(const Vec3& /*weight*/, const Vec3& /*velocity*/) {}
  void applied(const Vec3& /*load*/, const Vec3& /*velocity*/) {}
  void resisted(const Vec3& /*moment*/, const Vec3& /*before*/, const Vec3& /*after*/) {}
};

/// The work that a kick decides: half of it over the step behind and half over the step ahead, the way of
/// each being its velocity times its length (measures/ledger.hpp).
struct KickWork {
  static constexpr bool counts = true;
  KickWork(double step_behind, double step_ahead) : behind(step_behind), ahead(step_ahead) {}
  void free(double damping, double before, double after) {
    sum.damping -= 0.5 * damping * (behind * before + ahead * after);
  }
  void held(double force, double velocity) { sum.prescribed -= 0.5 * force * (behind + ahead) * velocity; }
  void gravity(const Vec3& weight, const Vec3& velocity) { sum.gravity += ahead * weight.dot(velocity); }
  /// Of a constant force with a velocity, or a moment with a spin.
  void applied(const Vec3& load, const Vec3& velocity) { sum.applied += ahead * load.dot(velocity); }
  /// Of a damping moment that does not act axis by axis, with the spins of the steps behind and ahead.
  void resisted(const Vec3& moment, const Vec3& before, const Vec3& after) {
    sum.damping -= 0.5 * moment.dot(behind * before + ahead * after);
  }

  double behind;  ///< s
  double ahead;   ///< s
  assembly::EnergyIntegrals sum{};
};

/// Where nothing flows.
struct NoFlow {
  static constexpr bool moves = false;
};

/// The flow of a periodic cell at a place, and what the kick adds to it, m/s.
struct Flow {
  static constexpr bool moves = true;
  Vec3 velocity;
  Vec3 gain;
};

/// NoFlow or Flow, by what is known of the cell.
template <class Cell>
struct FlowAt : NoFlow {
  FlowAt(const Cell& /*cell*/, const Vec3& /*position*/) {}
};
template <>
struct FlowAt<assembly::CellStep> : Flow {
  FlowAt(const assembly::CellStep& cell, const Vec3& position)
      : Flow{cell.flow(position), cell.gained(position)} {}
};

/// Changes the free components of a velocity by the damped force of its body. In a flow the damping resists
/// what the body moves by beyond it, and fixed components follow it, as any other would mean a different
/// velocity for each image.
template <class Work, class AnyFlow>
void kick(Vec3& velocity, const Vec3& force, double inertia, double duration, double damping,
          std::uint8_t fixed, Work& work, const AnyFlow& flow) {
  const double gain = duration / inertia;
  for (int k = 0; k < 3; ++k) {
    if (((fixed >> k) & 1) != 0) {
      work.held(force[k], velocity[k]);
      if constexpr (AnyFlow::moves) velocity[k] += flow.gain[k];
      continue;
    }
    double before = velocity[k];
    if constexpr (AnyFlow::moves) before -= flow.velocity[k];
    const double resistance = assembly::local_damping_force(force[k], before, damping);
    velocity[k] += gain * (force[k] + resistance);
    if constexpr (AnyFlow::moves) velocity[k] += flow.gain[k];
    work.free(resistance, before, velocity[k]);
  }
}

}  // namespace eigengrain::cycle
