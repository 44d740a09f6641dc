#include "eigengrain/assembly/clump_tangent.hpp"

#include "eigengrain/assembly/clump_members.hpp"

namespace eigengrain::assembly {
namespace {

/// The part of T that belongs to one end; the identity for a body of one ball.
struct End {
  Mat6 t = Mat6::Identity();
  Mat3 moving_arm = Mat3::Zero();  ///< -Qᵀ[f]×[r]×Q
};

End end_of(const model::Bodies& bodies, const Trial& trial, std::int32_t row, const Vec3& force) {
  End end;
  const std::int32_t clump = bodies.clumps.of(row);
  if (clump == model::Clumps::none) return end;
  const Mat3 axes = bodies.clumps.orientation[static_cast<std::size_t>(clump)].toRotationMatrix();
  const Mat3 skew = cross_matrix(lever_of(bodies, row, trial.spin, trial.duration));
  end.t.topRightCorner<3, 3>() = -skew * axes;
  end.t.bottomRightCorner<3, 3>() = axes;
  end.moving_arm = -axes.transpose() * cross_matrix(force) * skew * axes;
  return end;
}

}  // namespace

ClumpTangent clump_tangent(const model::Bodies& bodies, const Trial& trial, std::int32_t a, std::int32_t b,
                           const Mat12& k, const Vec3& force) {
  ClumpTangent result{bodies.clumps.owner(a), b, Mat12::Zero()};
  const End first = end_of(bodies, trial, a, -force);
  result.k.topLeftCorner<6, 6>() = first.t.transpose() * k.topLeftCorner<6, 6>() * first.t;
  result.k.block<3, 3>(3, 3) += first.moving_arm;
  if (b == contact::no_body) return result;
  result.b = bodies.clumps.owner(b);
  const End second = end_of(bodies, trial, b, force);
  result.k.topRightCorner<6, 6>() = first.t.transpose() * k.topRightCorner<6, 6>() * second.t;
  result.k.bottomLeftCorner<6, 6>() = second.t.transpose() * k.bottomLeftCorner<6, 6>() * first.t;
  result.k.bottomRightCorner<6, 6>() = second.t.transpose() * k.bottomRightCorner<6, 6>() * second.t;
  result.k.block<3, 3>(9, 9) += second.moving_arm;
  return result;
}

}  // namespace eigengrain::assembly
