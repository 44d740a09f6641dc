#pragma once

#include "eigengrain/model/bodies.hpp"

#include <filesystem>
#include <span>

namespace eigengrain::io {

/// A motion of all bodies, of clumps in the rows of their holders.
struct ModeShape {
  std::span<const Vec3> displacement;  ///< [bodies] u
  std::span<const Vec3> rotation;      ///< [bodies] θ, along the axes of space
  std::span<const double> energy;      ///< [bodies] share of the kinetic energy
};

/// Writes modes for ParaView (.vtu): a point a ball, in the order of identity, with radius, identity and of
/// each mode k = 1, 2, ... `mode_k_displacement` (m; of the ball's own centre), `mode_k_rotation` (rad) and
/// `mode_k_energy` (of the whole body that the ball belongs to). Each mode is scaled so that no ball moves,
/// or turns its surface, by more than its radius.
void write_modes(const std::filesystem::path& file, const model::Bodies& bodies,
                 std::span<const ModeShape> modes);

}  // namespace eigengrain::io
