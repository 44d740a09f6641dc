// Stress, energy and stiffness of a point of an elastic solid.
#include "eigengrain/fem/material.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

namespace eigengrain::test {
namespace {

using fem::Mat9;
using model::ElasticModel;
using model::ElasticSolid;

constexpr ElasticModel all_models[] = {ElasticModel::linear, ElasticModel::corotational,
                                       ElasticModel::saint_venant_kirchhoff, ElasticModel::neo_hookean};

ElasticSolid solid_of(ElasticModel model) {
  return {model, 3e6, 0.3};
}

/// Deformations of up to 30% with any rotation.
class Deformations {
 public:
  Mat3 rotation() {
    return Eigen::Quaterniond(normal_(random_), normal_(random_), normal_(random_), normal_(random_))
        .normalized()
        .toRotationMatrix();
  }
  Mat3 stretch() {
    Mat3 S = Mat3::Identity();
    for (int i = 0; i < 3; ++i)
      for (int j = i; j < 3; ++j) S(i, j) = S(j, i) = (i == j ? 1 : 0) + 0.1 * uniform_(random_);
    return S;
  }
  Mat3 any() { return rotation() * stretch(); }

 private:
  std::mt19937 random_{4711};
  std::normal_distribution<double> normal_;
  std::uniform_real_distribution<double> uniform_{-1, 1};
};

TEST(ElasticSolids, PolarRotationTakesFApartToRounding) {
  Deformations random;
  for (int k = 0; k < 200; ++k) {
    const Mat3 R = random.rotation();
    const Mat3 S = random.stretch();
    EXPECT_LE((fem::polar_rotation(R * S) - R).norm(), 1e-14);
  }
  // Far from any rotation, and flat to a thousandth.
  const Mat3 S = Vec3(1e3, 1, 1e-3).asDiagonal();
  const Mat3 R = random.rotation();
  EXPECT_LE((fem::polar_rotation(R * S) - R).norm(), 1e-12);  // condition 10⁶ of what det F loses
  EXPECT_TRUE(fem::polar_rotation(Vec3(1, 1, -1).asDiagonal()).hasNaN());
}

// Central differences of step h err by h² W''' + ε W/h: 1e-10 of the modulus at h = 1e-5.
TEST(ElasticSolids, StressIsTheDerivativeOfEnergyAndElasticityThatOfStress) {
  Deformations random;
  constexpr double h = 1e-5;
  for (const ElasticModel model : all_models) {
    const ElasticSolid solid = solid_of(model);
    for (int trial = 0; trial < 20; ++trial) {
      const Mat3 F = random.any();
      const Mat3 P = fem::stress(solid, F);
      const Mat9 A = fem::elasticity(solid, F);
      EXPECT_LE((A - A.transpose()).norm(), 1e-13 * A.norm());
      for (int k = 0; k < 9; ++k) {
        Mat3 dF = Mat3::Zero();
        dF.data()[k] = h;
        const double dW = fem::energy_density(solid, F + dF) - fem::energy_density(solid, F - dF);
        EXPECT_NEAR(P.data()[k], dW / (2 * h), 1e-8 * solid.young) << name_of(model);
        const Mat3 dP = (fem::stress(solid, F + dF) - fem::stress(solid, F - dF)) / (2 * h);
        const Mat3 of_A = Eigen::Map<const Mat3>(A.col(k).data());
        EXPECT_LE((of_A - dP).norm(), 1e-8 * solid.young) << name_of(model);
      }
    }
  }
}

TEST(ElasticSolids, AllButTheLinearOneAreObjective) {
  Deformations random;
  for (const ElasticModel model : all_models) {
    const ElasticSolid solid = solid_of(model);
    const Mat3 F = random.any();
    const Mat3 Q = random.rotation();
    const double off = (fem::stress(solid, Q * F) - Q * fem::stress(solid, F)).norm();
    if (model == ElasticModel::linear)
      EXPECT_GT(off, 0.1 * solid.young);
    else
      EXPECT_LE(off, 1e-13 * solid.young) << name_of(model);
  }
}

TEST(ElasticSolids, SmallStrainsAreHookes) {
  for (const ElasticModel model : all_models) {
    const ElasticSolid solid = solid_of(model);
    const Mat9 A = fem::elasticity(solid, Mat3::Identity());
    EXPECT_NEAR(A(0, 0), solid.lame() + 2 * solid.shear(), 1e-12 * solid.young) << name_of(model);
    EXPECT_NEAR(A(0, 4), solid.lame(), 1e-12 * solid.young) << name_of(model);
    EXPECT_NEAR(A(1, 1), solid.shear(), 1e-12 * solid.young) << name_of(model);
    EXPECT_NEAR(A(1, 3), solid.shear(), 1e-12 * solid.young) << name_of(model);
    // In uniaxial stress: E and ν.
    constexpr double strain = 1e-7;
    const Vec3 stretched(-solid.poisson * strain, -solid.poisson * strain, strain);
    const Mat3 P = fem::stress(solid, Mat3(Vec3(Vec3::Ones() + stretched).asDiagonal()));
    EXPECT_NEAR(P(2, 2), solid.young * strain, 3e-7 * solid.young * strain);  // one part is of the next order
    EXPECT_NEAR(P(0, 0), 0, 3e-7 * solid.young * strain);
  }
}

TEST(ElasticSolids, InsideOutHasNoStressWhereItHasNoMeaning) {
  const Mat3 F = Vec3(1, 1, -0.5).asDiagonal();
  EXPECT_TRUE(fem::stress(solid_of(ElasticModel::corotational), F).hasNaN());
  EXPECT_TRUE(fem::stress(solid_of(ElasticModel::neo_hookean), F).hasNaN());
}

TEST(ElasticSolids, CauchyStressIsSymmetric) {
  Deformations random;
  for (const ElasticModel model : all_models) {
    const ElasticSolid solid = solid_of(model);
    const Mat3 sigma = fem::cauchy_stress(solid, random.any());
    EXPECT_LE((sigma - sigma.transpose()).norm(), 1e-13 * solid.young) << name_of(model);
  }
}

}  // namespace
}  // namespace eigengrain::test
