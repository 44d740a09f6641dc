#pragma once

#include "eigengrain/assembly/forces.hpp"
#include "eigengrain/assembly/state.hpp"
#include "eigengrain/model/scene.hpp"

#include <cstdint>
#include <optional>
#include <vector>

namespace eigengrain::relaxation {

/// FIRE (Bitzek et al., Phys. Rev. Lett. 97:170201, 2006; with the semi-implicit step of Guénolé et al.,
/// Comput. Mater. Sci. 175:109584, 2020): a descent with inertia along forces of the contact law itself,
/// each step committed. Masses are those of density scaling, by which a step of one is proven stable without
/// damping, so that all bodies move at the pace of their contacts and the step grows up to one.
///
///   a = M⁻¹ F        P = F·v
///   P > 0  for more than 5 steps: Δt <- min(1.1 Δt, 1), α <- 0.99 α
///   else   v <- 0, Δt <- ½ Δt, α <- 0.1
///   v <- v + Δt a    v <- (1 - α) v + α |v|/|a| a     |x|² = x·M x     x <- x + Δt v
class Fire {
 public:
  /// The state as it stands, at rest.
  explicit Fire(assembly::State state);

  void step();
  void run(std::int64_t steps) {
    for (std::int64_t k = 0; k < steps; ++k) step();
  }
  const assembly::State& state() const { return state_; }
  /// The state, moved out, with its own settings and masses; the descent is over.
  assembly::State release();

 private:
  /// Chosen by the masses that the contacts listed now need.
  void choose_masses();
  /// Forces and moments on bodies with all loads, of clumps in the rows of their holders; free components.
  void gather();
  /// By moved_; the contacts remember.
  void move();

  assembly::State state_;
  std::optional<model::MassScaling> scaling_;  ///< of the scene
  model::TimestepChoice timestep_;
  std::vector<double> mass_factor_;
  assembly::ContactForceSum forces_;
  assembly::BodyForces pull_;     ///< [bodies] F and M
  assembly::Displacement rate_;   ///< [bodies] v and ω
  assembly::Displacement push_;   ///< [bodies] accelerations a
  assembly::Displacement moved_;  ///< of a step
  double dt_;
  double mixing_;
  int downhill_ = 0;  ///< steps since P was last negative
};

}  // namespace eigengrain::relaxation
