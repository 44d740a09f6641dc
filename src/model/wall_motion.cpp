#include "eigengrain/model/wall_motion.hpp"

#include <algorithm>

namespace eigengrain::model {

WallPose WallPose::moved(const Vec3& u, const Vec3& theta) const {
  WallPose result{centre + u, orientation};
  const double angle = theta.norm();
  // Without a turn the orientation keeps its bits.
  if (angle > 0) {
    result.orientation = Eigen::Quaterniond(Eigen::AngleAxisd(angle, theta / angle)) * orientation;
    result.orientation.normalize();
  }
  return result;
}

WallVelocity WallMotion::at(double t) const {
  const auto after = std::upper_bound(time.begin(), time.end(), t);
  if (after == time.begin()) return velocity.front();
  if (after == time.end()) return velocity.back();
  const auto k = static_cast<std::size_t>(after - time.begin());
  const double part = (t - time[k - 1]) / (time[k] - time[k - 1]);
  const WallVelocity& first = velocity[k - 1];
  const WallVelocity& second = velocity[k];
  return {first.translation + part * (second.translation - first.translation),
          first.spin + part * (second.spin - first.spin)};
}

void carry(const Plane& start, const WallMotion& motion, const WallPose& pose, Plane& plane) {
  plane.point = pose.point(start.point, motion.start);
  plane.normal = pose.orientation * start.normal;
  plane.centre = pose.centre;
}

}  // namespace eigengrain::model
