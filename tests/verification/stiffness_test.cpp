// Force and stiffness come from one law: finite differences of the force against K (docs/theory.md), and what
// K must be whatever the scene.
#include "eigengrain/assembly/forces.hpp"
#include "eigengrain/assembly/product.hpp"
#include "eigengrain/cycle/bounds.hpp"
#include "eigengrain/timestep/truth.hpp"

#include "support/lattices.hpp"
#include "support/scenes.hpp"

#include <gtest/gtest.h>

#include <random>

namespace eigengrain::test {
namespace {

/// Overlap over radius: the geometric part of the derivative, which K leaves out, is of this relative size.
constexpr double overlap = 1e-7;
/// Step of the differences over radius: a tenth of the overlap, so that no contact opens; positions of order
/// one are known to 1e-16, so the quotient is to some 1e-8 of the stiffness.
constexpr double step = 1e-8;
/// What force and stiffness are held to; the two errors above are ten times smaller.
constexpr double accuracy = 1e-6;

/// Forces and moments on the numbered unknowns after the displacement h x from the committed state.
Eigen::VectorXd forces_after(const System& s, const Eigen::VectorXd& x, double h) {
  const std::size_t bodies = s.model.bodies.position.size();
  assembly::Displacement d{std::vector<Vec3>(bodies, Vec3::Zero()), std::vector<Vec3>(bodies, Vec3::Zero())};
  for (std::int32_t block = 0; block < s.unknowns.blocks(); ++block) {
    auto& vectors = s.unknowns.is_rotation(block) ? d.rotation : d.translation;
    vectors[static_cast<std::size_t>(s.unknowns.body(block))] = h * x.segment<3>(3 * block);
  }
  const assembly::BodyForces f = assembly::contact_forces(s.model, d);
  Eigen::VectorXd result(x.size());
  for (std::int32_t block = 0; block < s.unknowns.blocks(); ++block) {
    const auto body = static_cast<std::size_t>(s.unknowns.body(block));
    result.segment<3>(3 * block) = s.unknowns.is_rotation(block) ? f.moment[body] : f.force[body];
  }
  return result;
}

/// Every column of K against -(f(h e) - f(-h e)) / 2h.
void expect_force_and_stiffness_agree(const SceneBuilder& builder) {
  const System s(builder);
  const Eigen::MatrixXd k = assembly::stiffness_matrix(s);
  ASSERT_GT(k.size(), 0);
  double worst = 0;
  for (Eigen::Index column = 0; column < k.cols(); ++column) {
    const Eigen::VectorXd e = Eigen::VectorXd::Unit(k.cols(), column);
    const Eigen::VectorXd derivative = -(forces_after(s, e, step) - forces_after(s, e, -step)) / (2 * step);
    worst = std::max(worst, (derivative - k.col(column)).cwiseAbs().maxCoeff());
  }
  EXPECT_LT(worst / k.cwiseAbs().maxCoeff(), accuracy);
}

constexpr std::array<Springs, 3> springs{
    Springs{.kn = 1, .ks = 0.6, .tension = false},  // sticking friction
    Springs{.kn = 1, .ks = 0, .tension = false},    // frictionless
    Springs{.kn = 1, .ks = 0.6, .tension = true},   // linear springs
};

/// A lattice whose neighbours overlap by `overlap`.
Lattice pressed(Lattice lattice) {
  lattice.cell *= 1 - 0.5 * overlap;
  return lattice;
}

TEST(FiniteDifferences, PeriodicLatticeWithImages) {
  for (const Springs& s : springs)
    expect_force_and_stiffness_agree(make_lattice(pressed(face_centred()), s, {2, 1, 1}));
}

TEST(FiniteDifferences, BodiesThatTouchTheirOwnImages) {
  for (const Springs& s : springs)
    expect_force_and_stiffness_agree(make_lattice(pressed(simple_cubic()), s, {1, 1, 2}));
}

TEST(FiniteDifferences, PileInACornerOfWalls) {
  for (const Springs& s : springs) {
    SceneBuilder builder(s);
    const double distance = 2 - overlap;
    const double height = 1 - 0.5 * overlap;
    for (int i = 0; i < 8; ++i)
      builder.ball(Vec3(i % 2, i / 2 % 2, i / 4) * distance + Vec3::Constant(height));
    builder.plane({0, 0, 0}, {1, 0, 0}).plane({0, 0, 0}, {0, 1, 0}).plane({0, 0, 0}, {0, 0, 1});
    expect_force_and_stiffness_agree(builder);
  }
}

TEST(FiniteDifferences, UnequalBallsInObliqueContact) {
  std::mt19937_64 random(21);
  for (const Springs& s : springs)
    for (int k = 0; k < 20; ++k) {
      const Vec3 n = random_vector(random).normalized();
      expect_force_and_stiffness_agree(SceneBuilder(s).ball({0, 0, 0}, 1).ball((1.6 - overlap) * n, 0.6));
    }
}

TEST(Energy, HasTheForcesAsItsGradient) {
  // -dE/dq by central differences at a displaced state. Shear follows the contact plane, so force and
  // gradient differ by the displacement squared, a few 1e-10 here.
  const System s(make_lattice(pressed(face_centred()), {.kn = 1, .ks = 0.6, .tension = true}, {1, 1, 1}));
  const std::size_t bodies = s.model.bodies.position.size();
  std::mt19937_64 random(24);
  assembly::Displacement at{std::vector<Vec3>(bodies), std::vector<Vec3>(bodies)};
  for (std::size_t i = 0; i < bodies; ++i) {
    at.translation[i] = 1e-5 * random_vector(random);
    at.rotation[i] = 1e-5 * random_vector(random);
  }
  const assembly::BodyForces f = assembly::contact_forces(s.model, at);
  constexpr double h = 1e-7;
  for (std::size_t i = 0; i < bodies; ++i)
    for (int k = 0; k < 3; ++k) {
      assembly::Displacement plus = at;
      assembly::Displacement minus = at;
      plus.translation[i][k] += h;
      minus.translation[i][k] -= h;
      const double slope =
          (assembly::elastic_energy(s.model, plus) - assembly::elastic_energy(s.model, minus)) / (2 * h);
      EXPECT_NEAR(-slope, f.force[i][k], 2e-9);
      EXPECT_GT(f.force[i].norm(), 1e-6);
    }
}

TEST(Stiffness, IsSymmetricAndSemidefinite) {
  std::mt19937_64 random(22);
  for (int k = 0; k < 20; ++k) {
    const System s(random_cluster(random, 30, {.kn = 1, .ks = 0.5}));
    const Eigen::MatrixXd matrix = assembly::stiffness_matrix(s);
    EXPECT_LT((matrix - matrix.transpose()).cwiseAbs().maxCoeff(), 1e-14 * matrix.cwiseAbs().maxCoeff());
    const Eigen::VectorXd spectrum = s.spectrum();
    EXPECT_GT(spectrum[0], -1e-13 * spectrum[spectrum.size() - 1]);
  }
}

/// Eigenvalues below 1e-10 of the largest.
int zeros(const Eigen::VectorXd& spectrum) {
  return static_cast<int>((spectrum.array() < 1e-10 * spectrum[spectrum.size() - 1]).count());
}

TEST(Stiffness, HasSixRigidModesWhenFreeAndThreeWhenPeriodic) {
  SceneBuilder cluster({.kn = 1, .ks = 0.5});
  const System periodic(make_lattice(face_centred(), {.kn = 1, .ks = 0.5}, {2, 2, 2}));
  for (const Vec3& x : periodic.model.bodies.position) cluster.ball(x);
  const System free(cluster);
  EXPECT_EQ(zeros(free.spectrum()), 6);
  EXPECT_EQ(zeros(periodic.spectrum()), 3);

  // And the six are the rigid motions: (e, 0) and (e × x, e).
  const auto k = assembly::stiffness_matrix(free);
  for (int axis = 0; axis < 3; ++axis) {
    Eigen::VectorXd shift = Eigen::VectorXd::Zero(k.cols());
    Eigen::VectorXd turn = Eigen::VectorXd::Zero(k.cols());
    const Vec3 e = Vec3::Unit(axis);
    for (std::int32_t b = 0; b < free.unknowns.blocks(); ++b) {
      const Vec3& x = free.model.bodies.position[static_cast<std::size_t>(free.unknowns.body(b))];
      if (!free.unknowns.is_rotation(b)) shift.segment<3>(3 * b) = e;
      turn.segment<3>(3 * b) = free.unknowns.is_rotation(b) ? e : Vec3(e.cross(x));
    }
    EXPECT_LT((k * shift).norm(), 1e-13 * shift.norm());
    EXPECT_LT((k * turn).norm(), 1e-13 * turn.norm());
  }
}

TEST(Stiffness, SpectrumDoesNotKnowTheFrameButTheDiagonalEstimateDoes) {
  std::mt19937_64 random(23);
  double estimate_changes = 0;
  for (int k = 0; k < 20; ++k) {
    const SceneBuilder builder =
        random_cluster(random, 15, {.kn = 1, .ks = 0.3}).plane({0, 0, -1}, {0, 0, 1});
    const System s(builder);
    const System t(builder.turned(random_rotation(random)));
    const Eigen::VectorXd a = s.spectrum();
    const Eigen::VectorXd b = t.spectrum();
    EXPECT_LT((a - b).cwiseAbs().maxCoeff(), 1e-10 * a.maxCoeff());
    const double block = cycle::block_bound(s);
    EXPECT_NEAR(cycle::block_bound(t) / block, 1, 1e-10);
    const double diagonal = cycle::diagonal_estimate(s);
    const double turned = cycle::diagonal_estimate(t);
    estimate_changes = std::max(estimate_changes, std::abs(turned / diagonal - 1));
  }
  EXPECT_GT(estimate_changes, 0.05);
}

}  // namespace
}  // namespace eigengrain::test
