#pragma once

#include "eigengrain/assembly/balance.hpp"
#include "eigengrain/assembly/forces.hpp"
#include "eigengrain/assembly/linear_system.hpp"
#include "eigengrain/assembly/state.hpp"

#include "petsc/handles.hpp"
#include "petsc/stiffness_matrix.hpp"

#include <cstdint>
#include <vector>

namespace eigengrain::relaxation {

/// The equations: residual and Jacobian in the unknowns (u, R θ), all lengths, with residuals (force,
/// moment/R), all forces, so that one norm means something for both.
///
/// Those of all contacts that act or are listed up to `reach` (m), from a state as it stands; it must stay.
class Equations {
 public:
  Equations(const assembly::State& state, double reach);

  Mat jacobian() const { return matrix_.mat(); }
  const assembly::Displacement& moved() const { return moved_; }
  /// The same of all balls, which those of clumps share.
  const assembly::Displacement& moved_balls() const { return clumps().empty() ? moved_ : carried_; }

  /// r(x) = -(contacts + gravity + applied loads) on the free components.
  void residual(Vec x, Vec r);
  /// On all bodies where residual() was last asked, fixed ones too, N. As what bodies do to each other
  /// cancels, its change is minus that of the forces on the walls.
  Vec3 total_force() const;
  /// From now on walls have moved as well, to where the state has them; null: they rest.
  void set_walls(const assembly::WallStep* walls) { walls_ = walls; }

  /// A longer step after a residual that has fallen, a shorter one after one that has grown.
  void adapt_step(double ratio_before, double ratio_now);

  /// The consistent tangent where residual() was last asked, and the shift for the residual r there.
  void assemble(Vec r);

  /// Largest over smallest normal stiffness of the contacts that act or may.
  double contrast() const;

  /// (e_k, 0) and (e_k × x, e_k) in the unknowns, with zeros at fixed components.
  std::vector<petsc::Vector> rigid_motions() const;

  /// Mean unbalanced ratio of a residual, the larger of forces and moments, over the mean contact force of
  /// the committed state.
  double ratio(Vec r) const;

  /// Shortens the step of each body that would leave what the list of contacts knows; whether any had to.
  /// Body by body: one that floats or rolls must not hold up the others.
  bool limit(Vec x, Vec y) const;

 private:
  const model::Clumps& clumps() const { return state_.model.bodies.clumps; }

  /// Forces of contacts on balls to those on bodies with all loads; moments of clumps along their axes.
  void gather_forces();
  /// What the unknowns of clumps, along their axes, mean for their balls.
  void carry_clumps();

  /// σ: with it alone, the body that is accelerated most would step by longest_step.
  double shift_for(Vec r) const;

  template <class Visit>
  void for_each_number(const Visit& visit) const {
    const assembly::Unknowns& unknowns = system_.unknowns;
    for (std::int32_t block = 0; block < unknowns.blocks(); ++block)
      for (int k = 0; k < 3; ++k)
        visit(std::size_t{3} * block + k, unknowns.body(block), k, unknowns.is_rotation(block),
              unknowns.is_fixed(block, k));
  }

  void fill_scale();

  void place(Vec x);
  assembly::Trial trial() const {
    return {position_, moved_balls().translation, moved_balls().rotation, 1.0, orientation_, 0.0, walls_};
  }

  const assembly::State& state_;
  assembly::LinearSystem system_;
  assembly::ContactForceSum forces_;
  petsc::StiffnessMatrix matrix_;
  assembly::Balance balance_;
  const assembly::WallStep* walls_ = nullptr;
  double reach_;         ///< of the list of contacts, m
  double longest_step_;  ///< of a body that nothing holds, m
  petsc::Vector scale_;
  petsc::Vector mass_;              ///< of the unknowns: m and I/R²
  assembly::Displacement moved_;    ///< of bodies: of a clump in the row of its holder
  assembly::Displacement carried_;  ///< of all balls, where there are clumps
  std::vector<Vec3> position_;
  std::vector<Quat> orientation_;
  assembly::BodyForces sum_;
};

/// The displacement of bodies, and of all balls, becomes a part of the state, with that of walls if they
/// moved.
void commit(assembly::State& state, const assembly::Displacement& of_bodies,
            const assembly::Displacement& of_balls, const assembly::WallStep* walls = nullptr);

}  // namespace eigengrain::relaxation
