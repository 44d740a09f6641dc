#include "eigengrain/assembly/clump_members.hpp"

#include "eigengrain/base/assert.hpp"

namespace eigengrain::assembly {

Resultant resultant_on(const model::Bodies& bodies, std::int32_t clump, std::span<const Vec3> force,
                       std::span<const Vec3> moment) {
  Resultant sum;
  for (const std::int32_t row : bodies.clumps.members(clump)) {
    const auto i = static_cast<std::size_t>(row);
    sum.force += force[i];
    sum.moment += moment[i] + lever_of(bodies, row).cross(force[i]);
  }
  return sum;
}

void carry_members(const model::Bodies& bodies, Displacement& moved) {
  const model::Clumps& clumps = bodies.clumps;
  if (clumps.empty()) return;
  EIGENGRAIN_ASSERT(moved.rotation.size() == bodies.position.size(), moved.rotation.size());
  for (std::int32_t c = 0; c < clumps.size(); ++c) {
    const auto holder = static_cast<std::size_t>(clumps.holder(c));
    const Vec3 u = moved.translation[holder];
    const Vec3 theta = moved.rotation[holder];
    const Quat turn = contact::turned(Quat::Identity(), theta);
    for (const std::int32_t row : clumps.members(c)) {
      const auto i = static_cast<std::size_t>(row);
      moved.translation[i] = u + model::turned_by(turn, lever_of(bodies, row));
      moved.rotation[i] = theta;
    }
  }
}

void gather_members(const model::Bodies& bodies, std::span<const Vec3> rotation, BodyForces& forces) {
  const model::Clumps& clumps = bodies.clumps;
  for (std::int32_t c = 0; c < clumps.size(); ++c) {
    Vec3 force = Vec3::Zero();
    Vec3 moment = Vec3::Zero();
    for (const std::int32_t row : clumps.members(c)) {
      const auto i = static_cast<std::size_t>(row);
      force += forces.force[i];
      moment += forces.moment[i] + lever_of(bodies, row, rotation).cross(forces.force[i]);
      forces.force[i].setZero();
      forces.moment[i].setZero();
    }
    const auto holder = static_cast<std::size_t>(clumps.holder(c));
    forces.force[holder] = force;
    forces.moment[holder] = moment;
  }
}

void commit_clumps(model::Bodies& bodies, const Displacement& moved_holders) {
  model::Clumps& clumps = bodies.clumps;
  if (clumps.empty()) return;
  for (std::size_t c = 0; c < clumps.position.size(); ++c) {
    const auto holder = static_cast<std::size_t>(clumps.holder(static_cast<std::int32_t>(c)));
    clumps.position[c] += moved_holders.translation[holder];
    clumps.orientation[c] = contact::turned(clumps.orientation[c], moved_holders.rotation[holder]);
  }
  model::place_members(bodies);
}

}  // namespace eigengrain::assembly
