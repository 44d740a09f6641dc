// Equilibrium and true critical timestep with deformable bodies, against closed forms.
#include "eigengrain/assembly/balance.hpp"
#include "eigengrain/cycle/cycle.hpp"
#include "eigengrain/relaxation/relax.hpp"
#include "eigengrain/timestep/truth.hpp"

#include "support/deformables.hpp"
#include "support/motion.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace eigengrain::test {
namespace {

using model::ElasticModel;
using model::ElasticSolid;
using model::ElementKind;

/// Loads of the nodes of the last body that was added: a force in all, shared by the mass of those chosen.
template <class Chosen>
void load_nodes(SceneBuilder& builder, const Vec3& force, const Chosen& chosen) {
  model::Bodies& bodies = builder.scene().bodies;
  const auto first = static_cast<std::size_t>(builder.scene().deformables.back().first_node);
  bodies.applied_force.resize(bodies.position.size(), Vec3::Zero());
  double mass = 0;
  for (std::size_t i = first; i < bodies.position.size(); ++i)
    if (chosen(bodies.position[i])) mass += bodies.mass[i];
  for (std::size_t i = first; i < bodies.position.size(); ++i)
    if (chosen(bodies.position[i])) bodies.applied_force[i] = bodies.mass[i] / mass * force;
}

assembly::State relaxed(SceneBuilder builder, double ratio = 1e-9) {
  assembly::State state = cycle::start(builder.scene());
  const relaxation::RelaxResult result =
      relaxation::relax(state, {.tolerance = ratio, .method = relaxation::Method::newton});
  EXPECT_TRUE(result.converged);
  return state;
}

/// Mean displacement of the nodes of a body that lie in a place.
template <class Chosen>
Vec3 mean_displacement(const assembly::State& state, const Chosen& chosen) {
  Vec3 sum = Vec3::Zero();
  double count = 0;
  const assembly::Solid& solid = *state.model.solids.front();
  for (std::size_t node = 0; node < solid.row.size(); ++node) {
    const Vec3& x = solid.deformable.mesh.nodes[node];
    if (!chosen(x)) continue;
    sum += state.model.bodies.position[static_cast<std::size_t>(solid.row[node])] - x;
    ++count;
  }
  return sum / count;
}

/// Deflection at the end of a beam of 10 x 1 x 1 held at x = 0, by a small force, over that of Timoshenko's
/// theory.
double cantilever(ElementKind kind, std::array<std::int32_t, 3> cells) {
  constexpr double young = 1e7;
  constexpr double length = 10;
  SceneBuilder builder;
  add_deformable(builder, model::box_mesh({0, 0, 0}, {length, 1, 1}, cells, kind),
                 {ElasticModel::corotational, young, 0}, 1000, [](const Vec3& x) {
                   return model::FixedComponents(static_cast<std::uint8_t>(x.x() < 1e-9 ? 7 : 0));
                 });
  const auto at_end = [](const Vec3& x) { return x.x() > length - 1e-9; };
  constexpr double force = -30;  // a thousandth of the length: what is not linear is 10⁻⁶
  load_nodes(builder, {0, 0, force}, at_end);
  const double deflection = mean_displacement(relaxed(builder), at_end).z();
  // PL³/3EI + PL/κGA, κ = 5/6 and G = E/2 for ν = 0.
  const double exact = force * (length * length * length / (3 * young / 12) + length / (5.0 / 6 * young / 2));
  return deflection / exact;
}

// Quadratic tetrahedra bend: 1% with one brick of six across. Bricks of eight nodes are too stiff in bending,
// by the square of their length over height, and better with the square of their number; tetrahedra of four
// are far stiffer.
TEST(DeformableEquilibrium, ACantileverBendsAsTimoshenkos) {
  EXPECT_NEAR(cantilever(ElementKind::tet10, {10, 1, 1}), 1, 0.012);
  const double coarse = 1 - cantilever(ElementKind::hex8, {20, 2, 2});
  const double fine = 1 - cantilever(ElementKind::hex8, {40, 4, 4});
  EXPECT_GT(fine, 0);
  EXPECT_LT(fine, 0.04);
  EXPECT_NEAR(coarse / fine, 4, 0.7);
  const double tetrahedra = cantilever(ElementKind::tet4, {20, 2, 2});
  EXPECT_LT(tetrahedra, 1 - coarse);
  EXPECT_GT(tetrahedra, 0.3);
}

// The large deflection of a cantilever under a dead load against the elastica: PL²/EI = 5 gives u/L = 0.38763
// and w/L = 0.71379 (Mattiasson, Int. J. Numer. Meth. Eng. 17:145, 1981).
TEST(DeformableEquilibrium, ABeamBendsFarAsTheElastica) {
  constexpr double young = 1e7;
  constexpr double length = 20;
  SceneBuilder builder;
  add_deformable(builder, model::box_mesh({0, 0, 0}, {length, 1, 1}, {20, 1, 1}, ElementKind::tet10),
                 {ElasticModel::corotational, young, 0}, 1000, [](const Vec3& x) {
                   return model::FixedComponents(static_cast<std::uint8_t>(x.x() < 1e-9 ? 7 : 0));
                 });
  const auto at_end = [](const Vec3& x) { return x.x() > length - 1e-9; };
  load_nodes(builder, {0, 0, -5 * young / 12 / (length * length)}, at_end);
  assembly::State state = cycle::start(builder.scene());
  // Newton's method alone does not come so far from a straight beam: explicit steps lead the way.
  const relaxation::RelaxResult result = relaxation::relax(state, {.tolerance = 1e-9});
  EXPECT_TRUE(result.converged);
  const Vec3 moved = mean_displacement(state, at_end) / length;
  // A beam of thickness L/20 has shear (E/κG (h/L)²/4 of the bending, 0.15%) and 1% of what its mesh lacks.
  EXPECT_NEAR(-moved.z(), 0.71379, 0.012);
  EXPECT_NEAR(-moved.x(), 0.38763, 0.012);
}

// Balls on a block on a floor: everything bears its weight, and the explicit cycle stays there. Balls lie
// over the inner of triangles (docs/theory.md, deformable bodies).
TEST(DeformableEquilibrium, BallsOnABlockRestAndStay) {
  for (const ElementKind kind : all_element_kinds) {
    SceneBuilder builder({.kn = 1e5, .ks = 8e4, .tension = false});
    const model::FixedComponents upright(
        0b111011);  // else they roll into the hollow that the block's weight makes
    builder.ball({0.4, 0.18, 0.301}, 0.3, 2, upright).ball({-0.6, 0.7, 0.251}, 0.25, 1, upright);
    builder.gravity({0, 0, -9.81}).damped(0.7);
    add_deformable(builder, model::box_mesh({-1, -1, -1}, {2, 2, 1}, {4, 4, 2}, kind),
                   {ElasticModel::corotational, 1e6, 0.3}, 1000, free_nodes);
    builder.plane({0, 0, -1}, {0, 0, 1});
    assembly::State state = cycle::start(builder.scene());
    const relaxation::RelaxResult result = relaxation::relax(state, {.tolerance = 1e-10});
    EXPECT_TRUE(result.converged) << name_of(kind);
    const assembly::Balance balance = assembly::balance_of(state);
    EXPECT_LE(balance.mean, std::max(1e-10, 3 * balance.floor)) << name_of(kind);
    EXPECT_EQ(balance.unsupported, 0);
    const Vec3 floor = assembly::wall_forces(state.model).front();
    EXPECT_NEAR(floor.z(), -9.81 * (3 + 4000), 1e-5) << name_of(kind);
    const std::vector<Vec3> before = positions_of(state);
    const double dt = 0.5 * timestep::critical_timestep(assembly::LinearSystem(state.model)).dt;
    cycle::Cycle cycle(std::move(state), fixed_step(dt));
    cycle.run(1000);
    double farthest = 0;
    for (std::size_t i = 0; i < before.size(); ++i)
      farthest = std::max(farthest, (positions_of(cycle.state())[i] - before[i]).norm());
    EXPECT_LE(farthest, 1e-9) << name_of(kind);
  }
}

TEST(DeformableEquilibrium, TheTruthIsDenseLapacksAndProven) {
  for (const ElementKind kind : all_element_kinds) {
    SceneBuilder builder({.kn = 1e4, .ks = 8e3, .tension = false});
    builder.ball({0.31, 0.17, 0.2999}, 0.3, 20);
    add_deformable(builder, model::box_mesh({-1, -1, -1}, {2, 2, 1}, {4, 4, 2}, kind),
                   {ElasticModel::corotational, 1e6, 0.3}, 1000, fixed_below(-0.9));
    const System system(builder);
    const timestep::Truth truth =
        timestep::critical_timestep(system, 0.0, {.certify = timestep::Certify::always});
    EXPECT_NEAR(truth.dt, 2 / std::sqrt(system.spectrum().maxCoeff()), 1e-9 * truth.dt) << name_of(kind);
    EXPECT_TRUE(truth.certified) << name_of(kind);
  }
}

}  // namespace
}  // namespace eigengrain::test
