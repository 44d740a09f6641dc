// Elastic moduli against closed forms of lattices, dense algebra from positions alone, and mean field.
#include "eigengrain/spectrum/moduli.hpp"

#include "eigengrain/base/error.hpp"

#include "spectrum/packings.hpp"
#include "support/lattices.hpp"

#include <Eigen/Dense>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

namespace eigengrain::test {
namespace {

using spectrum::elastic_moduli;
using spectrum::Moduli;

Mat6 cubic(double c11, double c12, double c44) {
  Mat6 c = Mat6::Zero();
  c.topLeftCorner<3, 3>().setConstant(c12);
  for (int k = 0; k < 3; ++k) {
    c(k, k) = c11;
    c(3 + k, 3 + k) = c44;
  }
  return c;
}

/// Largest difference over the largest entry.
double difference(const Mat6& a, const Mat6& b) {
  return (a - b).cwiseAbs().maxCoeff() / b.cwiseAbs().maxCoeff();
}

// Diameter d = 2: C11 = √2(k_n + k_s)/d, C12 = √2(k_n - k_s)/2d, C44 = √2(k_n + k_s)/2d; bulk 2√2 k_n/3d.
TEST(Moduli, OfFccAreItsClosedForms) {
  for (const double ks : {0.0, 0.5, 1.0}) {
    const Moduli found = elastic_moduli(make_lattice(face_centred(), {.kn = 1, .ks = ks}, {2, 2, 2}).build());
    const double root = std::numbers::sqrt2;
    const Mat6 expected = cubic(root * (1 + ks) / 2, root * (1 - ks) / 4, root * (1 + ks) / 4);
    EXPECT_LT(difference(found.stiffness, expected), 1e-11) << ks;
    EXPECT_NEAR(found.bulk(), root / 3, 1e-11) << ks;
    EXPECT_EQ(found.contacts, 6 * 32);
  }
}

// SC of edge d: contacts along the axes only. C11 = k_n/d, C12 = 0. A shear of the cell by γ_yz slides
// contacts along y and z by γ/2 each; balls may turn, which the contacts resist in the sum over y and z
// alike, so that C44 = k_s/2d.
TEST(Moduli, OfScAreItsClosedForms) {
  const Moduli found = elastic_moduli(make_lattice(simple_cubic(), {.kn = 1, .ks = 0.4}, {3, 3, 3}).build());
  EXPECT_LT(difference(found.stiffness, cubic(0.5, 0, 0.4 / 4)), 1e-11);
}

// BCC: four contacts a ball along diagonals in a volume of 4 d³/(3√3): without shear C11 = C12 = C44 =
// k_n/(√3 d). Balls are centres of symmetry, so nothing moves beside the strain.
TEST(Moduli, OfBccWithoutShearAreCauchy) {
  const Moduli found = elastic_moduli(make_lattice(body_centred(), {.kn = 1}, {2, 2, 2}).build());
  const double c = 1 / (std::sqrt(3.0) * 2);
  EXPECT_LT(difference(found.stiffness, cubic(c, c, c)), 1e-11);
  EXPECT_LT(difference(found.affine, found.stiffness), 1e-11);
}

// Diamond is no lattice of centres of symmetry: its two sublattices move against each other, so that C44
// falls.
TEST(Moduli, OfDiamondRelaxInside) {
  const Moduli found = elastic_moduli(make_lattice(diamond(), {.kn = 1}, {1, 1, 1}).build());
  EXPECT_LT(found.stiffness(3, 3), 0.01 * found.affine(3, 3));  // without shear nothing holds the angles
  EXPECT_NEAR(found.bulk(), (found.affine.topLeftCorner<3, 3>().sum() / 9), 1e-11 * found.bulk());
}

/// From positions alone: energy ½ q·K q of an affine strain and of what bodies move by beside it, minimised
/// by a dense pseudo-inverse.
Mat6 dense_moduli(const System& system) {
  const model::Bodies& bodies = system.model.bodies;
  const model::PeriodicCell& cell = system.model.cell;
  const Eigen::Index n = bodies.size();
  Eigen::MatrixXd k = Eigen::MatrixXd::Zero(6 * n, 6 * n);
  Eigen::MatrixXd f = Eigen::MatrixXd::Zero(6 * n, 6);
  Mat6 affine = Mat6::Zero();
  for (Eigen::Index a = 0; a < n; ++a)
    for (Eigen::Index b = a; b < n; ++b)
      for (int image = 0; image < 27; ++image) {
        const std::array<int, 3> which{image % 3 - 1, image / 3 % 3 - 1, image / 9 - 1};
        if (a == b && image <= 13) continue;  // each image of a ball with itself once
        const Vec3 branch = bodies.position[b] + cell.shift(which) - bodies.position[a];
        const double overlap = bodies.radius[a] + bodies.radius[b] - branch.norm();
        if (overlap <= 0) continue;
        const Vec3 normal = branch.normalized();
        const Mat3 d =
            1e5 * normal * normal.transpose() + 5e4 * (Mat3::Identity() - normal * normal.transpose());
        Eigen::MatrixXd strain = Eigen::MatrixXd::Zero(3, 6 * n);
        strain.middleCols<3>(6 * a) -= Mat3::Identity();
        strain.middleCols<3>(6 * b) += Mat3::Identity();
        strain.middleCols<3>(6 * a + 3) += cross_matrix((bodies.radius[a] - overlap / 2) * normal);
        strain.middleCols<3>(6 * b + 3) += cross_matrix((bodies.radius[b] - overlap / 2) * normal);
        Eigen::Matrix<double, 3, 6> followed;
        followed << branch.x(), 0, 0, 0, branch.z() / 2, branch.y() / 2,  //
            0, branch.y(), 0, branch.z() / 2, 0, branch.x() / 2,          //
            0, 0, branch.z(), branch.y() / 2, branch.x() / 2, 0;
        k += strain.transpose() * d * strain;
        f += strain.transpose() * d * followed;
        affine += followed.transpose() * d * followed;
      }
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> eigen(k);
  Mat6 relaxed = Mat6::Zero();
  for (Eigen::Index j = 0; j < 6 * n; ++j) {
    if (eigen.eigenvalues()[j] < 1e-11 * eigen.eigenvalues().maxCoeff()) continue;
    const Eigen::RowVectorXd part = eigen.eigenvectors().col(j).transpose() * f;
    relaxed += part.transpose() * part / eigen.eigenvalues()[j];
  }
  return (affine - relaxed) / cell.volume();
}

TEST(Moduli, OfAPackingAreThoseOfDenseAlgebra) {
  const System system = pressed_packing("36 mm");
  const Moduli found = elastic_moduli(system.model);
  EXPECT_LT(difference(found.stiffness, dense_moduli(system)), 1e-10);
  for (const double residual : found.residual) EXPECT_LT(residual, 1e-11);
  // Relaxation only softens.
  const Eigen::SelfAdjointEigenSolver<Mat6> softening(found.affine - found.stiffness);
  EXPECT_GT(softening.eigenvalues().minCoeff(), -1e-12 * found.bulk());
}

// Mean field of an isotropic packing: bulk φ z k_n/(6πR), shear φ z (2k_n + 3k_s)/(20πR), for equal spheres.
TEST(Moduli, OfBodiesThatFollowAreMeanField) {
  const System system(make_lattice(face_centred(), {.kn = 1, .ks = 0.3}, {2, 2, 2}));
  const Moduli found = elastic_moduli(system.model);
  const double solid = std::numbers::pi / (3 * std::numbers::sqrt2);
  const double bulk = found.affine.topLeftCorner<3, 3>().sum() / 9;
  EXPECT_NEAR(bulk, solid * 12 / (6 * std::numbers::pi), 1e-11);
  Moduli affine = found;
  affine.stiffness = found.affine;
  EXPECT_NEAR(affine.shear(), solid * 12 * (2 + 3 * 0.3) / (20 * std::numbers::pi), 1e-11);
}

TEST(Moduli, RefuseWhatHasNone) {
  SceneBuilder open({.kn = 1});
  open.ball({0, 0, 0}).ball({1.99, 0, 0});
  EXPECT_THROW(elastic_moduli(open.build()), InputError);
  EXPECT_THROW(elastic_moduli(make_lattice(simple_cubic(), {.kn = 1}, {2, 2, 2}, fix_rotations).build()),
               InputError);
}

}  // namespace
}  // namespace eigengrain::test
