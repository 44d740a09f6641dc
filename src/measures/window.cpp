#include "eigengrain/measures/window.hpp"

#include <Eigen/LU>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

namespace eigengrain::measures {
namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();

/// A plane stands across an axis if its normal is the axis, to the rounding of a normalised vector.
constexpr double along_axis = 1 - 1e-14;

/// Volume of a slanted cell, or what of it lies between the ends of a box along axes that do not repeat.
double volume_between(const model::BoxRegion& box, const model::PeriodicCell& cell) {
  double volume = std::abs(cell.basis().determinant());
  for (int k = 0; k < 3; ++k)
    if (!cell.periodic[k]) volume *= box.max[k] - box.min[k];
  return volume;
}

}  // namespace

model::BoxRegion whole_box(const assembly::Model& model) {
  model::BoxRegion box{Vec3::Constant(infinity), Vec3::Constant(-infinity)};
  for (std::size_t i = 0; i < model.bodies.position.size(); ++i) {
    box.min = box.min.cwiseMin(model.bodies.position[i] - Vec3::Constant(model.bodies.radius[i]));
    box.max = box.max.cwiseMax(model.bodies.position[i] + Vec3::Constant(model.bodies.radius[i]));
  }
  for (int k = 0; k < 3; ++k) {
    double low = -infinity;
    double high = infinity;
    for (const model::Plane& wall : model.walls) {
      if (wall.normal[k] > along_axis) low = std::max(low, wall.point[k]);
      if (wall.normal[k] < -along_axis) high = std::min(high, wall.point[k]);
    }
    if (low > -infinity) box.min[k] = low;
    if (high < infinity) box.max[k] = high;
    if (!model.cell.periodic[k]) continue;
    box.min[k] = model.cell.origin[k];
    box.max[k] = model.cell.origin[k] + model.cell.edges(k, k);
  }
  return box;
}

Window::Window(const model::Region& region, const assembly::Model& model) {
  cell_.periodic = model.cell.periodic;
  for (int k = 0; k < 3; ++k)
    if (cell_.periodic[k]) cell_.edges.col(k) = model.cell.edges.col(k);
  rate_ = model.cell.rate;
  slanted_ = !cell_.orthogonal();
  if (slanted_) inverse_ = cell_.inverse();
  if (const auto* sphere = std::get_if<model::SphereRegion>(&region.shape)) {
    shape_ = *sphere;
    volume_ = 4 * std::numbers::pi / 3 * sphere->radius * sphere->radius * sphere->radius;
    low_ = sphere->centre - Vec3::Constant(sphere->radius);
    high_ = sphere->centre + Vec3::Constant(sphere->radius);
    return;
  }
  const auto* given = std::get_if<model::BoxRegion>(&region.shape);
  model::BoxRegion box = given != nullptr ? *given : whole_box(model);
  volume_ = given == nullptr && slanted_ ? volume_between(box, cell_) : (box.max - box.min).prod();
  for (int k = 0; k < 3; ++k) {
    // A box of just one period holds everything once: clipping it and adding the images up again would only
    // add rounding. Bodies may stand a little outside of the cell until the next list wraps them.
    const bool one_period = cell_.periodic[k] &&
                            (given == nullptr || (!slanted_ && box.max[k] - box.min[k] == cell_.edges(k, k)));
    if (!one_period) continue;
    cell_.periodic[k] = false;
    cell_.edges.col(k).setZero();
    box.min[k] = -infinity;
    box.max[k] = infinity;
  }
  shape_ = box;
  low_ = box.min;
  high_ = box.max;
}

Window::Range Window::images_of(const Vec3& low, const Vec3& high) const {
  Range range;
  if (!slanted_) {
    for (int k = 0; k < 3; ++k) {
      if (!cell_.periodic[k]) continue;
      const double period = cell_.edges(k, k);
      range.first[k] = static_cast<std::int64_t>(std::ceil((low_[k] - high[k]) / period));
      range.last[k] = static_cast<std::int64_t>(std::floor((high_[k] - low[k]) / period));
    }
    return range;
  }
  if (!cell_.any()) return range;
  const Vec3 middle = 0.5 * (inverse_ * (low_ - high + (high_ - low)));
  const Vec3 half = 0.5 * (inverse_.cwiseAbs() * (high_ - low - (low_ - high)));
  for (int k = 0; k < 3; ++k) {
    if (!cell_.periodic[k]) continue;
    range.first[k] = static_cast<std::int64_t>(std::ceil(middle[k] - half[k]));
    range.last[k] = static_cast<std::int64_t>(std::floor(middle[k] + half[k]));
  }
  return range;
}

double Window::line(const Vec3& start, const Vec3& way) const {
  double part = 0;
  const Vec3 end = start + way;
  for_each_image(start.cwiseMin(end), start.cwiseMax(end), [&](const Vec3& shift, const Vec3& /*cells*/) {
    part += std::visit([&](const auto& shape) { return line_inside(shape, start + shift, way); }, shape_);
  });
  return part;
}

double Window::ball(const Vec3& centre, double radius) const {
  double volume = 0;
  const Vec3 reach = Vec3::Constant(radius);
  for_each_image(centre - reach, centre + reach, [&](const Vec3& shift, const Vec3& /*cells*/) {
    volume +=
        std::visit([&](const auto& shape) { return ball_inside(shape, centre + shift, radius); }, shape_);
  });
  return volume;
}

}  // namespace eigengrain::measures
