#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>

/// Small vectors and matrices. Everything that has a fixed, small size is an Eigen type.
namespace eigengrain {

using Vec3 = Eigen::Vector3d;
/// Of doubles, or of packs of them (base/pack.hpp).
template <class Real>
using Vec3Of = Eigen::Matrix<Real, 3, 1>;
using Mat3 = Eigen::Matrix3d;
using Vec6 = Eigen::Matrix<double, 6, 1>;
using Mat6 = Eigen::Matrix<double, 6, 6>;
/// A rotation as a unit quaternion. Without Eigen's alignment: four doubles among others.
using Quat = Eigen::Quaternion<double, Eigen::DontAlign>;
using Mat12 = Eigen::Matrix<double, 12, 12>;

/// The matrix [r]× of the cross product: [r]× v = r × v.
inline Mat3 cross_matrix(const Vec3& r) {
  Mat3 m;
  m << 0, -r.z(), r.y(), r.z(), 0, -r.x(), -r.y(), r.x(), 0;
  return m;
}

}  // namespace eigengrain
