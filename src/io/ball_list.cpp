#include "ball_list.hpp"

#include <fmt/format.h>

#include <cmath>
#include <limits>
#include <vector>

namespace eigengrain::io {
namespace {

/// Adds the next row to a column that is there only if some ball needs it; rows before are zero.
void add_row(std::vector<Vec3>& column, std::int32_t row, const Vec3& value) {
  if (column.empty() && value == Vec3::Zero()) return;
  column.resize(static_cast<std::size_t>(row), Vec3::Zero());
  column.push_back(value);
}

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
  add_row(bodies.velocity, bodies.size(), kind.velocity);
  add_row(bodies.spin, bodies.size(), kind.spin);
  bodies.identity.push_back(bodies.size());
  bodies.position.push_back(draft_.scene.cell.wrapped(position));
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
