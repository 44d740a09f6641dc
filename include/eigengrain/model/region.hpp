#pragma once

#include "eigengrain/base/vec.hpp"

#include <string>
#include <variant>

/// Where something is measured: plain data, as the scene says it.
namespace eigengrain::model {

/// All that there is; measures/window.hpp says which box that is.
struct WholeRegion {};

struct SphereRegion {
  Vec3 centre = Vec3::Zero();  ///< m
  double radius = 0;           ///< m
};

struct BoxRegion {
  Vec3 min = Vec3::Zero();  ///< lower corner, m
  Vec3 max = Vec3::Zero();  ///< upper corner, m
};

struct Region {
  std::string name;
  std::variant<WholeRegion, SphereRegion, BoxRegion> shape;
};

/// Whether a point lies inside; boxes are half open, so that boxes side by side share out every point.
inline bool contains(const WholeRegion& /*all*/, const Vec3& /*x*/) {
  return true;
}
inline bool contains(const SphereRegion& sphere, const Vec3& x) {
  return (x - sphere.centre).squaredNorm() < sphere.radius * sphere.radius;
}
inline bool contains(const BoxRegion& box, const Vec3& x) {
  return (x.array() >= box.min.array()).all() && (x.array() < box.max.array()).all();
}
inline bool contains(const Region& region, const Vec3& x) {
  return std::visit([&](const auto& shape) { return contains(shape, x); }, region.shape);
}

}  // namespace eigengrain::model
