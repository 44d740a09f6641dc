// Deformable bodies among balls: one set of forces, one matrix, one step.
#include "eigengrain/assembly/balance.hpp"
#include "eigengrain/assembly/energies.hpp"
#include "eigengrain/assembly/forces.hpp"
#include "eigengrain/assembly/nodal_stiffness.hpp"
#include "eigengrain/assembly/product.hpp"
#include "eigengrain/base/parallel.hpp"
#include "eigengrain/cycle/bounds.hpp"

#include "support/bits.hpp"
#include "support/deformables.hpp"
#include "support/motion.hpp"

#include <Eigen/Eigenvalues>
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <random>

namespace eigengrain::test {
namespace {

using assembly::BodyForces;
using assembly::Displacement;
using model::ElasticModel;
using model::ElasticSolid;
using model::ElementKind;

constexpr ElasticSolid rubber{ElasticModel::corotational, 2e5, 0.3};

/// A block whose top is at z = 0.
model::Mesh block(ElementKind kind, std::array<std::int32_t, 3> cells = {2, 2, 1}) {
  return model::box_mesh({-1, -1, -1}, {2, 2, 1}, cells, kind);
}

/// Balls that press on the block by 1e-3 of their radius: on a face, near an edge inside, and over its rim.
SceneBuilder balls_on_block(ElementKind kind,
                            const Springs& springs = {.kn = 1e4, .ks = 8e3, .tension = false}) {
  SceneBuilder builder(springs);
  builder.ball({0.31, 0.17, 0.2997}, 0.3, 2).ball({-0.5, 0.52, 0.2497}, 0.25, 1);
  builder.ball({1.0 + 0.2 / std::sqrt(2.0) - 1e-4, -0.3, 0.2 / std::sqrt(2.0) - 1e-4}, 0.2, 1);
  add_deformable(builder, block(kind), rubber, 1000, fixed_below(-0.9));
  return builder;
}

Vec3 moment_about_origin(const assembly::Model& model, const BodyForces& forces) {
  Vec3 sum = Vec3::Zero();
  for (std::size_t i = 0; i < forces.force.size(); ++i)
    sum += model.bodies.position[i].cross(forces.force[i]) + forces.moment[i];
  return sum;
}

Displacement random_displacement(const assembly::Model& model, double size, unsigned seed) {
  std::mt19937_64 random(seed);
  Displacement result;
  for (std::int32_t i = 0; i < model.bodies.size(); ++i) {
    result.translation.emplace_back(size * random_vector(random));
    const bool node = assembly::is_node(model.bodies, static_cast<std::size_t>(i));
    result.rotation.emplace_back(node ? Vec3(Vec3::Zero()) : Vec3(size * random_vector(random)));
  }
  return result;
}

// What balls and elements do to each other cancels, wherever the ball touches and however it was dragged
// along.
TEST(DeformableBodies, ForcesAndMomentsCancel) {
  for (const ElementKind kind : all_element_kinds) {
    assembly::Model model = balls_on_block(kind).build();
    EXPECT_EQ(model.contacts.size(), 3) << name_of(kind);
    Displacement moved = random_displacement(model, 3e-4, 5);
    const BodyForces forces = assembly::contact_forces(model, moved);
    for (std::size_t i = 0; i < moved.translation.size(); ++i)
      model.bodies.position[i] += moved.translation[i];
    Vec3 sum = Vec3::Zero();
    double magnitude = 0;
    for (const Vec3& force : forces.force) {
      sum += force;
      magnitude += force.norm();
    }
    EXPECT_GT(magnitude, 1);
    EXPECT_LE(sum.norm(), 1e-14 * magnitude * std::sqrt(static_cast<double>(forces.force.size())));
    // A contact's part is exact where its point is taken as it lies now, as here; that of elements by
    // objectivity.
    EXPECT_LE(moment_about_origin(model, forces).norm(), 1e-12 * magnitude) << name_of(kind);
  }
}

// K u is minus the change of forces; what K leaves out is of the size of the forces over the edges of the
// mesh, so it is looked at where balls just touch.
TEST(DeformableBodies, StiffnessIsMinusTheDerivativeOfForces) {
  for (const ElementKind kind : all_element_kinds) {
    SceneBuilder builder({.kn = 1e4, .ks = 8e3, .tension = true});
    builder.ball({0.31, 0.17, 0.3 - 1e-10}, 0.3, 2).ball({-0.5, 0.52, 0.25 - 1e-10}, 0.25, 1);
    add_deformable(builder, block(kind), rubber, 1000, fixed_below(-0.9));
    const System system(builder);
    ASSERT_EQ(system.model.contacts.size(), 2);
    const Eigen::SparseMatrix<double> k = assembly::stiffness_matrix(system);
    EXPECT_LE((k - Eigen::SparseMatrix<double>(k.transpose())).norm(), 1e-13 * k.norm());
    constexpr double h = 1e-7;
    const Displacement direction = random_displacement(system.model, 1, 11);
    Displacement forth = direction;
    Displacement back = direction;
    Eigen::VectorXd u(system.unknowns.size());
    for (std::int32_t b = 0; b < system.unknowns.blocks(); ++b) {
      const auto body = static_cast<std::size_t>(system.unknowns.body(b));
      u.segment<3>(3 * b) =
          system.unknowns.is_rotation(b) ? direction.rotation[body] : direction.translation[body];
    }
    for (std::size_t i = 0; i < direction.translation.size(); ++i) {
      const bool fixed = system.model.bodies.fixed[i].translation() == 7;
      forth.translation[i] = fixed ? Vec3(Vec3::Zero()) : Vec3(h * direction.translation[i]);
      back.translation[i] = -forth.translation[i];
      forth.rotation[i] = h * direction.rotation[i];
      back.rotation[i] = -forth.rotation[i];
    }
    const BodyForces plus = assembly::contact_forces(system.model, forth);
    const BodyForces minus = assembly::contact_forces(system.model, back);
    const Eigen::VectorXd ku = k * u;
    double worst = 0;
    for (std::int32_t b = 0; b < system.unknowns.blocks(); ++b) {
      const auto body = static_cast<std::size_t>(system.unknowns.body(b));
      const Vec3 change = system.unknowns.is_rotation(b)
                              ? Vec3((minus.moment[body] - plus.moment[body]) / (2 * h))
                              : Vec3((minus.force[body] - plus.force[body]) / (2 * h));
      worst = std::max(worst, (ku.segment<3>(3 * b) - change).norm());
    }
    // Rounding of forces ε E A/h, and forces of the probe's own size, h k, over edges.
    EXPECT_LE(worst, 2e-6 * ku.norm()) << name_of(kind);
  }
}

TEST(DeformableBodies, ProductAndMatrixAreTheSame) {
  for (const ElementKind kind : all_element_kinds) {
    const System system(balls_on_block(kind));
    const Eigen::SparseMatrix<double> k = assembly::stiffness_matrix(system);
    assembly::StiffnessProduct product(system.unknowns, system.parts());
    std::vector<double> x(static_cast<std::size_t>(system.unknowns.size()), 0.0);
    std::vector<double> y(x.size());
    std::mt19937_64 random(3);
    std::normal_distribution<double> gaussian;
    for (const std::int32_t number : system.unknowns.free_components())
      x[static_cast<std::size_t>(number)] = gaussian(random);
    product.apply(x, y);
    const Eigen::VectorXd expected = k * Eigen::Map<const Eigen::VectorXd>(x.data(), std::ssize(x));
    EXPECT_LE((expected - Eigen::Map<const Eigen::VectorXd>(y.data(), std::ssize(y))).norm(),
              1e-13 * expected.norm())
        << name_of(kind);
  }
}

TEST(DeformableBodies, BoundsAreNeverAboveTheTruth) {
  for (const ElementKind kind : all_element_kinds) {
    const System system(balls_on_block(kind));
    const double truth = 2 / std::sqrt(system.spectrum().maxCoeff());
    const double bound = cycle::block_bound(system);
    EXPECT_LE(bound, truth * (1 + 1e-12)) << name_of(kind);
    EXPECT_GE(bound, 0.3 * truth) << name_of(kind);
    EXPECT_GE(cycle::scaled_block_bound(system, 3), bound * (1 - 1e-12));
    EXPECT_LE(cycle::scaled_block_bound(system, 10), truth * (1 + 1e-12));
  }
}

/// The largest energy of a run from rest in its highest mode, over that at the start.
double growth_in_highest_mode(SceneBuilder builder, double part_of_limit, int steps) {
  const System system(builder);
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> solver(assembly::dense_scaled_stiffness(system));
  const double truth = 2 / std::sqrt(solver.eigenvalues().maxCoeff());
  const std::vector<double> scale = system.inverse_sqrt_mass();
  const std::vector<std::int32_t> free = system.unknowns.free_components();
  const Eigen::VectorXd mode = solver.eigenvectors().rightCols<1>();
  assembly::State state = cycle::start(builder.scene());
  for (std::size_t i = 0; i < free.size(); ++i) {
    const std::int32_t block = free[i] / 3;
    const auto body = static_cast<std::size_t>(system.unknowns.body(block));
    const double v = 1e-9 * mode[static_cast<Eigen::Index>(i)] * scale[static_cast<std::size_t>(free[i])];
    (system.unknowns.is_rotation(block) ? state.model.bodies.spin
                                        : state.model.bodies.velocity)[body][free[i] % 3] = v;
  }
  cycle::Cycle cycle(std::move(state), fixed_step(part_of_limit * truth));
  const double first = assembly::energies_of(cycle.state()).kinetic;
  double largest = 0;
  for (int step = 0; step < steps; ++step) {
    cycle.step();
    largest = std::max(largest, assembly::energies_of(cycle.state()).kinetic);
  }
  return largest / first;
}

// At 1 - 1e-3 of the limit amplitudes are bounded by 1/√(1 - 0.999²) = 22 of the start; above it they grow by
// 1 + √(2e-3) = 1.09 a step and more.
TEST(DeformableBodies, TheCriticalStepOfTheCoupledMatrixIsThatOfRuns) {
  SceneBuilder builder({.kn = 4e5, .ks = 3e5, .tension = true});
  builder.ball({0.31, 0.17, 0.3 - 1e-14}, 0.3, 2).ball({-0.5, 0.52, 0.25 - 1e-14}, 0.25, 1);
  add_deformable(builder, block(ElementKind::hex8), rubber, 1000, fixed_below(-0.9));
  EXPECT_LE(growth_in_highest_mode(builder, 0.999, 400), 3000);
  EXPECT_GE(growth_in_highest_mode(builder, 1.001, 400), 1e8);
}

TEST(DeformableBodies, AFreeOneKeepsMomentumAngularMomentumAndEnergy) {
  for (const ElasticModel law :
       {ElasticModel::corotational, ElasticModel::saint_venant_kirchhoff, ElasticModel::neo_hookean}) {
    SceneBuilder builder;
    add_deformable(builder, block(ElementKind::tet4), {law, 2e5, 0.3}, 1000, free_nodes);
    model::Bodies& bodies = builder.scene().bodies;
    const Vec3 spin(3, -2, 5);
    bodies.velocity.resize(bodies.position.size());
    for (std::size_t i = 0; i < bodies.velocity.size(); ++i) {
      bodies.velocity[i] = Vec3(1, 2, 3) + spin.cross(bodies.position[i]);
      bodies.velocity[i].z() += 3 * bodies.position[i].x() * bodies.position[i].x();  // and bends
    }
    const double limit = cycle::block_bound(System(builder));
    cycle::Cycle cycle = cycle_of(builder, 0.02 * limit);
    const auto momentum = [&] {
      Vec3 linear = Vec3::Zero();
      Vec3 angular = Vec3::Zero();
      const assembly::State& s = cycle.state();
      for (std::size_t i = 0; i < s.force.size(); ++i) {
        linear += s.model.bodies.mass[i] * s.model.bodies.velocity[i];
        // of positions half a step back, where velocities are
        const Vec3 x = s.model.bodies.position[i] - 0.5 * s.dt * s.model.bodies.velocity[i];
        angular += s.model.bodies.mass[i] * x.cross(s.model.bodies.velocity[i]);
      }
      return std::pair{linear, angular};
    };
    cycle.step();
    const auto [linear, angular] = momentum();
    const auto total = [&] {
      const assembly::Energies e = assembly::energies_of(cycle.state());
      return e.kinetic_product + e.elastic;
    };
    const double energy = total();
    cycle.run(4000);
    const auto [linear_then, angular_then] = momentum();
    EXPECT_LE((linear_then - linear).norm(), 1e-12 * linear.norm()) << name_of(law);
    EXPECT_LE((angular_then - angular).norm(), 1e-12 * angular.norm()) << name_of(law);
    // Leapfrog's energy errs by (ω Δt)²/8 of what vibrates: 5e-5 of it at a fiftieth of the limit, and that
    // is a part.
    EXPECT_NEAR(total(), energy, 1e-4 * energy) << name_of(law);
  }
}

// A bar between two smooth ends, free to slide: c = √(E/ρ) for ν = 0, and f = c/4L when one end is held.
TEST(DeformableBodies, ABarHasItsLongitudinalFrequency) {
  constexpr double length = 1;
  for (const ElementKind kind : all_element_kinds) {
    double before = 0;
    for (const std::int32_t cells : {8, 16}) {
      SceneBuilder builder;
      add_deformable(builder, model::box_mesh({0, 0, 0}, {0.1, 0.1, length}, {1, 1, cells}, kind),
                     {ElasticModel::corotational, 1e6, 0}, 1000, [](const Vec3& x) {
                       return model::FixedComponents(static_cast<std::uint8_t>(x.z() < 1e-9 ? 7 : 3));
                     });
      const double omega = std::sqrt(System(builder).spectrum().minCoeff());
      const double exact = std::numbers::pi / 2 * std::sqrt(1e6 / 1000) / length;
      const double error = std::abs(omega / exact - 1);
      EXPECT_LE(error, 0.01) << name_of(kind);
      // Lumped masses: (π/2 h/L)²/24 below for elements of two nodes along the bar. Tetrahedra have other
      // masses at corners where more of them meet, and those of ten nodes carry too much at their middles:
      // their error is small, but not of the order of their displacements.
      const double exact_error = std::pow(std::numbers::pi / 2 / cells, 2) / 24;
      if (kind == ElementKind::hex8) EXPECT_NEAR(error, exact_error, 0.01 * exact_error);
      if (kind == ElementKind::tet4) EXPECT_NEAR(error, exact_error, 0.5 * exact_error);
      if (kind == ElementKind::tet10) EXPECT_LE(error, 0.001);
      if (before > 0) EXPECT_GT(before / error, kind == ElementKind::tet10 ? 1.0 : 3.5) << name_of(kind);
      before = error;
    }
  }
}

TEST(DeformableBodies, AreTheSameToTheBitOnAnyNumberOfThreads) {
  std::string first;
  for (const int threads : {1, 2, 3}) {
    const Threads wanted(threads);
    cycle::Cycle cycle = cycle_of(balls_on_block(ElementKind::tet4).gravity({0, 0, -9.81}), 1e-4);
    cycle.run(300);
    const std::string bits = bits_of(cycle.state());
    if (first.empty()) first = bits;
    EXPECT_EQ(bits, first) << threads;
  }
}

// A scene without deformable bodies has none of it.
TEST(DeformableBodies, CostNothingWhereThereAreNone) {
  const System system(SceneBuilder({.kn = 1, .ks = 1}).ball({0, 0, 0}).ball({1.9, 0, 0}));
  EXPECT_TRUE(system.nodal.empty());
  EXPECT_EQ(system.parts().nodal, nullptr);
  EXPECT_TRUE(system.model.facets.body.empty());
}

}  // namespace
}  // namespace eigengrain::test
