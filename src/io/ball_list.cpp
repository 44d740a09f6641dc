#include "ball_list.hpp"

#include <fmt/format.h>

#include <cmath>
#include <limits>
#include <vector>

namespace eigengrain::io {
namespace {

/// With translation across a plane and rotation about axes in it fixed.
model::FixedComponents held_in_plane(model::FixedComponents fixed, int normal) {
  fixed.fix(normal);
  for (int k = 0; k < 3; ++k)
    if (k != normal) fixed.fix(3 + k);
  return fixed;
}

}  // namespace

void BallList::add(const Vec3& position, double radius, const BallKind& kind, std::int32_t line) {
  model::Bodies& bodies = draft_.scene.bodies;
  if (bodies.position.size() == std::numeric_limits<std::int32_t>::max()) return report_too_many(line);
  const bool disk = draft_.planar && draft_.planar->disks;
  const double mass = disk ? model::disk_mass(radius, density(kind.material))
                           : model::sphere_mass(radius, density(kind.material));
  const double inertia = disk ? model::disk_inertia(radius, mass) : model::sphere_inertia(radius, mass);
  if (!std::isnormal(inertia) && density(kind.material) > 0) report_size(radius, mass, line);
  const Vec3 none = Vec3::Zero();
  model::add_row(bodies.velocity, bodies.size(), kind.velocity, none);
  model::add_row(bodies.spin, bodies.size(), kind.spin, none);
  model::add_row(bodies.applied_force, bodies.size(), kind.force, none);
  model::add_row(bodies.applied_moment, bodies.size(), kind.moment, none);
  model::add_row(bodies.damping, bodies.size(), kind.damping, model::Bodies::scene_damping);
  model::RadiusRamp ramp = kind.growth.value_or(model::RadiusRamp());
  ramp.radius = radius;
  ramp.mass = mass;
  ramp.inertia = inertia;
  if (kind.growth && bodies.ramp.empty()) bodies.ramp.resize(bodies.position.size());
  if (kind.growth || !bodies.ramp.empty()) bodies.ramp.push_back(ramp);
  bodies.identity.push_back(bodies.size());
  bodies.position.push_back(draft_.wraps ? draft_.scene.cell.wrapped(position) : position);
  bodies.radius.push_back(radius);
  bodies.mass.push_back(mass);
  bodies.inertia.push_back(inertia);
  bodies.material.push_back(kind.material);
  bodies.fixed.push_back(draft_.planar ? held_in_plane(kind.fixed, draft_.planar->normal) : kind.fixed);
  draft_.ball_places.file.push_back(static_cast<std::int32_t>(draft_.ball_places.files.size()) - 1);
  draft_.ball_places.line.push_back(line);
}

double BallList::density(std::int32_t material) const {
  return material < 0 ? 1.0 : draft_.scene.materials[material].density;
}

void BallList::report_size(double radius, double mass, std::int32_t line) {
  diagnostics_.add(
      {draft_.ball_places.files.back(), line},
      fmt::format("radius {} m makes a mass of {} kg, which is no size for a number; are the units right?",
                  radius, mass),
      "mass");
}

void BallList::report_too_many(std::int32_t line) {
  diagnostics_.add({draft_.ball_places.files.back(), line}, "more than 2,147,483,647 balls",
                   "too many balls");
}

}  // namespace eigengrain::io
