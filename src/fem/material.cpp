#include "eigengrain/fem/material.hpp"

#include <cmath>
#include <limits>

namespace eigengrain::fem {
namespace {

using model::ElasticModel;
using model::ElasticSolid;

Mat3 not_a_number() {
  return Mat3::Constant(std::numeric_limits<double>::quiet_NaN());
}

/// det F · F⁻ᵀ: columns are cross products of the columns of F.
Mat3 cofactors(const Mat3& F) {
  Mat3 result;
  result.col(0) = F.col(1).cross(F.col(2));
  result.col(1) = F.col(2).cross(F.col(0));
  result.col(2) = F.col(0).cross(F.col(1));
  return result;
}

Mat3 symmetric(const Mat3& m) {
  return 0.5 * (m + m.transpose());
}

/// Stress of a strain by Hooke's law.
Mat3 hooke(const ElasticSolid& solid, const Mat3& strain) {
  return 2 * solid.shear() * strain + solid.lame() * strain.trace() * Mat3::Identity();
}

/// The change of R with F, dR = R W. From F = R S: RᵀdF - dFᵀR = W S + S W, which for W = [ω]× is
/// [(tr S - S) ω]×.
struct RotationRate {
  Mat3 R;
  Mat3 inverse;  ///< (tr S - S)⁻¹

  RotationRate(const Mat3& rotation, const Mat3& S)
      : R(rotation), inverse((S.trace() * Mat3::Identity() - S).inverse()) {}
  Mat3 operator()(const Mat3& dF) const {
    const Mat3 A = R.transpose() * dF;
    const Vec3 axial(A(2, 1) - A(1, 2), A(0, 2) - A(2, 0), A(1, 0) - A(0, 1));
    return R * cross_matrix(inverse * axial);
  }
};

/// Columns of a derivative by F, one direction after the other.
template <class Derivative>
Mat9 by_columns(const Derivative& derivative) {
  Mat9 result;
  for (int k = 0; k < 9; ++k) {
    Mat3 dF = Mat3::Zero();
    dF.data()[k] = 1;
    const Mat3 dP = derivative(dF);
    result.col(k) = Eigen::Map<const Eigen::Matrix<double, 9, 1>>(dP.data());
  }
  return result;
}

}  // namespace

Mat3 polar_rotation(const Mat3& F) {
  if (!(F.determinant() > 0)) return not_a_number();
  Mat3 R = F;
  // It converges quadratically: a step this small leaves nothing that doubles could hold.
  constexpr double last_step = 1e-9;
  for (int iteration = 0; iteration < 60; ++iteration) {
    const Mat3 cofactor = cofactors(R);
    const double determinant = R.col(0).dot(cofactor.col(0));
    const double scale = std::sqrt(cofactor.norm() / (determinant * R.norm()));
    const Mat3 next = 0.5 * (scale * R + cofactor / (scale * determinant));
    const double step = (next - R).squaredNorm();
    R = next;
    if (step < last_step * last_step) break;
  }
  return R;
}

Mat3 stress(const ElasticSolid& solid, const Mat3& F) {
  switch (solid.model) {
    case ElasticModel::linear:
      return hooke(solid, symmetric(F) - Mat3::Identity());
    case ElasticModel::corotational: {
      const Mat3 R = polar_rotation(F);
      return R * hooke(solid, symmetric(R.transpose() * F) - Mat3::Identity());
    }
    case ElasticModel::saint_venant_kirchhoff:
      return F * hooke(solid, 0.5 * (F.transpose() * F - Mat3::Identity()));
    case ElasticModel::neo_hookean:
      break;
  }
  const double J = F.determinant();
  if (!(J > 0)) return not_a_number();
  return solid.shear() * F + (solid.lame() * std::log(J) - solid.shear()) / J * cofactors(F);
}

double energy_density(const ElasticSolid& solid, const Mat3& F) {
  const auto of_strain = [&](const Mat3& strain) {
    const double trace = strain.trace();
    return solid.shear() * strain.squaredNorm() + 0.5 * solid.lame() * trace * trace;
  };
  switch (solid.model) {
    case ElasticModel::linear:
      return of_strain(symmetric(F) - Mat3::Identity());
    case ElasticModel::corotational:
      return of_strain(symmetric(polar_rotation(F).transpose() * F) - Mat3::Identity());
    case ElasticModel::saint_venant_kirchhoff:
      return of_strain(0.5 * (F.transpose() * F - Mat3::Identity()));
    case ElasticModel::neo_hookean:
      break;
  }
  const double log_J = std::log(F.determinant());
  return 0.5 * solid.shear() * (F.squaredNorm() - 3) - solid.shear() * log_J +
         0.5 * solid.lame() * log_J * log_J;
}

Mat9 elasticity(const ElasticSolid& solid, const Mat3& F) {
  const double lame = solid.lame();
  const double shear = solid.shear();
  switch (solid.model) {
    case ElasticModel::linear:
      return by_columns([&](const Mat3& dF) { return hooke(solid, symmetric(dF)); });
    case ElasticModel::corotational: {
      const Mat3 R = polar_rotation(F);
      const Mat3 S = symmetric(R.transpose() * F);
      const RotationRate rate(R, S);
      // P = 2µ (F - R) + λ tr(S - 1) R, and d tr S = R:dF.
      const double pull = lame * (S.trace() - 3) - 2 * shear;
      return by_columns([&](const Mat3& dF) -> Mat3 {
        return 2 * shear * dF + pull * rate(dF) + lame * R.cwiseProduct(dF).sum() * R;
      });
    }
    case ElasticModel::saint_venant_kirchhoff: {
      const Mat3 second = hooke(solid, 0.5 * (F.transpose() * F - Mat3::Identity()));
      return by_columns([&](const Mat3& dF) -> Mat3 {
        return dF * second + F * hooke(solid, symmetric(F.transpose() * dF));
      });
    }
    case ElasticModel::neo_hookean:
      break;
  }
  const Mat3 inverse = F.inverse();
  const double pressure = lame * std::log(F.determinant()) - shear;
  return by_columns([&](const Mat3& dF) -> Mat3 {
    const Mat3 X = inverse * dF;
    return shear * dF + (lame * X.trace() * inverse - pressure * X * inverse).transpose();
  });
}

Mat3 cauchy_stress(const ElasticSolid& solid, const Mat3& F) {
  const Mat3 P = stress(solid, F);
  if (solid.model == ElasticModel::linear) return P;
  return P * F.transpose() / F.determinant();
}

}  // namespace eigengrain::fem
