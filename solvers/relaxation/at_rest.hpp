#pragma once

#include "eigengrain/assembly/state.hpp"

#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

/// What moves a state in time, and is no part of an equilibrium.
namespace eigengrain::relaxation {

/// Everything stands still at a moment of its own, and dashpots do nothing.
void halt(assembly::State& state);

/// Takes from a state what moves it: its clock, velocities that fixed components keep, motions of walls (but
/// for what servos do to them) and cell, ramps of radii, the choice of the step, scaled masses, α of bodies
/// and scene. Equilibria are sought without; afterwards it all moves on.
class SetAside {
 public:
  explicit SetAside(assembly::State& state);
  void give_back(assembly::State& state);

 private:
  double time_;
  std::int64_t step_;
  std::vector<Vec3> velocity_;  ///< of bodies, beyond the flow of the cell
  std::vector<Vec3> spin_;
  std::vector<Vec3> of_clumps_;
  std::vector<Vec3> clump_spin_;
  model::TimestepChoice timestep_;
  std::optional<model::MassScaling> mass_scaling_;
  double local_damping_;
  std::vector<double> damping_;
  std::vector<double> mass_factor_;
  std::vector<model::RadiusRamp> ramp_;
  Mat3 velocity_gradient_;
  decltype(assembly::Model::wall_motions) wall_motions_;
  decltype(assembly::Model::wall_poses) wall_poses_;
  std::vector<std::size_t> servos_;  ///< which of the motions stay
};

}  // namespace eigengrain::relaxation
