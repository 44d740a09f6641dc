// Elements of one kind each: shape functions, patch test, derivatives, masses.
#include "eigengrain/fem/elements.hpp"

#include "eigengrain/fem/material.hpp"

#include <Eigen/Eigenvalues>
#include <gtest/gtest.h>

#include <cmath>
#include <numeric>
#include <random>

namespace eigengrain::test {
namespace {

using fem::Elements;
using model::ElasticModel;
using model::ElasticSolid;
using model::ElementKind;
using model::Mesh;

constexpr ElementKind all_kinds[] = {ElementKind::tet4, ElementKind::hex8, ElementKind::tet10};

/// A block with its inner nodes moved about.
Mesh distorted_block(ElementKind kind) {
  const Vec3 size(2, 1, 1.5);
  Mesh mesh = model::box_mesh({-1, 0.5, 0}, size, {3, 2, 2}, kind);
  std::mt19937 random(7);
  std::uniform_real_distribution<double> uniform(-1, 1);
  // Quadratic elements stay straight, as their patch test asks for: their middles are set again.
  std::vector<Vec3> by(mesh.nodes.size());
  for (Vec3& u : by) u = 0.06 * Vec3(uniform(random), uniform(random), uniform(random));
  const auto inside = [&](const Vec3& x) {
    const Vec3 from(-1, 0.5, 0);
    return ((x - from).array() > 1e-9).all() && ((from + size - x).array() > 1e-9).all();
  };
  if (kind != ElementKind::tet10) {
    for (std::size_t i = 0; i < by.size(); ++i)
      if (inside(mesh.nodes[i])) mesh.nodes[i] += by[i];
    return mesh;
  }
  std::vector<char> corner(mesh.nodes.size(), 0);
  for (std::int32_t e = 0; e < mesh.element_count(); ++e)
    for (const std::int32_t node : mesh.element(e).first(4)) corner[static_cast<std::size_t>(node)] = 1;
  for (std::size_t i = 0; i < by.size(); ++i)
    if (corner[i] != 0 && inside(mesh.nodes[i])) mesh.nodes[i] += by[i];
  static constexpr int edges[6][2] = {{0, 1}, {1, 2}, {2, 0}, {0, 3}, {1, 3}, {2, 3}};
  for (std::int32_t e = 0; e < mesh.element_count(); ++e) {
    const auto nodes = mesh.element(e);
    for (std::size_t k = 0; k < 6; ++k)
      mesh.nodes[static_cast<std::size_t>(nodes[4 + k])] =
          0.5 * (mesh.nodes[static_cast<std::size_t>(nodes[static_cast<std::size_t>(edges[k][0])])] +
                 mesh.nodes[static_cast<std::size_t>(nodes[static_cast<std::size_t>(edges[k][1])])]);
  }
  return mesh;
}

std::vector<Vec3> places(const Mesh& mesh, std::int32_t e) {
  std::vector<Vec3> x;
  for (const std::int32_t node : mesh.element(e)) x.push_back(mesh.nodes[static_cast<std::size_t>(node)]);
  return x;
}

TEST(Elements, TheirVolumesAddUpToTheBlock) {
  for (const ElementKind kind : all_kinds) {
    const Mesh mesh = distorted_block(kind);
    const Elements elements(mesh);
    double volume = 0;
    for (std::int32_t e = 0; e < elements.size(); ++e)
      for (int q = 0; q < elements.points(); ++q) volume += elements.weight(e, q);
    EXPECT_NEAR(volume, 3.0, 1e-13) << name_of(kind);
  }
}

// The patch test: every affine motion is the same F at all points, and its forces on inner nodes cancel.
TEST(Elements, PassThePatchTestToRounding) {
  Mat3 F;
  F << 1.02, 0.03, -0.01, 0.005, 0.97, 0.02, -0.04, 0.01, 1.01;
  for (const ElementKind kind : all_kinds)
    for (const ElasticModel law : {ElasticModel::linear, ElasticModel::corotational,
                                   ElasticModel::saint_venant_kirchhoff, ElasticModel::neo_hookean}) {
      const ElasticSolid solid{law, 2e5, 0.35};
      const Mesh mesh = distorted_block(kind);
      const Elements elements(mesh);
      std::vector<Vec3> sum(mesh.nodes.size(), Vec3::Zero());
      std::vector<char> boundary(mesh.nodes.size(), 0);
      std::vector<Vec3> force(static_cast<std::size_t>(elements.nodes()));
      const Mat3 P = fem::stress(solid, F);
      for (std::int32_t e = 0; e < elements.size(); ++e) {
        std::vector<Vec3> x = places(mesh, e);
        for (Vec3& node : x) node = (F * node + Vec3(0.1, 0.2, 0.3)).eval();
        for (int q = 0; q < elements.points(); ++q)
          EXPECT_LE((elements.deformation(e, q, x) - F).norm(), 1e-13);
        elements.forces(solid, e, x, force);
        for (std::size_t i = 0; i < force.size(); ++i)
          sum[static_cast<std::size_t>(mesh.element(e)[i])] += force[i];
      }
      std::vector<std::int32_t> on_skin;
      model::skin_of(mesh, on_skin);
      for (const std::int32_t node : on_skin) boundary[static_cast<std::size_t>(node)] = 1;
      int inner = 0;
      for (std::size_t i = 0; i < sum.size(); ++i) {
        if (boundary[i] != 0) continue;
        ++inner;
        EXPECT_LE(sum[i].norm(), 1e-13 * P.norm()) << name_of(kind) << ' ' << name_of(law);
      }
      EXPECT_GT(inner, 0);
    }
}

TEST(Elements, StiffnessIsMinusTheDerivativeOfForces) {
  std::mt19937 random(3);
  std::uniform_real_distribution<double> uniform(-0.05, 0.05);
  constexpr double h = 1e-6;
  for (const ElementKind kind : all_kinds)
    for (const ElasticModel law : {ElasticModel::linear, ElasticModel::corotational,
                                   ElasticModel::saint_venant_kirchhoff, ElasticModel::neo_hookean}) {
      const ElasticSolid solid{law, 2e5, 0.35};
      const Mesh mesh = distorted_block(kind);
      const Elements elements(mesh);
      const Mat3 turn = Eigen::AngleAxisd(0.8, Vec3(1, 2, -1).normalized()).toRotationMatrix();
      std::vector<Vec3> x = places(mesh, 5);
      for (Vec3& node : x)
        node = (turn * (node + Vec3(uniform(random), uniform(random), uniform(random)))).eval();
      const Eigen::MatrixXd K = elements.stiffness(solid, 5, x);
      std::vector<Vec3> more(x.size());
      std::vector<Vec3> less(x.size());
      const auto n = static_cast<int>(x.size());
      Eigen::VectorXd column(3 * n);
      for (int j = 0; j < 3 * n; ++j) {
        std::vector<Vec3> y = x;
        y[static_cast<std::size_t>(j / 3)][j % 3] += h;
        elements.forces(solid, 5, y, more);
        y[static_cast<std::size_t>(j / 3)][j % 3] -= 2 * h;
        elements.forces(solid, 5, y, less);
        for (int i = 0; i < n; ++i)
          column.segment<3>(3 * i) =
              (less[static_cast<std::size_t>(i)] - more[static_cast<std::size_t>(i)]) / (2 * h);
        EXPECT_LE((K.col(j) - column).norm(), 1e-8 * K.norm()) << name_of(kind) << ' ' << name_of(law);
      }
      // And of the energy the force is minus the derivative.
      elements.forces(solid, 5, x, more);
      for (int j = 0; j < 3 * n; ++j) {
        std::vector<Vec3> y = x;
        y[static_cast<std::size_t>(j / 3)][j % 3] += h;
        const double up = elements.energy(solid, 5, y);
        y[static_cast<std::size_t>(j / 3)][j % 3] -= 2 * h;
        const double down = elements.energy(solid, 5, y);
        EXPECT_NEAR(more[static_cast<std::size_t>(j / 3)][j % 3], (down - up) / (2 * h), 1e-8 * K.norm());
      }
    }
}

TEST(Elements, HaveSixRigidMotionsAndNoOther) {
  const ElasticSolid solid{ElasticModel::linear, 1, 0.3};
  for (const ElementKind kind : all_kinds) {
    const Mesh mesh = distorted_block(kind);
    const Elements elements(mesh);
    const Eigen::MatrixXd K = elements.stiffness(solid, 3, places(mesh, 3));
    const Eigen::VectorXd lambda = Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd>(K).eigenvalues();
    const double largest = lambda[lambda.size() - 1];
    EXPECT_LE(lambda.head<6>().cwiseAbs().maxCoeff(), 1e-14 * largest) << name_of(kind);
    EXPECT_GT(lambda[6], 1e-4 * largest) << name_of(kind);
  }
}

TEST(Elements, MassesAreThatOfTheBlockAndPositive) {
  constexpr double density = 2500;
  for (const ElementKind kind : all_kinds) {
    const Mesh mesh = distorted_block(kind);
    const std::vector<double> masses = fem::lumped_masses(mesh, density);
    EXPECT_NEAR(std::accumulate(masses.begin(), masses.end(), 0.0), 3 * density, 1e-10) << name_of(kind);
    for (const double mass : masses) EXPECT_GT(mass, 0);
  }
  // Closed forms: tet4 ρV/20 (1 + δ_ij).
  const Mesh mesh = distorted_block(ElementKind::tet4);
  const Eigen::MatrixXd mass = fem::consistent_mass(mesh, 2, density);
  const double whole = density * Elements(mesh).weight(2, 0);
  for (int i = 0; i < 4; ++i)
    for (int j = 0; j < 4; ++j) EXPECT_NEAR(mass(i, j), whole / 20 * (i == j ? 2 : 1), 1e-13 * whole);
}

// (1/3)³ of the mass at a corner with itself, (1/6)³ with the opposite one.
TEST(Elements, MassOfABrickIsTheClosedForm) {
  const Mesh mesh = model::box_mesh({0, 0, 0}, {1, 2, 3}, {1, 1, 1}, ElementKind::hex8);
  const Eigen::MatrixXd mass = fem::consistent_mass(mesh, 0, 1);
  EXPECT_NEAR(mass(0, 0), 6.0 / 27, 1e-14);
  EXPECT_NEAR(mass(0, 6), 6.0 / 216, 1e-14);
}

}  // namespace
}  // namespace eigengrain::test
