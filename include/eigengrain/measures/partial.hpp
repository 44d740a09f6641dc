#pragma once

#include "eigengrain/base/vec.hpp"
#include "eigengrain/model/region.hpp"

/// How much of a ball or of a line lies in a region. Closed forms: exact up to rounding, which is a few 1e-16
/// of the whole ball or line.
namespace eigengrain::measures {

/// Volume of a ball of radius r inside a sphere, m³: nothing, a lens or the smaller of the two.
double ball_inside(const model::SphereRegion& sphere, const Vec3& centre, double r);

/// Volume of a ball of radius r inside a box, m³. Edges of the box may be infinite.
double ball_inside(const model::BoxRegion& box, const Vec3& centre, double r);

/// Part of the straight line from `start` to `start + way` inside a region, 0 to 1. Of a line in a face of a
/// box the lower face counts as inside and the upper one as outside, so that boxes side by side share out
/// every line and count none twice.
double line_inside(const model::SphereRegion& sphere, const Vec3& start, const Vec3& way);
double line_inside(const model::BoxRegion& box, const Vec3& start, const Vec3& way);

}  // namespace eigengrain::measures
