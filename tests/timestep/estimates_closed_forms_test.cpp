// Estimates of the timestep where a closed form says what they are.
#include "support/estimates.hpp"
#include "support/lattices.hpp"

#include <gtest/gtest.h>

#include <array>
#include <numbers>
#include <string_view>

namespace eigengrain::test {
namespace {

/// Overlaps of 1e-12 and eigenvalues to rounding.
constexpr double exact = 1e-9;

const Vec3 oblique = Vec3::Ones();

struct Expected {
  std::string_view name;
  double dt;
};

void expect_steps(const System& system, std::initializer_list<Expected> expected) {
  for (const Expected& e : expected) EXPECT_NEAR(estimate(e.name, system), e.dt, exact * e.dt) << e.name;
}

TEST(EstimatesOfAPair, AlongAnAxisWithoutShear) {
  const System system(pair_along(Vec3::UnitX(), {.kn = 1, .ks = 0}));
  const double truth = std::sqrt(2.0);
  ASSERT_NEAR(dense_truth(system), truth, exact);
  expect_steps(system, {{"diagonal", 1},
                        {"diagonal-translation", 1},
                        {"yade-global-stiffness", 1.41044},
                        {"nodal", truth},
                        {"mass-over-stiffness", 1},
                        {"coordination", truth},
                        {"contact-duration", std::numbers::pi},
                        {"reduced-duration", std::numbers::pi / truth},
                        // kn = 2 E R*, m = 4/3 π ρ
                        {"p-wave-of-stiffness", std::sqrt(3 / (4 * std::numbers::pi))},
                        {"element-equal", truth},
                        {"element-stiffness", truth},
                        {"element-best", truth},
                        {"block-bound", truth},
                        {"scaled-block-bound", truth},
                        {"gershgorin", truth},
                        {"gershgorin-symmetric", truth},
                        {"contact-space", truth},
                        {"contact-space-scaled", truth},
                        {"lanczos-10", truth},
                        {"lanczos-residual-10", truth},
                        {"lanczos-probable-10", truth}});
  EXPECT_TRUE(std::isinf(estimate("diagonal-rotation", system)));
}

TEST(EstimatesOfAPair, AlongADiagonal) {
  const System system(pair_along(oblique, {.kn = 1, .ks = 0}));
  // k_n/3 on each axis; rows of K sum up to k_n/3 · 3 twice.
  expect_steps(system, {{"diagonal", std::sqrt(3.0)},
                        {"yade-global-stiffness", 1.41044 * std::sqrt(3.0)},
                        {"gershgorin-symmetric", std::sqrt(2.0)},
                        {"block-bound", std::sqrt(2.0)}});
}

TEST(EstimatesOfAPair, WithShearIsGovernedByRotation) {
  const System system(pair_along(Vec3::UnitX(), {.kn = 1, .ks = 1}));
  // λ = 7: each ball alone has k_s/m + k_s R²/I = 3.5 k_s/m in the coupled motion, 2.5 in pure rotation.
  ASSERT_NEAR(dense_truth(system), 2 / std::sqrt(7.0), exact);
  expect_steps(system, {{"diagonal", std::sqrt(0.4)},
                        {"diagonal-translation", 1},
                        {"diagonal-rotation", std::sqrt(0.4)},
                        {"yade-global-stiffness", 1.41044 * std::sqrt(0.4)},
                        {"element-equal", 2 / std::sqrt(7.0)},
                        {"contact-space", 2 / std::sqrt(7.0)},
                        {"block-bound", 2 / std::sqrt(7.0)},
                        // row u: 2 (k_s + k_s/R), row Rθ: 2 · 2.5 (k_s + k_s)
                        {"gershgorin", 2 / std::sqrt(10.0)},
                        // row θ of M^-½ K M^-½: 2 (2.5 + √2.5)
                        {"gershgorin-symmetric", 2 / std::sqrt(5 + 2 * std::sqrt(2.5))}});
}

TEST(EstimatesOfAPair, OfDifferentMasses) {
  SceneBuilder builder({.kn = 1, .ks = 0});
  builder.ball(Vec3::Zero()).ball({2 * (1 - 1e-12), 0, 0}, 1, 100);
  const System system(builder);
  const double truth = 2 / std::sqrt(1.01);
  ASSERT_NEAR(dense_truth(system), truth, exact);
  // One contact: its element is the system. With d = 1 the lighter ball is taken to move against its image.
  expect_steps(system, {{"element-equal", truth},
                        {"contact-space", truth},
                        {"block-bound", std::sqrt(2.0)},
                        {"mass-over-stiffness", 1},
                        {"reduced-duration", std::numbers::pi / std::sqrt(1.01)},
                        {"lanczos-10", truth}});
  EXPECT_NEAR(estimate("scaled-block-bound-10", system), truth, exact);
}

TEST(EstimatesOfAWallContact, KnowThatTheWallDoesNotMove) {
  SceneBuilder builder({.kn = 1, .ks = 0});
  const System system(builder.ball({0, 0, 1 - 1e-12}).plane({0, 0, 0}, {0, 0, 1}));
  expect_steps(system, {{"diagonal", 1},
                        {"nodal", std::sqrt(2.0)},
                        {"reduced-duration", std::numbers::pi},
                        {"element-equal", 2},
                        {"contact-space", 2},
                        {"gershgorin", 2},
                        {"block-bound", 2}});
}

TEST(EstimatesOfAChain, AreThoseOfItsElements) {
  // Periodic: λ_max = 4, every body with two contacts of the same stiffness.
  const System system(make_lattice(chain(), {.kn = 1, .ks = 0}, {8, 1, 1}));
  ASSERT_NEAR(dense_truth(system), 1, exact);
  expect_steps(system, {{"diagonal", std::sqrt(0.5)},
                        {"nodal", 1},
                        {"coordination", 1},
                        {"mass-over-stiffness", 1},
                        {"element-equal", 1},
                        {"element-best", 1},
                        {"block-bound", 1},
                        {"gershgorin", 1}});
  // Norms of its blocks are raised by 1e-7.
  EXPECT_NEAR(estimate("contact-space", system), 1, 1e-7);
}

TEST(EstimatesOfAChain, BestPartsOfTheMassAreExactWhereStiffnessesDiffer) {
  // A free chain of three with springs 1 and 9: λ of 3x3 in closed form. Equal parts give the ball in the
  // middle half of its mass to either spring, 9 (1 + 2); the best give the stiff one more.
  SceneBuilder builder({.kn = 1, .ks = 0});
  const double d = 2 * (1 - 1e-12);
  builder.ball(Vec3::Zero()).ball({d, 0, 0}).ball({2 * d, 0, 0});
  System system(builder);
  ASSERT_EQ(system.elements.size(), 2U);
  system.elements[0].stiffness.normal = 1;
  system.elements[1].stiffness.normal = 9;
  const double lambda = 10 + std::sqrt(73.0);
  EXPECT_NEAR(estimate("element-equal", system), 2 / std::sqrt(27.0), exact);
  EXPECT_NEAR(estimate("element-stiffness", system), 2 / std::sqrt(9 * (1 + 10.0 / 9)), exact);
  EXPECT_NEAR(estimate("element-best", system), 2 / std::sqrt(lambda), exact);
}

TEST(EstimatesOfLattices, AreInTheRatiosOfTheirContacts) {
  // Without shear every body of a cubic lattice has z contacts of equal stiffness, whose blocks are
  // isotropic: k z/3. λ_max = 2 z/3 k/m but for FCC, where it is as much.
  for (const auto& [lattice, z, lambda] :
       {std::tuple{simple_cubic(), 6, 4.0}, {body_centred(), 8, 16.0 / 3}, {face_centred(), 12, 8.0}}) {
    const System system(make_lattice(lattice, {.kn = 1, .ks = 0}, {4, 4, 4}));
    EXPECT_NEAR(estimate("diagonal", system), 1 / std::sqrt(z / 3.0), 1e-8) << lattice.name;
    EXPECT_NEAR(estimate("block-bound", system), 2 / std::sqrt(lambda), 1e-8) << lattice.name;
    EXPECT_NEAR(estimate("nodal", system), std::sqrt(2.0 / z), 1e-8) << lattice.name;
    EXPECT_NEAR(estimate("coordination", system), std::sqrt(2.0 / z), 1e-8) << lattice.name;
    // Each contact has 1/z of either ball: λ = 2 z k/m.
    EXPECT_NEAR(estimate("element-equal", system), std::sqrt(2.0 / z), 1e-8) << lattice.name;
    EXPECT_NEAR(estimate("element-best", system), std::sqrt(2.0 / z), 1e-8) << lattice.name;
  }
}

TEST(EstimatesOfLattices, DiagonalIsRootTwoBelowTheTruthWhereRotationGoverns) {
  const System system(make_lattice(face_centred(), {.kn = 1, .ks = 1}, {2, 2, 2}));
  const double truth = 2 / std::sqrt(40.0);
  EXPECT_NEAR(estimate("diagonal", system), std::sqrt(0.5) * truth, exact);
  EXPECT_NEAR(estimate("diagonal-rotation", system), std::sqrt(0.5) * truth, exact);
  EXPECT_NEAR(estimate("yade-global-stiffness", system), 1.41044 * std::sqrt(0.5) * truth, exact);
  EXPECT_NEAR(estimate("lanczos-40", system), truth, 1e-6);
}

TEST(EstimatesOfSelfImages, KnowThatOnlyRotationIsLeft) {
  // One ball in a periodic row of itself: λ = 20/2 k_s/m by (R_a - R_b) × θ = 2 θ: 4 k_s/I.
  SceneBuilder builder({.kn = 1, .ks = 1});
  builder.ball(Vec3::Constant(0.5)).periodic({2 * (1 - 1e-12), 9, 9}, {true, false, false});
  const System system(builder);
  ASSERT_NEAR(dense_truth(system), 2 / std::sqrt(10.0), exact);
  for (const char* name : {"block-bound", "element-equal", "element-best", "contact-space", "gershgorin",
                           "gershgorin-symmetric", "lanczos-10"})
    EXPECT_NEAR(estimate(name, system), 2 / std::sqrt(10.0), exact) << name;
}

TEST(Estimates, AreLeftOutWithAReasonWhereASceneHasThemNot) {
  const auto reason = [](std::string_view name, const SceneBuilder& builder, bool with_materials) {
    const System system(builder);
    SceneBuilder copy = builder;
    const auto& materials = copy.scene().materials;
    return answer_of(*timestep::find_estimator(name), system,
                     with_materials ? std::span<const model::Material>(materials)
                                    : std::span<const model::Material>{})
        .left_out;
  };
  const SceneBuilder plain = pair_along(oblique, {});
  EXPECT_EQ(reason("rayleigh", plain, true),
            "material grain has no young and poisson, of which a Rayleigh wave is made");
  EXPECT_EQ(reason("p-wave", plain, false), "no materials are given");
  SceneBuilder held;
  held.ball(Vec3::Zero()).ball({1.99, 0, 0}, 1, 1, model::FixedComponents(2));
  EXPECT_NE(reason("diagonal-turned", held, true).find("fixed"), std::string::npos);
  EXPECT_EQ(reason("diagonal-turned", plain, true), "");
  SceneBuilder disks = plain;
  disks.scene().bodies.inertia[0] = 0.5;  // ½ m R²
  EXPECT_NE(reason("p-wave-of-stiffness", disks, true).find("no sphere"), std::string::npos);
  EXPECT_EQ(reason("p-wave-of-stiffness", plain, true), "");
}

TEST(Estimates, OfModuliAreWavesThroughTheSmallestBall) {
  SceneBuilder builder = pair_along(oblique, {});
  builder.scene().materials[0] = {.name = "glass", .density = 2500, .young = 70e9, .poisson = 0.25};
  const System system(builder);
  const auto& materials = builder.scene().materials;
  EXPECT_NEAR(estimate("p-wave", system, materials), std::sqrt(2500 / 70e9), 1e-15);
  // G = 28e9, π √(ρ/G)/(0.040775 + 0.8766)
  EXPECT_NEAR(estimate("rayleigh", system, materials), 1.0232787623505e-3, 1e-15);
}

TEST(Estimates, AreInfiniteWhereNothingResists) {
  SceneBuilder builder({.kn = 1, .ks = 0});
  builder.ball(Vec3::Zero()).ball({5, 0, 0});
  const System system(builder);
  for (const timestep::Estimator& estimator : timestep::estimators()) {
    const timestep::Answer answer = answer_of(estimator, system);
    if (answer.left_out.empty()) {
      EXPECT_TRUE(std::isinf(answer.dt)) << estimator.name;
    }
  }
}

/// Whether an estimate knows the frame is part of what it says of itself.
TEST(Estimates, ThatDoNotDependOnTheFrameAreTheSameInAnother) {
  std::mt19937_64 random(7);
  const SceneBuilder scene = random_cluster(random, 12, {.kn = 1, .ks = 0.4}, 3);
  const System system(scene);
  const System turned(scene.turned(random_rotation(random)));
  ASSERT_EQ(system.elements.size(), turned.elements.size());
  for (const timestep::Estimator& estimator : timestep::estimators()) {
    const timestep::Answer a = answer_of(estimator, system);
    const timestep::Answer b = answer_of(estimator, turned);
    if (!a.left_out.empty()) continue;
    const double change = std::abs(a.dt / b.dt - 1);
    // Other numbers of the same start vector are another start: those of Lanczos are compared in their test.
    if (estimator.name.starts_with("lanczos")) continue;
    if (estimator.name == "diagonal-turned") {
      // The same distribution of which 100 are drawn.
      EXPECT_LT(change, 0.03);
      EXPECT_LT(a.range->least, a.dt);
      EXPECT_LT(a.dt, a.range->largest);
    } else if (estimator.depends_on_frame) {
      EXPECT_GT(change, 1e-4) << estimator.name;
    } else {
      EXPECT_LT(change, 1e-6) << estimator.name;
    }
  }
}

TEST(DiagonalInTurnedFrames, IsThatOfTheTurnedScene) {
  // Least and largest over frames bracket the estimate of scenes that are turned themselves.
  std::mt19937_64 random(12);
  const SceneBuilder scene = random_cluster(random, 8, {.kn = 1, .ks = 0});
  const timestep::Answer answer = answer_of(*timestep::find_estimator("diagonal-turned"), System(scene));
  double mean = 0;
  int outside = 0;
  for (int k = 0; k < 400; ++k) {
    const double dt = estimate("diagonal", System(scene.turned(random_rotation(random))));
    mean += dt / 400;
    outside += dt < answer.range->least || dt > answer.range->largest ? 1 : 0;
  }
  EXPECT_NEAR(answer.dt / mean, 1, 0.01);
  EXPECT_LT(outside, 20);  // of 400 draws some 8 lie outside of the extremes of 100 others
}

}  // namespace
}  // namespace eigengrain::test
