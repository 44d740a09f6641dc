#include "eigengrain/model/clumps.hpp"

#include "eigengrain/base/assert.hpp"
#include "eigengrain/model/bodies.hpp"

#include <algorithm>

namespace eigengrain::model {

Vec3 angular_momentum(const Clumps& clumps, std::int32_t clump, const Vec3& spin) {
  const auto c = static_cast<std::size_t>(clump);
  const Quat& q = clumps.orientation[c];
  return q * Vec3(clumps.inertia[c].cwiseProduct(q.conjugate() * spin));
}

Vec3 angular_velocity(const Clumps& clumps, std::int32_t clump) {
  const auto c = static_cast<std::size_t>(clump);
  const Quat& q = clumps.orientation[c];
  return q * Vec3((q.conjugate() * clumps.angular_momentum[c]).cwiseQuotient(clumps.inertia[c]));
}

void place_members(Bodies& bodies) {
  const Clumps& clumps = bodies.clumps;
  for (std::size_t c = 0; c < clumps.position.size(); ++c)
    for (auto m = static_cast<std::size_t>(clumps.starts[c]);
         m < static_cast<std::size_t>(clumps.starts[c + 1]); ++m)
      bodies.position[static_cast<std::size_t>(clumps.member[m])] =
          clumps.position[c] + clumps.orientation[c] * clumps.place[m];
}

void add_clump(Bodies& bodies, const ClumpShape& shape, const ClumpStart& start) {
  EIGENGRAIN_ASSERT(shape.place.size() == shape.radius.size() && !shape.place.empty(), shape.place.size());
  EIGENGRAIN_ASSERT(start.fixed.rotation() == 0 || start.fixed.rotation() == 7, start.fixed.bits());
  Clumps& clumps = bodies.clumps;
  const auto clump = clumps.size();
  double radius = 0;
  for (std::size_t k = 0; k < shape.place.size(); ++k)
    radius = std::max(radius, shape.place[k].norm() + shape.radius[k]);
  clumps.identity.push_back(clump);
  clumps.mass.push_back(shape.mass);
  clumps.volume.push_back(shape.volume);
  clumps.radius.push_back(radius);
  clumps.inertia.push_back(shape.inertia);
  clumps.position.push_back(start.position);
  clumps.orientation.push_back(start.orientation);
  clumps.velocity.push_back(start.velocity);
  clumps.spin.push_back(start.spin);
  clumps.angular_momentum.emplace_back(angular_momentum(clumps, clump, start.spin));

  bodies.velocity.resize(bodies.position.size(), Vec3::Zero());
  bodies.spin.resize(bodies.position.size(), Vec3::Zero());
  clumps.of_row.resize(bodies.position.size(), Clumps::none);
  const Vec3 none = Vec3::Zero();
  for (std::size_t k = 0; k < shape.place.size(); ++k) {
    const bool holds = k == 0;  // the row in whose name the clump is loaded
    add_row(bodies.applied_force, bodies.size(), holds ? start.force : none, none);
    add_row(bodies.applied_moment, bodies.size(), holds ? start.moment : none, none);
    add_row(bodies.damping, bodies.size(), start.damping, Bodies::scene_damping);
    if (!bodies.ramp.empty()) bodies.ramp.emplace_back();
    const Vec3 lever = start.orientation * shape.place[k];
    clumps.member.push_back(bodies.size());
    clumps.place.push_back(shape.place[k]);
    clumps.of_row.push_back(clump);
    bodies.identity.push_back(bodies.size());
    bodies.position.emplace_back(start.position + lever);
    bodies.radius.push_back(shape.radius[k]);
    bodies.mass.push_back(shape.mass);
    bodies.inertia.push_back(shape.inertia.minCoeff());
    bodies.material.push_back(start.material);
    bodies.fixed.push_back(start.fixed);
    bodies.velocity.emplace_back(start.velocity + start.spin.cross(lever));
    bodies.spin.push_back(start.spin);
  }
  clumps.starts.push_back(static_cast<std::int32_t>(clumps.member.size()));
}

}  // namespace eigengrain::model
