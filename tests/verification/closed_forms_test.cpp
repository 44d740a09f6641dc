// Spectra in closed form: docs/theory.md lists them with their sources. m = 1, R = 1, I = 2/5.
#include "eigengrain/cycle/bounds.hpp"
#include "eigengrain/timestep/comparison.hpp"
#include "eigengrain/timestep/truth.hpp"

#include "support/lattices.hpp"
#include "support/scenes.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <ostream>

namespace eigengrain::test {
namespace {

using std::numbers::pi;
using timestep::critical_timestep;

double lambda_max(const System& s) {
  const timestep::Truth truth = critical_timestep(s);
  EXPECT_LT(truth.residual, 1e-8);
  return truth.lambda_max;
}

double relative(double value, double expected) {
  return std::abs(value / expected - 1);
}

/// The dense spectrum is the expected one, and the sparse path finds its last eigenvalue.
void expect_spectrum(const System& s, std::vector<double> expected, double tolerance) {
  const Eigen::VectorXd found = s.spectrum();
  std::sort(expected.begin(), expected.end());
  ASSERT_EQ(static_cast<std::size_t>(found.size()), expected.size());
  for (std::size_t k = 0; k < expected.size(); ++k)
    EXPECT_NEAR(found[static_cast<Eigen::Index>(k)], expected[k], tolerance * expected.back());
  EXPECT_LT(relative(lambda_max(s), expected.back()), tolerance);
}

TEST(ClosedForm, TwoSpheres) {
  const double kn = 3;
  const double ks = 1.3;
  const double m1 = 1;
  const double m2 = 2.5;
  const double reduced = 1 / m1 + 1 / m2;
  // At touching, along an oblique axis.
  const Vec3 n = Vec3(1, 2, -2) / 3;
  const System s(SceneBuilder({.kn = kn, .ks = ks}).ball({0, 0, 0}, 1, m1).ball(3 * touching * n, 2, m2));
  // 3.5 ks (1/m1 + 1/m2) twice: ks (1/m1 + 1/m2 + R1²/I1 + R2²/I2) with I = 2/5 m R².
  expect_spectrum(s, {kn * reduced, 3.5 * ks * reduced, 3.5 * ks * reduced, 0, 0, 0, 0, 0, 0, 0, 0, 0},
                  1e-10);
}

TEST(ClosedForm, SphereOnAWall) {
  const System s(SceneBuilder({.kn = 3, .ks = 1.3}).ball({0, 0, touching}, 1, 2).plane({0, 0, 0}, {0, 0, 1}));
  expect_spectrum(s, {1.5, 3.5 * 0.65, 3.5 * 0.65, 0, 0, 0}, 1e-10);
}

/// N balls of mass 1 in a row along `axis`, radius 1.
SceneBuilder row(int n, const Springs& springs, const Vec3& axis = Vec3::UnitX()) {
  SceneBuilder builder(springs);
  for (int i = 0; i < n; ++i) builder.ball(2 * touching * i * axis);
  return builder;
}

TEST(ClosedForm, AxialChains) {
  constexpr int n = 20;
  const double k = 1.7;
  std::vector<double> free_free(2 * n, 0.0);  // the two transverse translations of each ball move freely
  std::vector<double> fixed_fixed(2 * n, 0.0);
  std::vector<double> fixed_free(2 * n, 0.0);
  for (int j = 0; j < n; ++j) {
    free_free.push_back(4 * k * std::pow(std::sin(j * pi / (2 * n)), 2));
    fixed_fixed.push_back(4 * k * std::pow(std::sin((j + 1) * pi / (2 * (n + 1))), 2));
    fixed_free.push_back(4 * k * std::pow(std::sin((2 * j + 1) * pi / (2 * (2 * n + 1))), 2));
  }
  const Vec3 left(-touching, 0, 0);
  const Vec3 right(2 * touching * (n - 1) + touching, 0, 0);
  expect_spectrum(System(row(n, {.kn = k})), free_free, 1e-10);
  expect_spectrum(System(row(n, {.kn = k}).plane(left, {1, 0, 0})), fixed_free, 1e-10);
  expect_spectrum(System(row(n, {.kn = k}).plane(left, {1, 0, 0}).plane(right, {-1, 0, 0})), fixed_fixed,
                  1e-10);
}

TEST(ClosedForm, PeriodicChain) {
  constexpr int n = 12;
  std::vector<double> expected(2 * n, 0.0);
  for (int j = 0; j < n; ++j) expected.push_back(4 * std::pow(std::sin(pi * j / n), 2));
  expect_spectrum(System(make_lattice(chain(), {.kn = 1}, {n, 1, 1})), expected, 1e-10);
}

TEST(ClosedForm, ChainOfTwoMasses) {
  constexpr int cells = 6;
  const double m1 = 1;
  const double m2 = 3;
  SceneBuilder builder({.kn = 1});
  for (int i = 0; i < 2 * cells; ++i) builder.ball({2 * touching * i, 0, 0}, 1, i % 2 == 0 ? m1 : m2);
  builder.periodic({4 * touching * cells, 9, 9}, {true, false, false});
  std::vector<double> expected(std::size_t{4} * cells, 0.0);
  for (int j = 0; j < cells; ++j) {
    const double sine = std::sin(pi * j / cells);  // q, the half-cell phase
    const double mean = 1 / m1 + 1 / m2;
    const double root = std::sqrt(mean * mean - 4 * sine * sine / (m1 * m2));
    expected.push_back(mean + root);
    expected.push_back(mean - root);
  }
  expect_spectrum(System(builder), expected, 1e-10);
}

/// The transverse waves of a periodic chain of n: one zero and (k_s/m)(c0 + c1 cos q) a wave number.
void expect_transverse_chain(double inertia, double c0, double c1) {
  constexpr int n = 12;
  const double ks = 1;
  // Only u_y and θ_z free, so that the axial and the other transverse branch stay out.
  const model::FixedComponents in_plane(0b011101);
  assembly::Model model = make_lattice(chain(), {.kn = 1e-3, .ks = ks}, {n, 1, 1}, in_plane).build();
  for (double& i : model.bodies.inertia) i = inertia;
  std::vector<double> expected(n, 0.0);
  for (int j = 0; j < n; ++j) expected.push_back(ks * (c0 + c1 * std::cos(2 * pi * j / n)));
  expect_spectrum(System(std::move(model)), expected, 1e-10);
}

TEST(ClosedForm, TransverseChainOfSpheres) {
  expect_transverse_chain(0.4, 7, 3);
}
TEST(ClosedForm, TransverseChainOfDisks) {
  expect_transverse_chain(0.5, 6, 2);
}

/// λ_max·m of an infinite lattice in closed form, with k_n = 1, s = k_s/k_n.
struct LatticeCase {
  Lattice lattice;
  std::array<int, 3> cells;  ///< a box that holds the critical wave
  double (*rotation_free)(double s);
  double (*rotation_held)(double s);
};

void PrintTo(const LatticeCase& c, std::ostream* out) {
  *out << c.lattice.name;
}

class LatticeSpectrum : public testing::TestWithParam<LatticeCase> {};

constexpr model::FixedComponents planar_free(0b011100);
constexpr model::FixedComponents planar_held(0b111100);

TEST_P(LatticeSpectrum, HasTheCriticalWave) {
  const LatticeCase& c = GetParam();
  const bool planar = !c.lattice.periodic[2] && c.lattice.periodic[1];
  for (const double s : {0.0, 0.5, 2.0 / 3, 1.0}) {
    const auto free =
        make_lattice(c.lattice, {.kn = 1, .ks = s}, c.cells, planar ? planar_free : model::FixedComponents());
    EXPECT_LT(relative(lambda_max(System(free)), c.rotation_free(s)), 1e-10)
        << c.lattice.name << " s = " << s;
    if (c.rotation_held == nullptr) continue;
    const auto held =
        make_lattice(c.lattice, {.kn = 1, .ks = s}, c.cells, planar ? planar_held : fix_rotations);
    EXPECT_LT(relative(lambda_max(System(held)), c.rotation_held(s)), 1e-10)
        << c.lattice.name << " s = " << s;
  }
}

INSTANTIATE_TEST_SUITE_P(
    InfiniteLattices, LatticeSpectrum,
    testing::Values(LatticeCase{chain(),
                                {4, 1, 1},
                                [](double s) { return std::max(4.0, 10 * s); },
                                [](double s) { return std::max(4.0, 4 * s); }},
                    LatticeCase{square(),
                                {4, 4, 1},
                                [](double s) { return std::max(4 * (1 + s), 20 * s); },
                                [](double s) { return 4 * (1 + s); }},
                    LatticeCase{
                        hexagonal(), {2, 2, 1}, [](double s) { return std::max(6.0, 30 * s); }, nullptr},
                    LatticeCase{simple_cubic(),
                                {2, 2, 2},
                                [](double s) { return std::max(4 * (1 + 2 * s), 20 * s); },
                                [](double s) { return 4 * (1 + 2 * s); }},
                    LatticeCase{body_centred(),
                                {1, 1, 1},
                                [](double s) { return std::max(16. / 3 * (1 + 2 * s), 80. / 3 * s); },
                                [](double s) { return 16. / 3 * (1 + 2 * s); }},
                    LatticeCase{face_centred(),
                                {1, 1, 1},
                                [](double s) { return std::max(8 * (1 + s), 40 * s); },
                                [](double s) { return 8 * (1 + s); }},
                    LatticeCase{diamond(),
                                {1, 1, 1},
                                [](double s) { return std::max(8. / 3 * (1 + 2 * s), 40. / 3 * s); },
                                [](double s) { return 8. / 3 * (1 + 2 * s); }}),
    [](const auto& test) { return test.param.lattice.name; });

TEST(LatticeSpectrum, LargerBoxesHoldNoFasterWave) {
  for (const int n : {1, 2, 3}) {
    const System s(make_lattice(face_centred(), {.kn = 1, .ks = 0.5}, {n, n, n}));
    EXPECT_LT(relative(lambda_max(s), 20.0), 1e-10) << n;
  }
}

TEST(LatticeSpectrum, HexagonalWithRotationHeld) {
  // The critical wave fits the box at s = 0 (λ = 6) and s = 1 (λ = 9); between them it is incommensurate, and
  // a finite box approaches Bloch's value (4/Δt², Δt to five digits) from below as its size grows.
  const auto held = [](double s, int n) {
    return lambda_max(System(make_lattice(hexagonal(), {.kn = 1, .ks = s}, {n, n, 1}, planar_held)));
  };
  EXPECT_LT(relative(held(0.0, 2), 6.0), 1e-10);
  EXPECT_LT(relative(held(1.0, 3), 9.0), 1e-10);
  const double bloch = 4 / (0.75425 * 0.75425);  // s = 1/2; five digits
  EXPECT_LT(held(0.5, 24), bloch * (1 + 1e-5));
  EXPECT_GT(held(0.5, 24), bloch * (1 - 2e-3));
}

TEST(LatticeSpectrum, HexagonalDisks) {
  for (const double s : {0.5, 2.0 / 3, 1.0}) {
    assembly::Model model = make_lattice(hexagonal(), {.kn = 1, .ks = s}, {2, 2, 1}, planar_free).build();
    for (double& inertia : model.bodies.inertia) inertia = 0.5;  // a disk: ½ m R²
    EXPECT_LT(relative(lambda_max(System(model)), std::max(6.0, 24 * s)), 1e-10);
  }
}

TEST(LatticeSpectrum, SpheresThatSpinAlike) {
  // λ = (10/3) z ks/m for the mode in which all spheres of a cubic lattice spin alike: z = 6, 8, 12.
  const double ks = 0.3;
  for (const auto& [lattice, z] :
       {std::pair(simple_cubic(), 6), std::pair(body_centred(), 8), std::pair(face_centred(), 12)}) {
    const System s(make_lattice(lattice, {.kn = 1, .ks = ks}, {2, 2, 2}));
    Eigen::VectorXd spin = Eigen::VectorXd::Zero(s.unknowns.size());
    for (std::int32_t b = 0; b < s.unknowns.blocks(); ++b)
      if (s.unknowns.is_rotation(b)) spin.segment<3>(3 * b) = Vec3(1, 2, 3);
    const Eigen::VectorXd force = assembly::stiffness_matrix(s) * spin;
    const double lambda = 10.0 / 3 * z * ks;
    EXPECT_LT((force - 0.4 * lambda * spin).norm(), 1e-10 * force.norm()) << lattice.name;
  }
}

TEST(Diagonal, OverTheTruthOnLatticesIsTheRootOfOneHalf) {
  for (const Lattice& lattice : {simple_cubic(), body_centred(), face_centred()}) {
    const assembly::Model model = make_lattice(lattice, {.kn = 1, .ks = 1}, {2, 2, 2}).build();
    EXPECT_NEAR(timestep::compare(model).estimates.at(0).ratio_to_true, std::sqrt(0.5), 1e-9) << lattice.name;
  }
}

TEST(Diagonal, IsUnsafeForTheObliquePair) {
  const Vec3 oblique = Vec3(1, 1, 1).normalized();
  const auto ratio = [&](double ks) {
    return timestep::compare(row(2, {.kn = 1, .ks = ks}, oblique).build()).estimates.at(0);
  };
  EXPECT_EQ(ratio(0).name, "diagonal");
  EXPECT_NEAR(ratio(0).ratio_to_true, std::sqrt(1.5), 1e-9);  // √3 √(m/k) over √2 √(m/k): 1.2247
  EXPECT_FALSE(ratio(0).safe);
  EXPECT_NEAR(ratio(1).ratio_to_true, std::sqrt(1.05), 1e-9);  // 1.0247
  EXPECT_FALSE(ratio(1).safe);
}

TEST(Diagonal, IsUnsafeForTheObliqueChain) {
  const Vec3 oblique = Vec3(1, 1, 1).normalized();
  const timestep::Comparison c = timestep::compare(row(60, {.kn = 1}, oblique).build());
  EXPECT_NEAR(c.estimates.at(0).ratio_to_true, std::sqrt(1.5) * std::cos(pi / 120), 1e-9);
}

TEST(Bounds, AreExactForAPairAndACubicLattice) {
  const System pair(row(2, {.kn = 1, .ks = 0.4}, Vec3(1, 1, 1).normalized()));
  const double pair_dt = 2 / std::sqrt(2.8);
  EXPECT_NEAR(cycle::block_bound(pair) / pair_dt, 1, 1e-10);
  const System cubic(make_lattice(simple_cubic(), {.kn = 1, .ks = 0.5}, {2, 2, 2}));
  EXPECT_NEAR(cycle::block_bound(cubic) / (2 / std::sqrt(10)), 1, 1e-10);
}

/// Block bound over the truth.
double bound_ratio(const SceneBuilder& builder) {
  const System s(builder);
  return cycle::block_bound(s) / critical_timestep(s).dt;
}

TEST(Bounds, AreExactWhereOneEndCannotMove) {
  // Counting a wall, a fixed ball or an own image twice would give 1/√2.
  const Springs springs{.kn = 1, .ks = 0.4};
  EXPECT_NEAR(bound_ratio(SceneBuilder(springs).ball({0, 0, 0.9}).plane({0, 0, 0}, {0, 0, 1})), 1, 1e-10);
  EXPECT_NEAR(bound_ratio(SceneBuilder(springs).ball({0, 0, 0}).ball({0, 1.9, 0}, 1, 1, fix_all)), 1, 1e-10);
  EXPECT_NEAR(bound_ratio(SceneBuilder(springs).ball({0, 0, 0}).periodic({1.9, 9, 9})), 1, 1e-10);
}

/// Energy-like size of the leapfrog cycle with local damping (eqs. 1.26, 1.47) of a unit mass on a unit
/// spring after some steps, started with a velocity.
double amplitude_after(double dt, double alpha, int steps) {
  double x = 0;
  double v = 1;
  double largest = 0;
  for (int k = 0; k < steps; ++k) {
    const double force = -x;
    const double sign = v > 0 ? 1 : (v < 0 ? -1 : 0);
    v += dt * (force - alpha * std::abs(force) * sign);
    x += dt * v;
    largest = std::max(largest, std::abs(x));
  }
  return largest;
}

TEST(Limit, IsWhereTheDampedCycleBlowsUp) {
  // One mode, λ = 1: stable just below 2/√(1 + α), unbounded just above.
  for (const double alpha : {0.0, 0.2, 0.7}) {
    const double limit = cycle::damped_timestep(2, alpha);
    EXPECT_LT(amplitude_after(0.999 * limit, alpha, 3000), 100) << alpha;
    EXPECT_GT(amplitude_after(1.001 * limit, alpha, 3000), 1e6) << alpha;
  }
}

TEST(Limit, HasTheFactorOfLocalDamping) {
  const System s(row(3, {.kn = 1}));
  const timestep::Truth truth = critical_timestep(s, 0.7);
  EXPECT_NEAR(truth.limit / truth.dt, 1 / std::sqrt(1.7), 1e-14);  // 0.76697
}

TEST(Truth, IsInfiniteWhereContactsActOnFixedComponentsOnly) {
  const System s(
      SceneBuilder().ball({0, 0, 0.9}, 1, 1, model::FixedComponents(0b000100)).plane({0, 0, 0}, {0, 0, 1}));
  ASSERT_EQ(s.elements.size(), 1U);
  const timestep::Truth truth = critical_timestep(s);
  EXPECT_TRUE(std::isinf(truth.dt));
  EXPECT_EQ(truth.residual, 0.0);
}

TEST(Truth, IsInfiniteWhereNothingTouches) {
  const System s(SceneBuilder().ball({0, 0, 0}).ball({5, 0, 0}));
  EXPECT_TRUE(std::isinf(critical_timestep(s).dt));
  EXPECT_TRUE(std::isinf(cycle::block_bound(s)));
}

}  // namespace
}  // namespace eigengrain::test
