#pragma once

#include "eigengrain/model/wall_motion.hpp"

#include "section.hpp"

#include <filesystem>
#include <optional>
#include <vector>

namespace eigengrain::io {

/// What an entry of `walls` says of its motion.
struct WallMotionKeys {
  std::optional<Vec3> centre;
  std::vector<double> time;                   ///< s; empty: the wall stands still
  std::vector<model::WallVelocity> velocity;  ///< [time]

  bool moves() const { return !time.empty(); }
};

/// Reads `velocity`, `spin`, `centre`, `motion` and `motion_file` of a wall; paths are relative to `folder`.
WallMotionKeys read_wall_motion(const Section& wall, const std::filesystem::path& folder);

}  // namespace eigengrain::io
