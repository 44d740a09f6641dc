#pragma once

#include "eigengrain/base/vec.hpp"
#include "eigengrain/model/surroundings.hpp"

#include <cstdint>
#include <optional>
#include <vector>

/// Walls that move: their motion is given and no force changes it.
namespace eigengrain::model {

/// A wall's velocity: that of its centre, and its angular velocity about the centre.
struct WallVelocity {
  Vec3 translation = Vec3::Zero();  ///< m/s
  Vec3 spin = Vec3::Zero();         ///< rad/s
};

/// Where a wall has been carried: its centre, and how it has turned about it since the start.
struct WallPose {
  Vec3 centre = Vec3::Zero();  ///< m
  Eigen::Quaterniond orientation = Eigen::Quaterniond::Identity();

  /// The pose after the centre moved by u and the wall turned about it by the rotation vector θ, exactly: the
  /// linear form of PFC3D's eq. 1.28 would stretch the wall by ½θ² a step.
  WallPose moved(const Vec3& u, const Vec3& theta) const;
  /// Where a point that started at x is now, for a wall whose centre started at `start`.
  Vec3 point(const Vec3& x, const Vec3& start) const { return centre + orientation * (x - start); }
};

/// What drives a wall to a force, beside its given velocity (assembly/servo.hpp).
struct Servo {
  Vec3 direction = Vec3::Zero();  ///< unit, the way in which it pushes
  double force = 0;               ///< wanted, of the wall on the bodies along the direction, N
  double relaxation = 0.5;        ///< α, the part of what is missing that a step makes up for
  double max_speed = 0;           ///< m/s
};

/// The motion of one wall: its velocity at given times, linear in between, constant before the first and
/// after the last.
struct WallMotion {
  std::int32_t wall = 0;               ///< index of the wall
  Vec3 start = Vec3::Zero();           ///< the centre at t = 0, m
  std::vector<double> time;            ///< s, increasing; at least one
  std::vector<WallVelocity> velocity;  ///< [time]
  std::optional<Servo> servo{};        ///< adds to the velocity

  WallVelocity at(double t) const;
};

/// A plane that started as `start`, carried along by a wall of that motion.
void carry(const Plane& start, const WallMotion& motion, const WallPose& pose, Plane& plane);

}  // namespace eigengrain::model
