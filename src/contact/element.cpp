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

// The columns of B are (-1, [R_a]×) and (1, -[R_b]×); [r]× is skew, so its transpose is -[r]×.

Mat6 end_block(const ContactElement& element, const Vec3& lever) {
  const Mat3 d = element.stiffness.translation(element.normal);
  const Mat3 skew = cross_matrix(lever);
  const Mat3 d_skew = d * skew;
  Mat6 block;
  block << d, -d_skew, -d_skew.transpose(), element.stiffness.rotation(element.normal) - skew * d_skew;
  return block;
}

Mat6 self_block(const ContactElement& element) {
  const Mat3 skew = cross_matrix(element.lever_a - element.lever_b);
  Mat6 block = Mat6::Zero();
  block.bottomRightCorner<3, 3>() = -skew * element.stiffness.translation(element.normal) * skew;
  return block;
}

ContactBlocks stiffness_blocks(const ContactElement& element) {
  const Mat3 d = element.stiffness.translation(element.normal);
  const Mat3 skew_a = cross_matrix(element.lever_a);
  const Mat3 d_b = d * cross_matrix(element.lever_b);
  ContactBlocks k{end_block(element, element.lever_a), {}, end_block(element, element.lever_b)};
  k.ab << -d, d_b, -skew_a * d, skew_a * d_b - element.stiffness.rotation(element.normal);
  return k;
}

Mat12 stiffness_matrix(const ContactElement& element) {
  const ContactBlocks k = stiffness_blocks(element);
  Mat12 matrix;
  matrix << k.aa, k.ab, k.ab.transpose(), k.bb;
  return matrix;
}

}  // namespace eigengrain::contact
