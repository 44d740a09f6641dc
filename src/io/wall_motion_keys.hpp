#pragma once

#include "eigengrain/model/wall_motion.hpp"

#include "section.hpp"

#include <filesystem>
#include <optional>
#include <vector>

namespace eigengrain::io {

/// The section `servo` of a wall.
struct ServoKeys {
  std::optional<Vec3> direction;  ///< unit; absent: the normal
  std::optional<double> force;    ///< N
  std::optional<double> stress;   ///< Pa
  std::optional<double> area;     ///< m²
  double relaxation = 0;
  double max_speed = 0;  ///< m/s
};

/// What an entry of `walls` says of its motion.
struct WallMotionKeys {
  std::optional<Vec3> centre;
  std::vector<double> time;                   ///< s; empty: the wall stands still
  std::vector<model::WallVelocity> velocity;  ///< [time]
  std::optional<ServoKeys> servo;

  bool moves() const { return !time.empty(); }
};

/// The motion of one wall of the entry. normal, area: its own, where the entry says none; an area of 0 or a
/// normal of zero has to be given. Reports at `wall` what is missing.
std::optional<model::WallMotion> wall_motion(const Section& wall, const WallMotionKeys& keys,
                                             std::int32_t index, const Vec3& centre, const Vec3& normal,
                                             double area);

/// Reads `servo`, `velocity`, `spin`, `centre`, `motion` and `motion_file` of a wall; paths are relative to
/// `folder`.
WallMotionKeys read_wall_motion(const Section& wall, const std::filesystem::path& folder);

}  // namespace eigengrain::io
