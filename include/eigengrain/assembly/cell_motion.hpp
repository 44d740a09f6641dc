#pragma once

#include "eigengrain/base/vec.hpp"
#include "eigengrain/model/surroundings.hpp"

namespace eigengrain::assembly {

struct State;

/// How the periodic cell of a state moves in a step, and what that means for bodies. Bodies carry their whole
/// velocity, and the scheme is the same for each of a body's images (docs/theory.md, "Cells that deform"):
///
///   H₊ = exp(L Δt) H          rate₊ = (H₊ - H)/Δt
///   v₊ = v₋ + (forces) + gain (x - origin)         gain = (rate₊ - rate₋) H⁻¹
///   local damping by the sign of v₋ - behind (x - origin)        behind = rate₋ H⁻¹
struct CellStep {
  static constexpr bool moves = true;

  Vec3 origin;    ///< m
  Mat3 behind;    ///< gradient of the flow at the end of the step before, 1/s
  Mat3 gain;      ///< what the kick adds to it, 1/s
  Mat3 carry;     ///< how the cell has deformed since the near list was made
  double margin;  ///< way beyond `carry` that bodies may go while the list holds; negative: none, m

  Vec3 flow(const Vec3& x) const { return behind * (x - origin); }
  Vec3 gained(const Vec3& x) const { return gain * (x - origin); }
  /// Where a body of the list would be if it had moved with the cell, m.
  Vec3 carried(const Vec3& listed) const { return origin + carry * (listed - origin); }
};

/// In its place where the cell rests: nothing of this is computed.
struct CellAtRest {
  static constexpr bool moves = false;
};

/// Moves the cell of a state by a step from its time on.
CellStep move_cell(State& state, double dt);

/// (exp(L Δt) - 1)/Δt: with it a step is H₊ = H + Δt rate₊, rate₊ = this H, without the digits that a
/// difference of H₊ and H would lose. By its power series, after halving Δt until that is short.
Mat3 mean_gradient(const Mat3& velocity_gradient, double dt);

/// What bodies move by apart from the cell: velocities less that of the flow, for energies and reports.
class Fluctuation {
 public:
  explicit Fluctuation(const model::PeriodicCell& cell)
      : origin_(cell.origin), gradient_(cell.flow_gradient()), moves_(!gradient_.isZero(0)) {}

  Vec3 of(const Vec3& velocity, const Vec3& position) const {
    return moves_ ? Vec3(velocity - gradient_ * (position - origin_)) : velocity;
  }

 private:
  Vec3 origin_;
  Mat3 gradient_;
  bool moves_;
};

}  // namespace eigengrain::assembly
