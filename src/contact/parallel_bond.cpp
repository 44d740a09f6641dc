#include "eigengrain/contact/bonds/parallel_bond.hpp"

#include <cmath>

namespace eigengrain::contact {

/// The bond as it is now, in space.
struct ParallelBond::Deformation {
  Deformation(const ContactPose& pose, const State& bond)
      : branch(pose.lever_a - pose.lever_b),
        distance(branch.norm()),
        normal(branch / distance),
        stretch(distance - bond.length),
        arm_a(pose.orientation_a * bond.anchor_a),
        arm_b(pose.orientation_b * bond.anchor_b),
        arms(arm_b - arm_a),
        along(arms.dot(normal)),
        shear(arms - along * normal) {
    const Quat turned = pose.orientation_b * bond.relative.conjugate() * pose.orientation_a.conjugate();
    // q and -q are one rotation; the one of less than half a turn is meant.
    const double sign = turned.w() < 0 ? -1.0 : 1.0;
    turn = 2 * sign * turned.vec();
    cosine = sign * turned.w();
    twist = turn.dot(normal);
    bending = turn - twist * normal;
  }

  Vec3 branch;      ///< x_b - x_a, m
  double distance;  ///< d, m
  Vec3 normal;      ///< n
  double stretch;   ///< d - d_0, m
  Vec3 arm_a;       ///< p_a, m
  Vec3 arm_b;       ///< p_b, m
  Vec3 arms;        ///< p_b - p_a, m
  double along;     ///< its part along n, m
  Vec3 shear;       ///< s, m
  Vec3 turn;        ///< ψ
  double cosine;    ///< w
  double twist;     ///< ψ·n
  Vec3 bending;     ///< ψ_⊥
};

/// What the bond carries.
struct ParallelBond::Load {
  Load(const Deformation& now, const ContactStiffness& k)
      : excess(k.twist - k.bending),
        moments(k.bending * now.turn + excess * now.twist * now.normal),
        turning(k.shear * now.along * now.shear - excess * now.twist * now.bending),
        force(-k.normal * now.stretch * now.normal + turning / now.distance),
        torque(now.cosine * moments + 0.5 * now.turn.cross(moments)),
        moment_b(-k.shear * now.arm_b.cross(now.shear) - torque) {}

  double excess;  ///< κ_n - κ_s, N m
  Vec3 moments;   ///< G, N m
  Vec3 turning;   ///< minus the gradient of the energy by n, N m
  Vec3 force;     ///< F, N
  Vec3 torque;    ///< T, N m
  Vec3 moment_b;  ///< on b about its centre, N m
};

ParallelBond::State ParallelBond::bond(const BondSite& site) const {
  const Quat to_a = site.orientation_a.conjugate();
  return {.radius = cement_.disk_radius(site),
          .length = (site.geometry.lever_a - site.geometry.lever_b).norm(),
          .anchor_a = to_a * site.geometry.lever_a,
          .anchor_b = site.orientation_b.conjugate() * site.geometry.lever_b,
          .relative = to_a * site.orientation_b};
}

std::optional<BreakMode> ParallelBond::failure(const Deformation& now, const Load& load,
                                               const DiskSection& disk) const {
  const double pressure = load.force.dot(now.normal);
  const double twist = load.torque.dot(now.normal);
  return cement_.failure(disk, {.normal = pressure,
                                .shear = (load.force - pressure * now.normal).norm(),
                                .twist = std::abs(twist),
                                .bending = (load.torque - twist * now.normal).norm()});
}

std::optional<BreakMode> ParallelBond::failure(const ContactPose& pose, const State& old) const {
  if (!old.bonded()) return std::nullopt;
  const DiskSection disk(old.radius);
  const Deformation now(pose, old);
  return failure(now, Load(now, cement_.stiffness(disk)), disk);
}

ContactForce ParallelBond::evaluate(const ContactPose& pose, const State& old, State& next) const {
  next = State{};
  if (!old.bonded()) return {};
  const DiskSection disk(old.radius);
  const Deformation now(pose, old);
  const Load load(now, cement_.stiffness(disk));
  if (failure(now, load, disk)) return {};
  next = old;
  return {.force = load.force, .moment = load.moment_b - pose.lever_b.cross(load.force)};
}

double ParallelBond::energy(const ContactPose& pose, const State& old) const {
  if (!old.bonded()) return 0.0;
  const DiskSection disk(old.radius);
  const ContactStiffness k = cement_.stiffness(disk);
  const Deformation now(pose, old);
  if (failure(now, Load(now, k), disk)) return 0.0;
  return 0.5 * (k.normal * now.stretch * now.stretch + k.shear * now.shear.squaredNorm() +
                k.twist * now.twist * now.twist + k.bending * now.bending.squaredNorm());
}

namespace {

using Mat3x12 = Eigen::Matrix<double, 3, 12>;
using Row12 = Eigen::Matrix<double, 1, 12>;

/// Columns of (u_a, θ_a, u_b, θ_b).
enum Column { u_a = 0, theta_a = 3, u_b = 6, theta_b = 9 };

Mat3x12 at(Column column, const Mat3& block) {
  Mat3x12 result = Mat3x12::Zero();
  result.block<3, 3>(0, column) = block;
  return result;
}

/// Derivative of a vector that turns with a body: θ × v.
Mat3x12 turning_with(Column theta, const Vec3& v) {
  return at(theta, -cross_matrix(v));
}

/// Derivative of v × w.
Mat3x12 cross(const Vec3& v, const Mat3x12& dv, const Vec3& w, const Mat3x12& dw) {
  return cross_matrix(v) * dw - cross_matrix(w) * dv;
}

/// Derivatives of the parts of a vector along n and across it.
struct Parts {
  Parts(const Vec3& v, const Mat3x12& dv, const Vec3& n, const Mat3x12& dn)
      : along(n.transpose() * dv + v.transpose() * dn), across(dv - n * along - v.dot(n) * dn) {}
  Row12 along;
  Mat3x12 across;
};

}  // namespace

// The derivative of `evaluate`, term by term.
Mat12 ParallelBond::tangent(const ContactPose& pose, const State& old) const {
  if (!old.bonded()) return Mat12::Zero();
  const DiskSection disk(old.radius);
  const ContactStiffness k = cement_.stiffness(disk);
  const Deformation now(pose, old);
  const Load load(now, k);
  if (failure(now, load, disk)) return Mat12::Zero();

  const Vec3& n = now.normal;
  const Mat3x12 d_branch = at(u_b, Mat3::Identity()) - at(u_a, Mat3::Identity());
  const Row12 d_distance = n.transpose() * d_branch;
  const Mat3x12 d_normal = (d_branch - n * d_distance) / now.distance;
  const Mat3x12 d_arm_b = turning_with(theta_b, now.arm_b);
  const Parts d_arms(now.arms, d_arm_b - turning_with(theta_a, now.arm_a), n, d_normal);
  // dq = ½ (0, θ_b) q - ½ q (0, θ_a)
  const Mat3 half_skew = 0.5 * cross_matrix(now.turn);
  const Mat3 straight = now.cosine * Mat3::Identity();
  const Mat3x12 d_turn = at(theta_b, straight - half_skew) + at(theta_a, -straight - half_skew);
  const Parts d_parts(now.turn, d_turn, n, d_normal);
  Row12 d_cosine = Row12::Zero();
  d_cosine.segment<3>(theta_a) = 0.25 * now.turn.transpose();
  d_cosine.segment<3>(theta_b) = -0.25 * now.turn.transpose();

  const Mat3x12 d_turning = k.shear * (now.shear * d_arms.along + now.along * d_arms.across) -
                            load.excess * (now.bending * d_parts.along + now.twist * d_parts.across);
  const Mat3x12 d_force = -k.normal * (n * d_distance + now.stretch * d_normal) +
                          (d_turning - load.turning * d_distance / now.distance) / now.distance;
  const Mat3x12 d_moments = k.bending * d_turn + load.excess * (n * d_parts.along + now.twist * d_normal);
  const Mat3x12 d_torque = load.moments * d_cosine + now.cosine * d_moments +
                           0.5 * cross(now.turn, d_turn, load.moments, d_moments);
  const Mat3x12 d_moment_b = -k.shear * cross(now.arm_b, d_arm_b, now.shear, d_arms.across) - d_torque;
  // The moments about any point balance: M_a = -(x_b - x_a) × F - M_b.
  const Mat3x12 d_moment_a = -cross(now.branch, d_branch, load.force, d_force) - d_moment_b;

  Mat12 matrix;
  matrix << d_force, -d_moment_a, -d_force, -d_moment_b;
  return matrix;
}

}  // namespace eigengrain::contact
