#pragma once

#include "eigengrain/base/vec.hpp"

#include <span>

namespace eigengrain::measures {

/// What the union of some balls is like as a homogeneous body of density one. What two balls share counts
/// once.
struct BallUnion {
  double volume = 0;            ///< m³
  Vec3 centre = Vec3::Zero();   ///< of the volume, m
  Mat3 inertia = Mat3::Zero();  ///< ∫ (|s|² 1 - s sᵀ) dV about the centre, m⁵
  /// Of volume and inertia, relative: the change at the last doubling of the points of integration, and
  /// rounding.
  double error = 0;
};

/// Volume integrals by slices: area and moments of a slice, a union of discs, along the arcs of its boundary
/// (Green's theorem), exactly; across the slices by Gauss's rule between all places where the pattern of arcs
/// may change (ends of balls, ends of the circles in which two meet, points in which three meet). There the
/// integrand has roots of the distance, which x = m - h cos φ takes away, so that doubling the points doubles
/// the digits. Doubled until the result changes by less than 1e-13; `error` says what was reached.
///
/// Cost O(n² slices), and n³ for balls that all meet each other. Throws nothing; no ball gives zeros.
///
/// centres, radii  [n] m, radii positive
BallUnion ball_union(std::span<const Vec3> centres, std::span<const double> radii);

/// A tensor of inertia in its principal axes.
struct PrincipalAxes {
  Vec3 inertia = Vec3::Zero();          ///< increasing
  Quat orientation = Quat::Identity();  ///< from the principal axes to those of the tensor
};

/// Moments that differ by less than `same` of the largest are made equal, so that a body of revolution is one
/// to the bit; three equal ones keep the axes of the tensor.
PrincipalAxes principal_axes(const Mat3& inertia, double same = 1e-11);

}  // namespace eigengrain::measures
