// Floppy modes and states of self-stress against closed forms and dense singular values.
#include "eigengrain/spectrum/rigidity.hpp"

#include "eigengrain/assembly/block_matrix.hpp"
#include "eigengrain/assembly/product.hpp"
#include "eigengrain/measures/acting_contacts.hpp"

#include "spectrum/packings.hpp"
#include "support/bonds.hpp"
#include "support/lattices.hpp"
#include "support/random_bodies.hpp"

#include <Eigen/Eigenvalues>
#include <Eigen/SVD>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>

namespace eigengrain::test {
namespace {

using spectrum::Rigidity;
using spectrum::rigidity;
using spectrum::Springs;

/// Four balls, each touching the three others.
SceneBuilder tetrahedron(const test::Springs& springs) {
  SceneBuilder builder(springs);
  const double edge = (2 - 1e-9) / std::sqrt(8.0);
  for (const Vec3& x : {Vec3(1, 1, 1), Vec3(1, -1, -1), Vec3(-1, 1, -1), Vec3(-1, -1, 1)})
    builder.ball(edge * x);
  return builder;
}

TEST(Rigidity, OfATetrahedronWithoutFrictionIsIsostatic) {
  const Rigidity found = rigidity(tetrahedron({.kn = 1}).build());
  EXPECT_EQ(found.unknowns, 12);
  EXPECT_EQ(found.springs.size(), 6U);
  EXPECT_EQ(found.floppy, 6);
  EXPECT_EQ(found.trivial, 6);
  EXPECT_EQ(found.self_stress, 0);
  EXPECT_EQ(found.excess(), 0);
}

// 18 springs on 24 unknowns with 6 rigid motions: 18 of rank at most, and all of it.
TEST(Rigidity, OfATetrahedronWithFrictionHasNoMechanism) {
  const Rigidity found = rigidity(tetrahedron({.kn = 1, .ks = 0.5}).build());
  EXPECT_EQ(found.unknowns, 24);
  EXPECT_EQ(found.springs.size(), 18U);
  EXPECT_EQ(found.trivial, 6);
  EXPECT_EQ(found.floppy, 6);
  EXPECT_EQ(found.self_stress, 0);
  const Rigidity without = rigidity(tetrahedron({.kn = 1, .ks = 0.5}).build(), {.springs = Springs::normal});
  EXPECT_EQ(without.unknowns, 12);
  EXPECT_EQ(without.floppy, 6);
}

// A bond adds to the springs of its pair (eq. 1.34): six of them resist all that two balls can do to each
// other.
TEST(Rigidity, OfABondBesideAContactCountsThePairOnce) {
  SceneBuilder builder(test::Springs{.kn = 1, .ks = 0.5});
  builder.bonded(Cemented{}.rule()).ball({0, 0, 0}).ball({1.999, 0, 0});
  const Rigidity found = rigidity(builder.build());
  EXPECT_EQ(found.contacts, 1);
  EXPECT_EQ(found.springs.size(), 6U);
  EXPECT_EQ(found.floppy, 6);
  EXPECT_EQ(found.self_stress, 0);
}

// A chain that repeats: N springs, N + 1 balls' worth of nothing but its own translation along it is
// resisted, and one state of self-stress that runs around.
TEST(Rigidity, OfAChainThatRepeats) {
  const Rigidity found = rigidity(make_lattice(chain(), {.kn = 1}, {5, 1, 1}).build());
  EXPECT_EQ(found.unknowns, 15);
  EXPECT_EQ(found.springs.size(), 5U);
  EXPECT_EQ(found.self_stress, 1);
  EXPECT_EQ(found.floppy, 11);
  // Its translations, and two rotations that nothing across the chain resists; a rotation about it moves
  // nothing.
  EXPECT_EQ(found.trivial, 5);
}

TEST(Rigidity, OfLatticesThatRepeat) {
  const Rigidity fcc = rigidity(make_lattice(face_centred(), {.kn = 1}, {3, 3, 3}).build());
  EXPECT_EQ(fcc.trivial, 3);
  EXPECT_EQ(fcc.springs.size(), 6U * 108);
  EXPECT_TRUE(fcc.counts_agree());
  const System system(make_lattice(face_centred(), {.kn = 1}, {3, 3, 3}));
  EXPECT_EQ(fcc.floppy, (system.spectrum().array() < 1e-10).count());
}

TEST(Rigidity, OfABallOnAFloor) {
  SceneBuilder builder({.kn = 1});
  builder.ball({0, 0, 1 - 1e-9}).plane({0, 0, 0}, {0, 0, 1});
  const Rigidity found = rigidity(builder.build());
  EXPECT_EQ(found.floppy, 2);
  EXPECT_EQ(found.trivial, 2);  // along the floor; turning about the normal through it moves nothing
}

/// Ranks of √D B by dense singular values, from the assembled B and D.
std::int64_t dense_rank(const System& system) {
  const auto dense = [](const assembly::BlockMatrix& m) {
    Eigen::MatrixXd result = Eigen::MatrixXd::Zero(m.rows(), m.column_count());
    for (std::int32_t row = 0; row < m.block_rows; ++row)
      for (std::int32_t k = m.offsets[row]; k < m.offsets[row + 1]; ++k)
        for (int i = 0; i < 9; ++i) result(3 * row + i / 3, 3 * m.columns[k] + i % 3) += m.values[9 * k + i];
    return result;
  };
  const Eigen::MatrixXd d = dense(assembly::elasticity_blocks(system));
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> of(d);
  // What a direction without a spring is left with by rounding, some 1e-16 of the largest, has a root that
  // would pass for a spring; springs are 1e-6 of each other at least.
  const double least = 1e-13 * of.eigenvalues().maxCoeff();
  const Eigen::VectorXd root = (of.eigenvalues().array() > least).select(of.eigenvalues(), 0).cwiseSqrt();
  Eigen::MatrixXd s =
      root.asDiagonal() * of.eigenvectors().transpose() * dense(assembly::kinematic_blocks(system));
  const std::vector<double> scale = system.inverse_sqrt_mass();
  for (Eigen::Index k = 0; k < s.cols(); ++k) s.col(k) *= scale[static_cast<std::size_t>(k)];
  const Eigen::JacobiSVD<Eigen::MatrixXd> svd(s);
  return (svd.singularValues().array() > 1e-10 * svd.singularValues()[0]).count();
}

// Balls, clumps, bonds, walls, small cells, fixed components, stiffnesses up to 10⁶:1 (random_bodies.hpp).
TEST(Rigidity, OfRandomBodiesIsThatOfDenseSingularValues) {
  const int scenes = std::getenv("EIGENGRAIN_LONG_TESTS") != nullptr ? 1000 : 150;
  RandomBodies bodies(11);
  std::int64_t stressed = 0;
  for (int scene = 0; scene < scenes; ++scene) {
    const System system(bodies.next());
    const Rigidity found = rigidity(system.model, {.shapes = true});
    EXPECT_TRUE(found.counts_agree()) << scene;
    if (system.unknowns.free_components().empty()) continue;
    const std::int64_t rank = dense_rank(system);
    EXPECT_EQ(found.unknowns, std::ssize(system.unknowns.free_components())) << scene;
    EXPECT_EQ(found.floppy, found.unknowns - rank) << scene;
    EXPECT_EQ(found.self_stress, std::ssize(found.springs) - rank) << scene;
    EXPECT_LE(found.trivial, std::min<std::int64_t>(6, found.floppy)) << scene;
    EXPECT_LT(found.floppy_residual, 1e-9) << scene;
    EXPECT_LT(found.stress_residual, 1e-9) << scene;
    stressed += found.self_stress;
  }
  std::printf("%lld states of self-stress in %d scenes\n", static_cast<long long>(stressed), scenes);
  EXPECT_GT(stressed, scenes);
}

/// Balls with two contacts among those that are held by two at least.
std::int64_t balls_with_two_contacts(const assembly::Model& model) {
  const auto contacts = measures::acting_contacts(model);
  const auto rattler = measures::rattlers(model, contacts, measures::least_contacts(model));
  std::vector<int> count(rattler.size(), 0);
  for (const measures::ActingContact& c : contacts)
    if (!rattler[c.a] && !rattler[c.b]) {
      ++count[c.a];
      ++count[c.b];
    }
  return std::ranges::count(count, 2);
}

TEST(Rigidity, OfAPackingCountsItsZeroModes) {
  for (const char* law : {"ks: 5e4, friction: 0.5", "ks: 0, friction: 0"}) {
    const System system = pressed_packing("45 mm", law);
    const Rigidity whole = rigidity(system.model, {.shapes = true});
    const Eigen::VectorXd spectrum = system.spectrum();
    EXPECT_EQ(whole.floppy, (spectrum.array() < 1e-12 * spectrum.maxCoeff()).count());
    EXPECT_TRUE(whole.counts_agree());
    EXPECT_EQ(whole.trivial, 3);
    ASSERT_EQ(std::ssize(whole.floppy_u), whole.floppy);
    // The same in u and θ, against K itself.
    assembly::StiffnessProduct product(system.unknowns, system.elements);
    std::vector<double> x(system.mass.size());
    std::vector<double> image(x.size());
    for (std::size_t k = 0; k < whole.floppy_u.size(); ++k) {
      for (std::int32_t block = 0; block < system.unknowns.blocks(); ++block)
        for (int i = 0; i < 3; ++i) {
          const auto& rows = system.unknowns.is_rotation(block) ? whole.floppy_theta[k] : whole.floppy_u[k];
          x[static_cast<std::size_t>(3 * block + i)] =
              rows[static_cast<std::size_t>(3 * system.unknowns.body(block) + i)];
        }
      product.apply(x, image);
      double square = 0;
      for (std::size_t i = 0; i < x.size(); ++i) square += image[i] * image[i] / system.mass[i];
      // |S x| is at most 1e-10 |S|, by which a singular value counts as zero, and Sᵀ adds a norm.
      EXPECT_LT(std::sqrt(square), 1e-10 * spectrum.maxCoeff()) << k;
    }
    const Rigidity held = rigidity(system.model, {.with_rattlers = false});
    // It moves as a whole, and with friction each ball that has two contacts turns about the line through
    // them.
    EXPECT_EQ(held.floppy, 3 + balls_with_two_contacts(system.model));
    EXPECT_LT(held.bodies, whole.bodies + whole.set_aside);
    EXPECT_GT(held.excess(), 0);
  }
}

}  // namespace
}  // namespace eigengrain::test
