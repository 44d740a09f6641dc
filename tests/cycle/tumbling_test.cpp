// What carries the shear force in large rotations: PFC3D's small-angle forms with the geometry at the end of
// the step, exact rotations with that geometry, and exact rotations with the geometry of the middle (the
// default).
#include "eigengrain/assembly/energies.hpp"

#include "support/motion.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <cstdio>
#include <numbers>
#include <string>
#include <vector>

namespace eigengrain::test {
namespace {

using cycle::Cycle;

struct Form {
  const char* name;
  bool small_angle;
  bool end_step;
};
constexpr std::array<Form, 3> forms{{{"small angle, end of step", true, true},
                                     {"exact, end of step", false, true},
                                     {"exact, mid-step", false, false}}};

Springs with(const Form& form, double ks) {
  return {.kn = 1, .ks = ks, .tension = true, .small_angle = form.small_angle, .end_step = form.end_step};
}

/// A pair turned rigidly about an axis through the origin by one step of angle `theta` with what the cycle
/// would hand over: the chord of each centre and the spin. The shear force that comes of it, over k_s.
Vec3 spurious_shear(const Form& form, const Vec3& axis, const Vec3& along, double theta) {
  constexpr double ks = 1;
  SceneBuilder pair(with(form, ks));
  const Vec3 half = along.normalized() * (1 - 1e-12);
  pair.ball(-half).ball(half);
  assembly::State state = cycle::start(pair.scene());
  model::Bodies& bodies = state.model.bodies;
  const Mat3 turn = Eigen::AngleAxisd(theta, axis.normalized()).toRotationMatrix();
  for (std::size_t i = 0; i < 2; ++i) {
    const Vec3 before = bodies.position[i];
    bodies.position[i] = turn * before;
    bodies.velocity[i] = bodies.position[i] - before;
    bodies.spin[i] = theta * axis.normalized();
  }
  assembly::BodyForces sum;
  assembly::ContactForceSum(state.model, true)
      .advance(state.model, {bodies.position, bodies.velocity, bodies.spin, 1.0}, sum);
  return shears_of(state).front() / ks;
}

// Rigid rotation oblique to n: the chord and the geometry at the end differ by half a step, which makes
// -½θ² [w(w·ℓ) - ℓ] across n, of which w_t (w·ℓ) is left: ½Δt²ω(ω·ℓ)_t, ℓ from centre to centre.
TEST(RigidRotation, MakesSpuriousShearOfSecondOrderAtTheEndOfTheStep) {
  const Vec3 axis = Vec3(1, 2, -1).normalized();
  const Vec3 along = Vec3(2, 1, 1).normalized();
  for (const double theta : {1e-2, 1e-3}) {
    const Vec3 n = Eigen::AngleAxisd(theta, axis) * along;
    const Vec3 across = axis - axis.dot(n) * n;
    // δ is that of b against a and F_s = -k_s δ_s.
    const Vec3 expected = 0.5 * theta * theta * axis.dot(2 * n) * across;
    for (const Form& form : {forms[0], forms[1]}) {
      const Vec3 found = spurious_shear(form, axis, along, theta);
      // The next term is θ/3 smaller or so.
      EXPECT_LT((found - expected).norm(), theta * expected.norm()) << form.name << ", theta " << theta;
    }
  }
}

// With the geometry of the middle ℓ₁ - ℓ₀ = 2 tan(θ/2) w × ℓ_mid exactly, against θ w × ℓ_mid of the spin:
// θ³/12 |w × ℓ| is left.
TEST(RigidRotation, MakesSpuriousShearOfThirdOrderInTheMiddleOfTheStep) {
  const Vec3 axis = Vec3(1, 2, -1).normalized();
  const Vec3 along = Vec3(2, 1, 1).normalized();
  const double arm = axis.cross(2 * along).norm();
  for (const double theta : {1e-1, 3e-2}) {
    const double found = spurious_shear(forms[2], axis, along, theta).norm();
    // The next term of the tangent is θ²/10 of it; an ulp of the positions is 1e-16/θ³ = 1e-11 of θ³.
    EXPECT_NEAR(found / (theta * theta * theta / 12 * arm), 1, theta * theta);
  }
}

/// What a full turn in `steps` rigid steps does to a shear force that is there, relative to it: change of the
/// force, which should come back as it was, and of its magnitude.
struct TurnError {
  double force = 0;
  double magnitude = 0;
};

TurnError error_of_a_turn(const Form& form, int steps) {
  const Vec3 axis = Vec3(1, 2, -1).normalized();
  const Vec3 half = Vec3(2, 1, 1).normalized() * (1 - 1e-12);
  SceneBuilder pair(with(form, 0.5));
  pair.ball(-half).ball(half);
  assembly::State state = cycle::start(pair.scene());
  model::Bodies& bodies = state.model.bodies;
  assembly::ContactForceSum forces(state.model, true);
  assembly::BodyForces sum;
  const auto advance = [&] {
    forces.advance(state.model, {bodies.position, bodies.velocity, bodies.spin, 1.0}, sum);
    return shears_of(state).front();
  };
  // Equal spins are opposite ways of the two surfaces.
  for (Vec3& spin : bodies.spin) spin = 1e-2 * Vec3(0, 1, -1);
  const Vec3 before = advance();
  const double theta = 2 * std::numbers::pi / steps;
  const std::vector<Vec3> start = bodies.position;
  Vec3 after = before;
  for (int k = 1; k <= steps; ++k) {
    const Mat3 turn = Eigen::AngleAxisd(k * theta, axis).toRotationMatrix();
    for (std::size_t i = 0; i < 2; ++i) {
      const Vec3 x = turn * start[i];
      bodies.velocity[i] = x - bodies.position[i];
      bodies.spin[i] = theta * axis;
      bodies.position[i] = x;
    }
    after = advance();
  }
  return {(after - before).norm() / before.norm(), std::abs(after.norm() / before.norm() - 1)};
}

// A turn of N steps: the spurious shear of θ² a step adds up to O(θ) a turn and that of θ³ to O(θ²), and the
// exact rotations err by the sphere between a chord and a circle, θ³ a step, as well.
TEST(RigidRotation, OverATurnDriftsAtFirstOrderAtTheEndOfTheStepAndAtSecondInTheMiddle) {
  for (const Form& form : forms) {
    const double order = form.end_step ? 1 : 2;
    TurnError before;
    for (const int steps : {200, 400, 800, 1600}) {
      const TurnError error = error_of_a_turn(form, steps);
      if (steps > 200) {
        const double observed = std::log2(before.force / error.force);
        std::printf("%-24s %4d steps a turn: F_s off by %.2e (order %.2f), |F_s| by %.2e (order %.2f)\n",
                    form.name, steps, error.force, observed, error.magnitude,
                    std::log2(before.magnitude / error.magnitude));
        EXPECT_NEAR(observed, order, 0.1) << form.name;
      }
      before = error;
    }
  }
}

/// A tetrahedron of four that turns as a whole. It starts unstressed, so the centrifugal force makes it
/// vibrate.
class Tumbling {
 public:
  Tumbling(const Form& form, double omega, double steps_a_turn, double shake)
      : steps_(static_cast<int>(steps_a_turn)), cycle_(made(form, omega, steps_, shake)) {}

  /// Mean energy (½ v₋·M v₊ + elastic) over the next turn.
  double energy_of_a_turn() {
    double energy = 0;
    for (int k = 0; k < steps_; ++k) {
      cycle_.step();
      const assembly::Energies energies = assembly::energies_of(cycle_.state());
      energy += (energies.kinetic_product + energies.elastic) / steps_;
    }
    return energy;
  }
  std::vector<Vec3> shears() const { return shears_of(cycle_.state()); }

 private:
  /// shake  spins of two balls against each other, for vibrations of a size of their own
  static Cycle made(const Form& form, double omega, int steps, double shake) {
    SceneBuilder tetrahedron(with(form, 0.5));
    const Vec3 spin = omega * Vec3(1, 2, 3).normalized();
    int sign = 0;
    for (const Vec3& corner : {Vec3(1, 1, 1), Vec3(1, -1, -1), Vec3(-1, 1, -1), Vec3(-1, -1, 1)}) {
      const Vec3 x = corner / std::sqrt(2.0) * (1 - 1e-12);
      const double extra = sign == 0 ? shake : sign == 1 ? -shake : 0.0;
      tetrahedron.ball(x).moving(spin.cross(x), spin + Vec3(0, 0, extra));
      ++sign;
    }
    return cycle_of(tetrahedron, 2 * std::numbers::pi / omega / steps);
  }

  int steps_;
  Cycle cycle_;
};

/// Relative growth of the energy a turn, from the first to the sixth. Not finite where it came apart.
double energy_growth(const Form& form, double omega, double dt, double shake) {
  Tumbling tumbling(form, omega, 2 * std::numbers::pi / omega / dt, shake);
  const double first = tumbling.energy_of_a_turn();
  double last = first;
  for (int turn = 1; turn < 6; ++turn) last = tumbling.energy_of_a_turn();
  return std::pow(last / first, 0.2) - 1;
}

// Undamped and free, a cluster should turn for ever. The spurious shear of the end of the step does work on
// its vibrations, which grow by themselves; the middle of the step keeps the energy.
TEST(Tumbling, KeepsItsEnergyWithMidStepGeometryAlone) {
  struct Case {
    double omega;
    double shake;
  };
  for (const auto& [omega, shake] : {Case{0.02, 0}, Case{0.02, 0.01}, Case{0.1, 0}})
    for (const double dt : {0.4, 0.2, 0.1}) {
      std::array<double, 3> growth{};
      for (std::size_t f = 0; f < forms.size(); ++f) growth[f] = energy_growth(forms[f], omega, dt, shake);
      std::printf(
          "omega %.2f, shake %.2f, dt %.1f: energy a turn %+.2e (seed), %+.2e (exact, end), %+.2e "
          "(default)\n",
          omega, shake, dt, growth[0], growth[1], growth[2]);
      // The default's is that of leapfrog at finite amplitude, Δt² of the vibrations' part and no drift; the
      // others grow at every step size (written so that not-a-number, a cluster that came apart, counts as
      // growth).
      EXPECT_LT(std::abs(growth[2]), 1e-5);
      EXPECT_FALSE(growth[0] < 30 * std::abs(growth[2]));
      EXPECT_FALSE(growth[1] < 30 * std::abs(growth[2]));
      EXPECT_FALSE(growth[0] < 1e-6);
    }
}

double difference(const std::vector<Vec3>& a, const std::vector<Vec3>& b) {
  double sum = 0;
  for (std::size_t i = 0; i < a.size(); ++i) sum += (a[i] - b[i]).squaredNorm();
  return std::sqrt(sum);
}

// Shear forces after one turn of the cluster as it moves by itself, against the limit of small steps.
TEST(Tumbling, ShearAfterATurnConvergesAtSecondOrderWithMidStepGeometryAlone) {
  constexpr double omega = 0.1;
  const auto shears = [&](const Form& form, int steps) {
    Tumbling tumbling(form, omega, steps, 0);
    tumbling.energy_of_a_turn();
    return tumbling.shears();
  };
  const std::vector<Vec3> limit = shears(forms[2], 32000);
  double size = 0;
  for (const Vec3& shear : limit) size += shear.squaredNorm();
  for (const Form& form : forms) {
    double before = 0;
    double last = 0;
    for (const int steps : {1000, 2000, 4000}) {
      const double error = difference(shears(form, steps), limit) / std::sqrt(size);
      const double observed = std::log2(before / error);
      std::printf("%-24s %d steps a turn: shear off by %.2e (order %.2f)\n", form.name, steps, error,
                  observed);
      before = error;
      last = observed;
    }
    // The end of the step has second order terms of the same size at these steps; its order comes down to 1.
    if (form.end_step) {
      EXPECT_LT(last, 1.5) << form.name;
    } else {
      EXPECT_NEAR(last, 2, 0.1) << form.name;
    }
  }
}

}  // namespace
}  // namespace eigengrain::test
