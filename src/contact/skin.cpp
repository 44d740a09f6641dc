#include "eigengrain/contact/skin.hpp"

#include "eigengrain/contact/facet.hpp"

namespace eigengrain::contact {

SkinPoint skin_point(const Placement& placement, const Pair& pair) {
  const model::Facet& facet = placement.facets->facet[static_cast<std::size_t>(pair.b)];
  const Vec3& x = placement.position[static_cast<std::size_t>(pair.a)];
  const Vec3 p = nearest_point(x, facet).point;
  const auto& corner = facet.corner;
  const Vec3& n = facet.normal;
  SkinPoint result;
  double whole = 0;
  std::array<double, 3> twice_area{};
  for (std::size_t i = 0; i < 3; ++i) {
    const Vec3& next = corner[(i + 1) % 3];
    const Vec3& last = corner[(i + 2) % 3];
    const double area = n.dot((next - p).cross(last - p));
    twice_area[i] = area > 0 ? area : 0;  // on an edge, rounding may say less than nothing
    whole += twice_area[i];
  }
  const double inverse = 1 / n.dot((corner[1] - corner[0]).cross(corner[2] - corner[0]));
  for (std::size_t i = 0; i < 3; ++i) {
    result.body[i] = placement.facets->body[static_cast<std::size_t>(facet.vertex[i])];
    result.weight[i] = twice_area[i] / whole;
    // ∇N_i = n × (the edge opposite of it) / twice the area, so n × ∇N_i is minus that edge over it.
    const Vec3 t = -inverse * (corner[(i + 2) % 3] - corner[(i + 1) % 3]);
    result.turn[i] = 0.5 * n * t.transpose() - t * n.transpose();
  }
  return result;
}

}  // namespace eigengrain::contact
