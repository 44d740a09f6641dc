#pragma once

#include "eigengrain/base/vec.hpp"
#include "eigengrain/contact/geometry.hpp"
#include "eigengrain/model/surface.hpp"

#include <cstdint>

namespace eigengrain::contact {

/// The part of a triangle that is nearest to a point: its face, edge k (from corner k to the next) or
/// corner k.
struct FacetFeature {
  enum class Kind : std::uint8_t { face, edge, corner };
  Kind kind = Kind::face;
  std::uint8_t k = 0;

  friend bool operator==(const FacetFeature&, const FacetFeature&) = default;
};

/// The point of a triangle that is nearest to x.
struct NearestPoint {
  Vec3 point;
  FacetFeature feature;
};

NearestPoint nearest_point(const Vec3& x, const model::Facet& facet);

/// A ball and a feature of a facet, as the feature goes on beyond the triangle: a plane, a line, a point.
///   face          n = -side · normal, U = r - side · (signed distance): a centre that has crossed keeps its
///                 contact
///   edge, corner  n from the centre to the nearest point of the line, or to the corner; U = r - distance
/// R_b is taken from `centre`. side: 1 or -1, on which side of the facet the ball is.
ContactGeometry ball_feature(const Vec3& x, double r, const model::Facet& facet, FacetFeature feature,
                             int side, const Vec3& centre, double cut = to_contact_point);

/// How n turns when the ball moves by u_a and the facet by u_b: dn = C (u_b - u_a) [3×3, 1/m]. Zero on a
/// face, across the edge only on an edge, all across n at a corner.
Mat3 feature_curvature(const Vec3& x, const model::Facet& facet, FacetFeature feature);

}  // namespace eigengrain::contact
