#pragma once

#include "eigengrain/assembly/model.hpp"
#include "eigengrain/measures/partial.hpp"
#include "eigengrain/model/region.hpp"

#include <array>
#include <cmath>
#include <cstdint>
#include <variant>

namespace eigengrain::measures {

/// The box of all that there is. Along each axis: the cell where that repeats; else from wall to wall, where
/// planes stand across the axis; else as far as the balls reach.
model::BoxRegion whole_box(const assembly::Model& model);

/// A region that looks at a model: what of it is inside, periodic images included. A region may reach out of
/// the periodic cell, and then sees images.
class Window {
 public:
  Window(const model::Region& region, const assembly::Model& model);

  double volume() const { return volume_; }  ///< m³

  /// Part of a line inside, summed over its images.
  double line(const Vec3& start, const Vec3& way) const;
  /// Volume of a ball inside, summed over its images, m³.
  double ball(const Vec3& centre, double radius) const;
  /// Calls visitor(image) for every image of the point that is inside.
  template <class Visitor>
  void for_each_inside(const Vec3& x, const Visitor& visitor) const {
    for_each_image(x, x, [&](const Vec3& shift) {
      const Vec3 image = x + shift;
      if (std::visit([&](const auto& shape) { return model::contains(shape, image); }, shape_))
        visitor(image);
    });
  }

 private:
  /// Calls visitor(shift) for every image of the box from `low` to `high` that may meet the region.
  template <class Visitor>
  void for_each_image(const Vec3& low, const Vec3& high, const Visitor& visitor) const {
    std::array<std::int64_t, 3> first{};
    std::array<std::int64_t, 3> last{};
    for (int k = 0; k < 3; ++k) {
      if (!(period_[k] > 0)) continue;
      first[k] = static_cast<std::int64_t>(std::ceil((low_[k] - high[k]) / period_[k]));
      last[k] = static_cast<std::int64_t>(std::floor((high_[k] - low[k]) / period_[k]));
    }
    for (std::int64_t i = first[0]; i <= last[0]; ++i)
      for (std::int64_t j = first[1]; j <= last[1]; ++j)
        for (std::int64_t k = first[2]; k <= last[2]; ++k)
          visitor(Vec3(static_cast<double>(i) * period_[0], static_cast<double>(j) * period_[1],
                       static_cast<double>(k) * period_[2]));
  }

  std::variant<model::SphereRegion, model::BoxRegion> shape_;
  double volume_ = 0;
  Vec3 low_ = Vec3::Zero();  ///< the region lies between low_ and high_
  Vec3 high_ = Vec3::Zero();
  Vec3 period_ = Vec3::Zero();  ///< m; 0 along an axis of which only the bodies as they are count
};

}  // namespace eigengrain::measures
