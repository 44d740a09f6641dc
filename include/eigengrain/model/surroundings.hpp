#pragma once

#include "eigengrain/base/vec.hpp"

#include <array>
#include <cstdint>
#include <string>
#include <vector>

/// What surrounds the bodies: walls and the periodic cell.
namespace eigengrain::model {

/// An infinite one-sided plane; bodies live on the side that the normal points to (the active side).
/// A centre that has crossed the plane is still in contact from the active side.
struct Plane {
  Vec3 point;   ///< any point of the plane, m
  Vec3 normal;  ///< unit vector into the active side
  std::int32_t material = 0;
  std::string name;  ///< for messages, e.g. "wall 2 (-x)"
  /// Where it turns about if it moves, and where moments on it are taken about, m.
  Vec3 centre = Vec3::Zero();
};

/// Which copy of the periodic cell, in cells along its edges.
using Image = std::array<std::int8_t, 3>;

/// A parallelepiped that repeats along some of its edges. Edge k is that of axis k; edges of axes that do
/// not repeat stand at right angles to all others, along their axis. At the start of a scene all edges do.
struct PeriodicCell {
  Vec3 origin = Vec3::Zero();  ///< corner that the edges begin in, m; it never moves
  /// H: column k is edge k, m; an edge that does not repeat is as the scene has it, perhaps zero.
  Mat3 edges = Mat3::Zero();
  std::array<bool, 3> periodic{};
  /// L, 1/s: the edges follow dH/dt = L H. It couples axes that repeat.
  Mat3 velocity_gradient = Mat3::Zero();
  /// dH/dt in the last step (leapfrog: in its middle), m/s; zero while the cell rests. An image by k moves
  /// with rate k relative to its body.
  Mat3 rate = Mat3::Zero();

  /// A box with edges along the axes.
  static PeriodicCell box(const Vec3& origin, const Vec3& lengths, const std::array<bool, 3>& periodic) {
    return {.origin = origin, .edges = lengths.asDiagonal(), .periodic = periodic};
  }

  bool any() const { return periodic[0] || periodic[1] || periodic[2]; }
  /// Whether the edges that repeat stand along the axes.
  bool orthogonal() const;
  /// Whether the cell moves, or moved in the last step.
  bool deforms() const { return !velocity_gradient.isZero(0) || !rate.isZero(0); }
  /// Lengths of the edges, m.
  Vec3 lengths() const { return {edges.col(0).norm(), edges.col(1).norm(), edges.col(2).norm()}; }
  /// Volume of the cell where it repeats along all axes, m³.
  double volume() const;
  /// H with unit edges where the cell does not repeat.
  Mat3 basis() const;
  /// Its inverse: (H⁻¹(x - origin))_k is the place of x along edge k, in cells where that repeats.
  Mat3 inverse() const;
  /// The velocity of the flow that the cell moved with in the last step, as a gradient: rate H⁻¹, 1/s.
  Mat3 flow_gradient() const;

  /// Translation from the cell to its image, m. Written out, so that it is the same to the bit wherever it is
  /// asked (but in kernels that fuse, src/assembly/force_kernel.hpp), and exactly that of a box where the
  /// edges stand along the axes. Most contacts stay in the cell.
  template <class Integer>
  Vec3 shift(const std::array<Integer, 3>& image) const {
    if ((image[0] | image[1] | image[2]) == 0) return Vec3::Zero();
    const auto i = static_cast<double>(image[0]);
    const auto j = static_cast<double>(image[1]);
    const auto k = static_cast<double>(image[2]);
    return {i * edges(0, 0) + j * edges(0, 1) + k * edges(0, 2),
            i * edges(1, 0) + j * edges(1, 1) + k * edges(1, 2),
            i * edges(2, 0) + j * edges(2, 1) + k * edges(2, 2)};
  }
  /// In which copy of the cell x lies; 0 along axes that do not repeat. As doubles, which hold what is far.
  Vec3 cell_of(const Vec3& x) const;
  /// The copy of x that lies in the cell, origin <= x < origin + lengths in a box.
  Vec3 wrapped(const Vec3& x) const;
};

/// A change to other edges of the same lattice, with integers: edges H N, images N⁻¹ k.
struct LatticeChange {
  Eigen::Matrix3i edges = Eigen::Matrix3i::Identity();   ///< N, det N = 1
  Eigen::Matrix3i images = Eigen::Matrix3i::Identity();  ///< N⁻¹

  bool any() const { return edges != Eigen::Matrix3i::Identity(); }
};

/// Makes the edges of a cell that has been sheared far short again, and its rate with them: an edge whose
/// part along a shorter one is more than half of that is replaced by itself less a multiple of that
/// (Lagrange). Nothing where there is no such edge. A function of the edges alone.
LatticeChange reduce(PeriodicCell& cell);

}  // namespace eigengrain::model
