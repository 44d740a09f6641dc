#pragma once

#include "eigengrain/assembly/forces.hpp"
#include "eigengrain/assembly/model.hpp"
#include "eigengrain/contact/orientation.hpp"

#include <cstdint>
#include <span>

/// Between the balls of a clump, which have the contacts, and its holder, which has the unknowns: kinematics
/// from the holder to the balls, and its transpose from their forces to the holder.
namespace eigengrain::assembly {

/// From the centre of the body that a ball belongs to, to the ball's own: zero for a body of one ball, m.
inline Vec3 lever_of(const model::Bodies& bodies, std::int32_t row) {
  const std::int32_t clump = bodies.clumps.of(row);
  if (clump == model::Clumps::none) return Vec3::Zero();
  return bodies.position[static_cast<std::size_t>(row)] -
         bodies.clumps.position[static_cast<std::size_t>(clump)];
}

/// The same after a rotation θ [bodies] (rad) from the committed state.
inline Vec3 lever_of(const model::Bodies& bodies, std::int32_t row, std::span<const Vec3> rotation,
                     double duration = 1) {
  const Vec3 lever = lever_of(bodies, row);
  if (rotation.empty() || lever.isZero(0)) return lever;
  return contact::turned(Quat::Identity(), duration * rotation[static_cast<std::size_t>(row)]) * lever;
}

/// Force on a clump (N) and moment about its centre (N m), along the axes of space.
struct Resultant {
  Vec3 force = Vec3::Zero();
  Vec3 moment = Vec3::Zero();
};

/// Of the contacts of its balls, in the order of the scene.
///
/// force, moment  [bodies] on each ball, the moment about its own centre
Resultant resultant_on(const model::Bodies& bodies, std::int32_t clump, std::span<const Vec3> force,
                       std::span<const Vec3> moment);

/// Gives all balls of clumps the displacement that follows from their holder's, exactly: the holder's u is
/// that of the clump's centre, and its θ (in space) turns the clump. The holder's row becomes that of its own
/// ball. Needs rotations where there are clumps.
void carry_members(const model::Bodies& bodies, Displacement& moved);

/// Sums forces of balls, and moments about their centres, to those of their clumps, about the clump's centre,
/// into the rows of the holders; the other balls of clumps get zeros. Balls of their own keep theirs.
///
/// rotation  θ [bodies] since the committed state, in which the bodies are; empty: none
void gather_members(const model::Bodies& bodies, std::span<const Vec3> rotation, BodyForces& forces);

/// The centres of clumps and what turns with them after a displacement becomes a part of the state;
/// `moved_holders` as it was before carry_members. Balls are placed anew.
void commit_clumps(model::Bodies& bodies, const Displacement& moved_holders);

}  // namespace eigengrain::assembly
