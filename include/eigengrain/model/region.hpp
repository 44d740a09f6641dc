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

}  // namespace eigengrain::model
