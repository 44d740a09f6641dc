// A row of bonded balls as a beam of circular section: against Timoshenko's theory in K and in the cycle, and
// rolled up to a circle.
#include "eigengrain/assembly/balance.hpp"
#include "eigengrain/assembly/bonds.hpp"
#include "eigengrain/measures/acting_contacts.hpp"

#include "support/bonds.hpp"
#include "support/motion.hpp"

#include <Eigen/SparseCholesky>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <numbers>

namespace eigengrain::test {
namespace {

constexpr double pi = std::numbers::pi;

/// The beam that is refined: length, radius of its section, moduli.
struct Beam {
  double length = 10;
  double radius = 1;
  double young = 3;
  double shear = 1.2;

  double area() const { return pi * radius * radius; }
  double inertia() const { return 0.25 * area() * radius * radius; }
};

/// n bonds of length d = L/n, with k̄_n = E/d and k̄_s = G/d over the whole section, along x; the first ball is
/// held.
SceneBuilder row(const Beam& beam, int n) {
  const double d = beam.length / n;
  SceneBuilder builder;
  for (int i = 0; i <= n; ++i)
    builder.ball({i * d, 0, 0}, 0.5 * d, 1, i == 0 ? fix_all : model::FixedComponents());
  builder.without_law().bonded(
      {.kind = "parallel",
       .parameters = {beam.radius / (0.5 * d), beam.young / d, beam.shear / d, 1e300, 1e300, 0},
       .gap = 1e-9});
  return builder;
}

/// K⁻¹ f, f one number (6 i + k: force k on the ball of identity i, from 6 i + 3 moments) or all of one kind.
class Statics {
 public:
  explicit Statics(const SceneBuilder& builder)
      : system_(builder), k_(assembly::stiffness_matrix(system_)), solver_(k_) {
    load_ = Eigen::VectorXd::Zero(k_.rows());
  }
  void add_load(int ball, int component, double value) { load_[number(ball, component)] += value; }
  double displacement(int ball, int component) {
    const Eigen::VectorXd x = solver_.solve(load_);
    return x[number(ball, component)];
  }

 private:
  Eigen::Index number(int ball, int component) const {
    const auto& identities = system_.model.bodies.identity;
    const auto body =
        static_cast<std::int32_t>(std::find(identities.begin(), identities.end(), ball) - identities.begin());
    const std::int32_t block =
        component < 3 ? system_.unknowns.translation(body) : system_.unknowns.rotation(body);
    return 3 * block + component % 3;
  }

  System system_;
  Eigen::SparseMatrix<double> k_;
  Eigen::SimplicialLDLT<Eigen::SparseMatrix<double>> solver_;
  Eigen::VectorXd load_;
};

// Tip load P. The joints are the contact points, in the middle between centres: statically determinate, so
// the deflection is exactly Σ P (L - x_j)²/κ + P/k_s = P L³/3EI (1 - 1/4n²) + P L/GA: below Timoshenko's by a
// part 1/4n² of the bending.
TEST(Cantilever, ConvergesToTimoshenkoAtSecondOrder) {
  const Beam beam;
  const double bending = std::pow(beam.length, 3) / (3 * beam.young * beam.inertia());
  const double sliding = beam.length / (beam.shear * beam.area());
  double before = 0;
  for (const int n : {4, 8, 16, 32, 64}) {
    Statics statics(row(beam, n));
    statics.add_load(n, 2, 1);
    const double tip = statics.displacement(n, 2);
    const double error = 1 - tip / (bending + sliding);
    std::printf("%3d bonds: tip %.8f of Timoshenko's, error %.3e (order %.3f)\n", n, 1 - error, error,
                std::log2(before / error));
    // Rounding: condition of order n⁴.
    EXPECT_NEAR(tip, bending * (1 - 0.25 / (n * n)) + sliding, 1e-14 * std::pow(n, 4) * tip);
    if (n > 4) {
      EXPECT_NEAR(std::log2(before / error), 2, 1e-3);
    }
    before = error;
  }
}

// Axial load and torque have no error: L/EA and L/GJ.
// Bonds that nothing has stretched yet bear nothing, and gravity pulls.
TEST(Cantilever, IsNotInBalanceBeforeItBends) {
  SceneBuilder row;
  row.ball({0, 0, 0}, 1, 1, fix_all).ball({2, 0, 0}).ball({4, 0, 0});
  row.without_law().bonded(Cemented{}.rule()).gravity({0, 0, -1e-3});
  const assembly::State state = cycle::start(row.scene());
  const assembly::Balance balance = assembly::balance_of(state);
  EXPECT_EQ(balance.bodies, 2);
  EXPECT_EQ(balance.mean, 1);
  // One bond holds all six components: nobody rattles.
  const auto contacts = measures::acting_contacts(state.model);
  const auto loose = measures::rattlers(state.model, contacts, measures::least_contacts(state.model));
  EXPECT_EQ(std::count(loose.begin(), loose.end(), true), 0);
}

TEST(Cantilever, StretchesAndTwistsAsABar) {
  const Beam beam;
  constexpr int n = 16;
  Statics pulled(row(beam, n));
  pulled.add_load(n, 0, 1);
  EXPECT_NEAR(pulled.displacement(n, 0) / (beam.length / (beam.young * beam.area())), 1, 1e-12);
  Statics twisted(row(beam, n));
  twisted.add_load(n, 3, 1);
  EXPECT_NEAR(twisted.displacement(n, 3) / (beam.length / (beam.shear * 2 * beam.inertia())), 1, 1e-12);
}

// Under its own weight, by the cycle with local damping: the equilibrium of K, as far as deflections are
// small.
TEST(Cantilever, ComesToRestWhereTheStiffnessMatrixSays) {
  const Beam beam;
  constexpr int n = 8;
  const double g = 1e-7;
  Statics statics(row(beam, n));
  for (int ball = 1; ball <= n; ++ball) statics.add_load(ball, 2, -g);
  const double expected = statics.displacement(n, 2);
  assembly::State start = cycle::start(row(beam, n).gravity({0, 0, -g}).damped(0.7).scene());
  cycle::Cycle cycle(std::move(start), fixed_step(0.1));
  cycle.run(40000);
  const Vec3 tip = position_of(cycle.state(), n) - Vec3(beam.length, 0, 0);
  std::printf("tip: %.9e in the cycle, %.9e by K\n", tip.z(), expected);
  // Deflections of 1e-5 of the length change the geometry by 1e-10; damping stops at 1e-9 or so.
  EXPECT_NEAR(tip.z() / expected, 1, 1e-6);
}

// Elastica: an end moment bends all joints alike. Rolled up to a full circle the interior balls are in
// equilibrium, without force, and the moment is κ sin φ at a joint's angle φ = 2π/n.
TEST(Cantilever, RollsUpToACircle) {
  const Beam beam;
  constexpr int n = 12;
  assembly::Model model = row(beam, n).build();
  const double phi = 2 * pi / n;
  const double r = 0.5 * beam.length / n;
  Vec3 x = Vec3::Zero();
  for (int i = 0; i <= n; ++i) {
    const Eigen::AngleAxisd turn(i * phi, Vec3::UnitY());
    if (i > 0) x += 2 * r * (Eigen::AngleAxisd((i - 0.5) * phi, Vec3::UnitY()) * Vec3::UnitX());
    const auto row_of_ball =
        static_cast<std::size_t>(std::find(model.bodies.identity.begin(), model.bodies.identity.end(), i) -
                                 model.bodies.identity.begin());
    model.bodies.position[row_of_ball] = x;
    model.bodies.orientation[row_of_ball] = Quat(turn);
  }
  EXPECT_LT(x.norm(), 1e-13);  // closed
  const assembly::BodyForces f = assembly::contact_forces(model);
  const double kappa = beam.young * n / beam.length * beam.inertia();
  for (std::size_t i = 0; i < f.force.size(); ++i) {
    EXPECT_LT(f.force[i].norm(), 1e-13 * kappa);
    const std::int64_t ball = model.bodies.identity[i];
    const double expected = ball == 0 ? kappa * std::sin(phi) : ball == n ? -kappa * std::sin(phi) : 0.0;
    EXPECT_LT((f.moment[i] - Vec3(0, expected, 0)).norm(), 1e-13 * kappa) << ball;
  }
}

}  // namespace
}  // namespace eigengrain::test
