// Cells whose edges slant: K against finite differences, spectra that do not know by which edges a lattice
// repeats, and equilibria of sheared packings.
#include "eigengrain/cycle/policy.hpp"
#include "eigengrain/io/scene_reader.hpp"
#include "eigengrain/relaxation/relax.hpp"
#include "eigengrain/timestep/truth.hpp"

#include "support/clumps.hpp"
#include "support/lattices.hpp"
#include "support/motion.hpp"
#include "support/scenes.hpp"

#include <gtest/gtest.h>

#include <cstdio>
#include <random>

namespace eigengrain::test {
namespace {

constexpr model::FixedComponents free_body{};

/// FCC by its primitive edges, which make 60° with each other: one ball a cell, n³ cells.
SceneBuilder primitive_fcc(const Springs& springs, int n, model::FixedComponents fixed = free_body) {
  SceneBuilder builder(springs);
  Mat3 edges;
  edges << 0, 1, 1, 1, 0, 1, 1, 1, 0;
  edges *= std::sqrt(2.0) * touching;
  for (int i = 0; i < n; ++i)
    for (int j = 0; j < n; ++j)
      for (int k = 0; k < n; ++k) builder.ball(edges * (Vec3(i, j, k) + Vec3::Constant(0.01)), 1, 1, fixed);
  builder.periodic(Vec3::Ones());
  builder.scene().cell.edges = n * edges;
  return builder;
}

// λ_max m = max(8 (k_n + k_s), 40 k_s) (docs/theory.md): the translational wave is at the zone boundary,
// which two primitive cells hold as well as the cubic ones do.
TEST(SlantedCell, HasTheLargestEigenvalueOfFcc) {
  for (const double ks : {0.0, 0.1, 0.25, 0.7}) {
    const Springs springs{.kn = 1, .ks = ks};
    const System slanted(primitive_fcc(springs, 2));
    EXPECT_FALSE(slanted.model.cell.orthogonal());
    const System cubic(make_lattice(face_centred(), springs, {1, 1, 1}));
    EXPECT_EQ(slanted.elements.size(), 48U);
    const double wanted = std::max(8 * (1 + ks), 40 * ks);
    EXPECT_NEAR(timestep::critical_timestep(slanted).lambda_max, wanted, 1e-9 * wanted);
    EXPECT_NEAR(timestep::critical_timestep(cubic).lambda_max, wanted, 1e-9 * wanted);
  }
}

// The same lattice and waves in the same number of balls: 32 by cubic edges, and by edges of which two are
// sums. The whole spectrum is the same, up to the 1e-11 of dense eigenvalues of order ten.
TEST(SlantedCell, HasTheSpectrumOfTheSameLatticeByOtherEdges) {
  const Springs springs{.kn = 1, .ks = 0.4};
  SceneBuilder builder = make_lattice(face_centred(), springs, {2, 2, 2});
  const Eigen::VectorXd box = System(builder).spectrum();
  Mat3& edges = builder.scene().cell.edges;
  edges.col(2) += 3 * edges.col(0);
  edges.col(1) += edges.col(2);
  const Eigen::VectorXd other = System(builder).spectrum();
  ASSERT_EQ(box.size(), other.size());
  EXPECT_LT((box - other).cwiseAbs().maxCoeff(), 1e-10 * box.maxCoeff());
}

// As in stiffness_test.cpp: overlaps of 1e-7, differences of 1e-8, agreement to 1e-6. Balls that touch
// through slanted edges, one of them its own image.
TEST(SlantedCell, HasAStiffnessThatIsTheDerivativeOfForces) {
  constexpr double overlap = 1e-7;
  for (const Springs& springs : {Springs{.kn = 1, .ks = 0.6, .tension = false},
                                 Springs{.kn = 1, .ks = 0, .tension = false}, Springs{.kn = 1, .ks = 0.6}}) {
    SceneBuilder builder(springs);
    const Vec3 lean = (2 - overlap) * Vec3(0.4, -0.2, 1).normalized();
    builder.ball({1, 1, 1}, 1, 1);
    // Another that touches the first through the edge along x, which leans too.
    const Vec3 edge(5, 0.9, -0.6);
    builder.ball(Vec3(1, 1, 1) + edge - (2.4 - overlap) * Vec3(0.5, 0.7, 0.3).normalized(), 1.4, 2);
    builder.periodic({5, 9, 2});
    builder.scene().cell.edges.col(0) = edge;
    builder.scene().cell.edges.col(2) = lean;
    const System system(builder);
    ASSERT_FALSE(system.model.cell.orthogonal());
    ASSERT_GE(system.elements.size(), 2U);
    const Eigen::MatrixXd k = assembly::stiffness_matrix(system);
    const double error = (numerical_stiffness(system, 1e-8) - k).cwiseAbs().maxCoeff();
    std::printf("%zu contacts, K off by %.1e\n", system.elements.size(), error / k.cwiseAbs().maxCoeff());
    EXPECT_LT(error, 1e-6 * k.cwiseAbs().maxCoeff());
  }
}

// A packing that is sheared, brought to rest and sheared on: the cell rests while an equilibrium is sought,
// and its flow begins anew then, once.
TEST(SlantedCell, RestsWhileAnEquilibriumIsSought) {
  const model::Scene scene = io::read_scene_text(R"(
materials: [{name: grain, density: 2500}]
contacts: [{between: [any, any], law: linear, kn: 1e5, ks: 5e4, friction: 0.5}]
periodic: {box: [40 mm, 40 mm, 40 mm], velocity_gradient: [[0, 0, 10], [0, 0, 0], [0, 0, 0]]}
balls: [{fill: dense, mean_overlap: 5e-3, sizes: {distribution: uniform, min: 4 mm, max: 6 mm}, seed: 2, material: grain}]
timestep: {policy: bound}
)",
                                                 ".", "packing.yaml");
  cycle::Cycle cycle(cycle::start(scene), cycle::policy_of(scene));
  cycle.run(2000);
  assembly::State state = cycle.release();
  const Mat3 edges = state.model.cell.edges;
  ASSERT_GT(std::abs(edges(0, 2)), 1e-3);
  const relaxation::RelaxResult result =
      relaxation::relax(state, {.tolerance = 1e-9, .report = {}, .interrupted = {}});
  EXPECT_TRUE(result.converged) << result.method;
  EXPECT_LT(result.end.mean, 1e-9);
  EXPECT_TRUE(state.model.cell.rate.isZero(0));
  EXPECT_EQ(state.model.cell.velocity_gradient, scene.cell.velocity_gradient);
  EXPECT_EQ(state.model.cell.edges, edges);  // short already
  for (const Vec3& v : state.model.bodies.velocity) EXPECT_EQ(v, Vec3(Vec3::Zero()));

  state.next_dt = 0;
  const std::vector<Vec3> before = state.model.bodies.position;
  cycle::Cycle on(std::move(state), fixed_step(1e-6));
  const std::int64_t lists = on.state().list.rebuilds;
  on.run(1);
  ASSERT_EQ(on.state().list.rebuilds, lists);
  for (std::size_t i = 0; i < before.size(); ++i) {
    const Vec3 flow(10 * before[i].z(), 0, 0);
    // Forces of 1e-9 of some newtons move a gram by 1e-12 m/s in a microsecond.
    EXPECT_LT((on.state().model.bodies.velocity[i] - flow).norm(), 1e-10);
  }
}

}  // namespace
}  // namespace eigengrain::test
