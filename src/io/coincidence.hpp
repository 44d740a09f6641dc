#pragma once

#include "eigengrain/base/vec.hpp"
#include "eigengrain/model/surroundings.hpp"

#include <cstdint>
#include <span>
#include <utility>
#include <vector>

namespace eigengrain::io {

/// Pairs of balls whose centres are the same to 1e-9 of the sum of their radii, also through the periodic
/// cell. Of several at one place, each is paired with the first only. The first of a pair is the smaller
/// index; pairs are sorted.
///
/// centres  [n] m, wrapped into the cell
/// radii    [n] m
///
/// Cost O(n log n), for balls on a lattice, on a line or all at one place too.
std::vector<std::pair<std::int32_t, std::int32_t>> coincident_balls(std::span<const Vec3> centres,
                                                                    std::span<const double> radii,
                                                                    const model::PeriodicCell& cell);

}  // namespace eigengrain::io
