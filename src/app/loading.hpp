#pragma once

#include "eigengrain/base/vec.hpp"

#include "verbs.hpp"

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

/// Loading programs: one equilibrium after the other along a path (`relax --load`).
namespace eigengrain::app {

/// A key of the scene whose numbers go from one value to another.
struct KeyPath {
  std::string key;
  std::vector<double> from;
  std::vector<double> to;  ///< as many
  bool list = false;       ///< written in brackets

  /// "key=value" at a part of the way, in [0, 1].
  std::string at(double part) const;
};

/// A wall that is moved, by so much in all, m.
struct WallPath {
  std::int32_t wall = 0;
  Vec3 displacement = Vec3::Zero();
};

struct LoadingPath {
  std::vector<KeyPath> keys;
  std::vector<WallPath> walls;
  std::optional<Mat3> strain;  ///< of the periodic cell in all: H_end = (1 + E) H
};

/// Of the texts of --load:
///     KEY=FROM..TO                 a key of the scene: a number, or a list of numbers
///     displacement.WALL=[x, y, z]  of a wall by its number, m
///     strain=[[..], [..], [..]]    of the periodic cell
/// Throws InputError with every mistake.
LoadingPath path_of(const std::vector<std::string>& loads);

/// Relaxes at the end of every increment of the path, saves STEM-load-K.h5 there, and adds a line to
/// STEM-load.csv; bonds that broke on the way to it are in STEM-load-K-breaks.csv. With --continue it goes on
/// behind the last of these states, else they are removed at the start. Throws SolverError where an increment
/// finds no equilibrium, Interrupted after an interrupt: the nearest state is then in STEM-load-nearest.h5,
/// and what was saved before stays.
void relax_along(const Options& options);

}  // namespace eigengrain::app
