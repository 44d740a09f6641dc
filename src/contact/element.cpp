#include "eigengrain/contact/element.hpp"

namespace eigengrain::contact {

Eigen::Matrix<double, 6, 12> strain_displacement(const ContactElement& element) {
  Eigen::Matrix<double, 6, 12> b = Eigen::Matrix<double, 6, 12>::Zero();
  b.block<3, 3>(0, 0) = -Mat3::Identity();
  b.block<3, 3>(0, 3) = cross_matrix(element.lever_a);
  b.block<3, 3>(0, 6) = Mat3::Identity();
  b.block<3, 3>(0, 9) = -cross_matrix(element.lever_b);
  b.block<3, 3>(3, 3) = -Mat3::Identity();
  b.block<3, 3>(3, 9) = Mat3::Identity();
  return b;
}

Mat6 elasticity(const ContactElement& element) {
  Mat6 d = Mat6::Zero();
  d.topLeftCorner<3, 3>() = element.stiffness.translation(element.normal);
  d.bottomRightCorner<3, 3>() = element.stiffness.rotation(element.normal);
  return d;
}

ContactBlocks stiffness_blocks(const ContactElement& element) {
  const Mat3 d = element.stiffness.translation(element.normal);
  const Mat3 kappa = element.stiffness.rotation(element.normal);
  const Mat3 skew_a = cross_matrix(element.lever_a);
  const Mat3 skew_b = cross_matrix(element.lever_b);
  const Mat3 d_a = d * skew_a;
  const Mat3 d_b = d * skew_b;

  // Columns of B for the two ends: (-1, [R_a]x) and (1, -[R_b]x); [r]x is skew: its transpose is -[r]x.
  ContactBlocks k;
  k.aa << d, -d_a, -d_a.transpose(), kappa - skew_a * d_a;
  k.bb << d, -d_b, -d_b.transpose(), kappa - skew_b * d_b;
  k.ab << -d, d_b, d_a.transpose(), -kappa + skew_a * d_b;
  return k;
}

Mat12 stiffness_matrix(const ContactElement& element) {
  const ContactBlocks k = stiffness_blocks(element);
  Mat12 matrix;
  matrix << k.aa, k.ab, k.ab.transpose(), k.bb;
  return matrix;
}

}  // namespace eigengrain::contact
