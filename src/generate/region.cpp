#include "eigengrain/generate/region.hpp"

#include "eigengrain/base/error.hpp"
#include "eigengrain/model/bodies.hpp"

#include <fmt/format.h>

namespace eigengrain::generate {

double solid_fraction(std::span<const double> radii, const Region& region) {
  double solid = 0;
  for (const double r : radii) solid += model::sphere_mass(r, 1.0);
  return solid / region.volume();
}

void require_room(double radius, const Region& region) {
  const Vec3 edges = region.edges();
  for (int k = 0; k < 3; ++k) {
    if (region.periodic[k] || 2 * radius <= edges[k] * (1 + negligible)) continue;
    throw InputError(fmt::format(
        "a ball of radius {:.6g} m does not fit into the region, which is {:.6g} m wide along {}; make the "
        "region larger or the balls smaller",
        radius, edges[k], "xyz"[k]));
  }
}

void require_room_for_image(double radius, const Region& region) {
  const Vec3 edges = region.edges();
  for (int k = 0; k < 3; ++k) {
    if (!region.periodic[k] || 2 * radius <= edges[k] * (1 + negligible)) continue;
    throw InputError(
        fmt::format("a ball of radius {:.6g} m overlaps its own image, as the cell is {:.6g} m long along "
                    "{}; make the cell longer or the balls smaller",
                    radius, edges[k], "xyz"[k]));
  }
}

}  // namespace eigengrain::generate
