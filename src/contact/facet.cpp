#include "eigengrain/contact/facet.hpp"

#include <algorithm>

namespace eigengrain::contact {
namespace {

using Kind = FacetFeature::Kind;

/// A point so little outside of a triangle, in barycentric coordinates, counts as inside: over an edge
/// between two triangles in one plane, rounding would otherwise take it out of both.
constexpr double inside = -1e-12;

std::uint8_t index(int k) {
  return static_cast<std::uint8_t>(k);
}

NearestPoint on_edge(const model::Facet& facet, int k, double part) {
  part = std::clamp(part, 0.0, 1.0);
  const Vec3& from = facet.corner[static_cast<std::size_t>(k)];
  const Vec3& to = facet.corner[static_cast<std::size_t>((k + 1) % 3)];
  return {from + part * (to - from), {Kind::edge, index(k)}};
}

NearestPoint at_corner(const model::Facet& facet, int k) {
  return {facet.corner[static_cast<std::size_t>(k)], {Kind::corner, index(k)}};
}

/// Unit vector along edge k.
Vec3 along(const model::Facet& facet, int k) {
  return (facet.corner[static_cast<std::size_t>((k + 1) % 3)] - facet.corner[static_cast<std::size_t>(k)])
      .normalized();
}

/// The nearest point of the feature as it goes on beyond the triangle.
Vec3 nearest_of(const Vec3& x, const model::Facet& facet, FacetFeature feature) {
  const Vec3& corner = facet.corner[feature.k];
  if (feature.kind == Kind::corner) return corner;
  const Vec3 e = along(facet, feature.k);
  return corner + (x - corner).dot(e) * e;
}

}  // namespace

// The regions of a triangle's plane (Ericson, Real-Time Collision Detection, 2005, section 5.1.5), asked of
// the foot of x in the plane: far from it, the small differences would be lost.
NearestPoint nearest_point(const Vec3& x, const model::Facet& facet) {
  const auto& [a, b, c] = facet.corner;
  const Vec3 p = x - (x - a).dot(facet.normal) * facet.normal;
  const Vec3 ab = b - a;
  const Vec3 ac = c - a;
  const double ab_a = ab.dot(p - a);
  const double ac_a = ac.dot(p - a);
  const double ab_b = ab.dot(p - b);
  const double ac_b = ac.dot(p - b);
  const double ab_c = ab.dot(p - c);
  const double ac_c = ac.dot(p - c);
  // Twice the area squared times the barycentric coordinates of a, b and c.
  const double of_a = ab_b * ac_c - ab_c * ac_b;
  const double of_b = ab_c * ac_a - ab_a * ac_c;
  const double of_c = ab_a * ac_b - ab_b * ac_a;
  const double out = inside * ab.cross(ac).squaredNorm();
  if (of_a >= out && of_b >= out && of_c >= out) return {p, {Kind::face, 0}};

  if (ab_a <= 0 && ac_a <= 0) return at_corner(facet, 0);
  if (ab_b >= 0 && ac_b <= ab_b) return at_corner(facet, 1);
  if (ac_c >= 0 && ab_c <= ac_c) return at_corner(facet, 2);
  if (of_c <= 0 && ab_a >= 0 && ab_b <= 0) return on_edge(facet, 0, ab_a / (ab_a - ab_b));
  if (of_b <= 0 && ac_a >= 0 && ac_c <= 0) return on_edge(facet, 2, 1 - ac_a / (ac_a - ac_c));
  const double from_b = ac_b - ab_b;
  const double from_c = ab_c - ac_c;
  return on_edge(facet, 1, from_b / (from_b + from_c));
}

ContactGeometry ball_feature(const Vec3& x, double r, const model::Facet& facet, FacetFeature feature,
                             int side, const Vec3& centre, double cut) {
  Vec3 n;
  double distance = 0;
  if (feature.kind == Kind::face) {
    n = -side * facet.normal;
    distance = side * (x - facet.corner[0]).dot(facet.normal);
  } else {
    const Vec3 branch = nearest_of(x, facet, feature) - x;
    distance = branch.norm();
    n = branch / distance;
  }
  const double overlap = r - distance;
  const Vec3 lever = (r - cut * overlap) * n;
  return {n, overlap, lever, x + lever - centre, r, cut};
}

Mat3 feature_curvature(const Vec3& x, const model::Facet& facet, FacetFeature feature) {
  if (feature.kind == Kind::face) return Mat3::Zero();
  const Vec3 branch = nearest_of(x, facet, feature) - x;
  const double distance = branch.norm();
  const Vec3 n = branch / distance;
  Mat3 across = Mat3::Identity() - n * n.transpose();
  if (feature.kind == Kind::edge) {
    const Vec3 e = along(facet, feature.k);
    across -= e * e.transpose();
  }
  return across / distance;
}

}  // namespace eigengrain::contact
