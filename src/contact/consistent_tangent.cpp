#include "eigengrain/contact/consistent_tangent.hpp"

namespace eigengrain::contact {
namespace {

using Mat3x12 = Eigen::Matrix<double, 3, 12>;

/// Columns of (u_a, θ_a, u_b, θ_b) in units of 3.
enum Column { u_a = 0, theta_a = 3, u_b = 6, theta_b = 9 };

/// Δ = u_b - u_a
Mat3x12 branch() {
  Mat3x12 result = Mat3x12::Zero();
  result.block<3, 3>(0, u_a) = -Mat3::Identity();
  result.block<3, 3>(0, u_b) = Mat3::Identity();
  return result;
}

/// ½(θ_a + θ_b)
Mat3x12 mean_rotation() {
  Mat3x12 result = Mat3x12::Zero();
  result.block<3, 3>(0, theta_a) = 0.5 * Mat3::Identity();
  result.block<3, 3>(0, theta_b) = 0.5 * Mat3::Identity();
  return result;
}

/// φ = θ_b - θ_a
Mat3x12 relative_rotation() {
  Mat3x12 result = Mat3x12::Zero();
  result.block<3, 3>(0, theta_a) = -Mat3::Identity();
  result.block<3, 3>(0, theta_b) = Mat3::Identity();
  return result;
}

}  // namespace

Mat12 consistent_tangent(const ContactGeometry& geometry, const Mat3& curvature, const ContactForce& force,
                         const ContactTangent& tangent) {
  const Vec3& n = geometry.normal;
  const Mat3 along = n * n.transpose();
  const Mat3x12 delta_branch = branch();

  Mat3x12 delta = delta_branch;  // δ of the contact point
  delta.block<3, 3>(0, theta_a) = cross_matrix(geometry.lever_a);
  delta.block<3, 3>(0, theta_b) = -cross_matrix(geometry.lever_b);
  const Mat3x12 frame = cross_matrix(n) * curvature * delta_branch + along * mean_rotation();  // Ω

  const Mat3x12 d_force = -tangent.translation * delta - cross_matrix(force.force) * frame;
  const Mat3x12 d_moment =
      -tangent.rotation * relative_rotation() - tangent.coupling * delta - cross_matrix(force.moment) * frame;
  const auto moving_lever = [&](const Vec3& lever, double cut) -> Mat3x12 {
    return (cut * along + lever.dot(n) * curvature) * delta_branch;
  };
  const auto d_end_moment = [&](const Vec3& lever, double cut) -> Mat3x12 {  // d(R × F + M)
    return cross_matrix(lever) * d_force - cross_matrix(force.force) * moving_lever(lever, cut) + d_moment;
  };

  Mat12 k;
  k.block<3, 12>(u_a, 0) = d_force;
  k.block<3, 12>(theta_a, 0) = d_end_moment(geometry.lever_a, geometry.cut);
  k.block<3, 12>(u_b, 0) = -d_force;
  k.block<3, 12>(theta_b, 0) = -d_end_moment(geometry.lever_b, -geometry.cut);
  return k;
}

}  // namespace eigengrain::contact
