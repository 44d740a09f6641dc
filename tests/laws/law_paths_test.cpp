// A contact of two balls on prescribed paths, through the kinematics of the cycle: what a motion without
// relative motion leaves alone, and how exactly; loading cones; the balance of forces and moments.
#include "eigengrain/assembly/contact_list.hpp"
#include "eigengrain/base/error.hpp"
#include "eigengrain/contact/kinematics.hpp"
#include "eigengrain/contact/laws.hpp"

#include "support/laws.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <numbers>
#include <random>
#include <vector>

namespace eigengrain::contact {
namespace {

using test::values_of;

/// Two balls whose contact is moved step by step and committed.
template <class Law>
class Couple {
 public:
  Couple(const Law& law, const Vec3& branch) : law_(law), position_{Vec3::Zero(), branch} {
    state_ = law_.formed(branch.normalized());
    move({}, {});
  }

  /// Moves the balls by u and turns them by θ in one step.
  void move(const SideMotion& a, const SideMotion& b) {
    position_[0] += a.translation;
    position_[1] += b.translation;
    const Placement placement{position_, radius_, {}, cell_, mass_};
    geometry_ = BallBall::geometry(placement, pair_);
    const ContactMotion motion = motion_for<BallBall>(law_, placement, pair_, geometry_, a, b);
    const typename Law::State old = state_;
    force_ = law_.evaluate(motion, old, state_);
  }
  /// One step of a rigid turn of the whole by the angle about an axis through the middle of the branch.
  void turn(const Vec3& axis, double angle) {
    const Mat3 q = Eigen::AngleAxisd(angle, axis).toRotationMatrix();
    const Vec3 middle = 0.5 * (position_[0] + position_[1]);
    const auto rigid = [&](const Vec3& x) { return SideMotion{q * (x - middle) + middle - x, angle * axis}; };
    move(rigid(position_[0]), rigid(position_[1]));
  }
  /// Shears, rolls and twists the contact a little; the normal stays.
  void load() {
    const Vec3& n = geometry_.normal;
    move({}, {Vec3::Zero(), 0.015 * n.unitOrthogonal() + 0.02 * n});
  }

  const ContactForce& force() const { return force_; }
  const ContactGeometry& geometry() const { return geometry_; }
  const Vec3& position(std::size_t side) const { return position_[side]; }

 private:
  Law law_;
  std::vector<Vec3> position_;
  std::vector<double> radius_{1.0, 0.75};
  std::vector<double> mass_{1.0, 0.5};
  model::PeriodicCell cell_{};
  Pair pair_{0, 1, {}};
  ContactGeometry geometry_{};
  ContactForce force_{};
  typename Law::State state_{};
};

template <class Law>
struct Specimen;
template <>
struct Specimen<Linear> {
  static Linear law() { return Linear({.kn = 2, .ks = 1.5, .friction = 5}); }
};
template <>
struct Specimen<RollingLinear> {
  static RollingLinear law() {
    return RollingLinear::from_values(values_of(
        "linear",
        {{"kn", 2}, {"ks", 1.5}, {"friction", 5}, {"kr", 0.5}, {"rolling_friction", 5}, {"beta_s", 1}}));
  }
};
template <>
struct Specimen<RollingHertz> {
  static RollingHertz law() {
    return RollingHertz::from_values(values_of("hertz", {{"effective_young", 2},
                                                         {"effective_shear", 0.5},
                                                         {"friction", 5},
                                                         {"kr", 0.5},
                                                         {"rolling_friction", 5}}));
  }
};
template <>
struct Specimen<Hysteretic> {
  static Hysteretic law() {
    return Hysteretic::from_values(
        values_of("hysteretic", {{"kn", 2}, {"restitution", 0.5}, {"ks", 1.5}, {"friction", 5}}));
  }
};

template <class Law>
class LawPaths : public testing::Test {
 protected:
  Couple<Law> couple(const Vec3& branch) const { return {Specimen<Law>::law(), branch}; }
};
using Carried = testing::Types<Linear, RollingLinear, RollingHertz, Hysteretic>;
TYPED_TEST_SUITE(LawPaths, Carried);

const Vec3 oblique = 1.5 * Vec3(2, -1, 2).normalized();

// Along axes and by powers of two nothing rounds, so that exactly nothing may change.
TYPED_TEST(LawPaths, ATranslationChangesNothingToTheBit) {
  auto couple = this->couple({0, 0, 1.5});
  couple.load();
  const ContactForce before = couple.force();
  for (const Vec3& u : {Vec3(0.25, 0, 0), Vec3(-1, 0.5, 2), Vec3(0, 0, 0.125)}) {
    couple.move({u, Vec3::Zero()}, {u, Vec3::Zero()});
    EXPECT_EQ(couple.force().force, before.force);
    EXPECT_EQ(couple.force().moment, before.moment);
  }
}

TYPED_TEST(LawPaths, ASpinAboutTheNormalTurnsShearAndMomentExactly) {
  auto couple = this->couple({0, 0, 1.5});
  couple.load();
  const ContactForce before = couple.force();
  double turned = 0;
  for (int k = 0; k < 50; ++k) {
    const double angle = 0.02 * k;  // a radian at most: beyond, Turn is right to 1e-8 alone
    turned += angle;
    couple.move({Vec3::Zero(), angle * Vec3::UnitZ()}, {Vec3::Zero(), angle * Vec3::UnitZ()});
  }
  const Mat3 q = Eigen::AngleAxisd(turned, Vec3::UnitZ()).toRotationMatrix();
  EXPECT_LT((couple.force().force - q * before.force).norm(), 1e-15);
  EXPECT_LT((couple.force().moment - q * before.moment).norm(), 1e-15);
}

/// How far force and moment are from turning rigidly, after one step.
template <class Test>
double error_of_a_turn(const Test& couple_at, double angle) {
  auto couple = couple_at;
  couple.load();
  const ContactForce before = couple.force();
  const Vec3 axis = Vec3(1, 2, 3).normalized();
  couple.turn(axis, angle);
  const Mat3 q = Eigen::AngleAxisd(angle, axis).toRotationMatrix();
  return (couple.force().force - q * before.force).norm() +
         (couple.force().moment - q * before.moment).norm();
}

// The normal goes exactly with the turn, δ is of θ³ (docs/theory.md); the carried force is turned onto the
// new plane and then by the component of θ along the new normal, an error of θ³ too.
TYPED_TEST(LawPaths, ARigidTurnAcrossTheNormalErrsByTheThirdPowerOfItsAngle) {
  const auto couple = this->couple(oblique);
  const double coarse = error_of_a_turn(couple, 0.08);
  const double fine = error_of_a_turn(couple, 0.04);
  EXPECT_GT(coarse, 1e-9);
  EXPECT_LT(coarse, 0.08 * 0.08 * 0.08);
  EXPECT_NEAR(std::log2(coarse / fine), 3, 0.1);
}

// Many small steps: second order in all, and the lengths of shear and moment stay.
TYPED_TEST(LawPaths, AWholeTurnBringsForceAndMomentBack) {
  const auto error = [&](int steps) {
    auto couple = this->couple(oblique);
    couple.load();
    const ContactForce before = couple.force();
    for (int k = 0; k < steps; ++k) couple.turn(Vec3(1, 2, 3).normalized(), 2 * std::numbers::pi / steps);
    return (couple.force().force - before.force).norm() + (couple.force().moment - before.moment).norm();
  };
  const double coarse = error(200);
  const double fine = error(400);
  EXPECT_LT(coarse, 0.01);
  EXPECT_NEAR(std::log2(coarse / fine), 2, 0.1);
}

TYPED_TEST(LawPaths, BalanceForcesAndMomentsOnBothSides) {
  auto couple = this->couple(oblique);
  for (int k = 0; k < 3; ++k) {
    couple.load();
    const EndForces ends = end_forces(couple.geometry(), couple.force());
    EXPECT_EQ(ends.force_a, -ends.force_b);
    const Vec3 moment = ends.moment_a + ends.moment_b + couple.position(0).cross(ends.force_a) +
                        couple.position(1).cross(ends.force_b);
    EXPECT_LT(moment.norm(), 4e-16);
  }
}

// At constant overlap shear and moment are linear, whatever the law of the normal force.
TYPED_TEST(LawPaths, ASquareOfShearReturnsToZero) {
  auto couple = this->couple({0, 0, 1.5});
  // Along the plane of contact and back; the balls turn under their centres, so that n stays.
  const auto slide = [&](double x, double y) {
    couple.move({Vec3::Zero(), Vec3(-y, x, 0)}, {Vec3::Zero(), Vec3(-y, x, 0)});
  };
  slide(0.01, 0);
  EXPECT_GT((couple.force().force - couple.force().force.z() * Vec3::UnitZ()).norm(), 1e-3);
  slide(0, 0.01);
  slide(-0.01, 0);
  slide(0, -0.01);
  EXPECT_LT((couple.force().force - couple.force().force.z() * Vec3::UnitZ()).norm(), 1e-16);
}

/// One step of a contact along z.
template <class Law>
ContactForce step(const Law& law, typename Law::State& state, double overlap, const Vec3& displacement,
                  const Vec3& rotation = Vec3::Zero()) {
  const typename Law::State old = state;
  return law.evaluate({.normal = Vec3::UnitZ(),
                       .overlap = overlap,
                       .displacement = displacement,
                       .rotation = rotation,
                       .reduced_radius = 0.5},
                      old, state);
}

// What remains in a plane tilted by θ is cos θ of what lies along the tilt; a spin about n turns nothing.
TEST(Projected, ShearIsShortenedByTheCosineOfTheTiltAndKnowsNoSpin) {
  const Linear law({.kn = 2, .ks = 1, .friction = 5, .shear = {.projected = true}});
  Linear::State state = law.formed(Vec3::UnitZ());
  step(law, state, 0.1, {-0.05, -0.02, 0});
  const double theta = 0.1;
  ContactMotion motion{.normal = {std::sin(theta), 0, std::cos(theta)}, .overlap = 0.1, .spin = 0.3};
  Linear::State next;
  law.evaluate(motion, state, next);
  const Vec3 along(std::cos(theta), 0, -std::sin(theta));
  EXPECT_NEAR(next.shear.dot(along), 0.05 * std::cos(theta), 1e-17);
  EXPECT_NEAR(next.shear.y(), 0.02, 1e-17);
  EXPECT_NEAR(next.shear.dot(motion.normal), 0, 1e-17);
}

// Shear at constant overlap, up the cone, along it, and back: F_s = min(k_s s, μ F_n), then down with k_s.
TEST(LoadingCone, OfHertzianShear) {
  const Hertz law = Hertz::from_values(
      values_of("hertz", {{"effective_young", 3}, {"effective_shear", 0.25}, {"friction", 0.2}}));
  Hertz::State state = law.formed(Vec3::UnitZ());
  constexpr double overlap = 0.02;
  const double normal = 4.0 / 3 * 3 * std::sqrt(0.5) * std::pow(overlap, 1.5);
  const double ks = 8 * 0.25 * std::sqrt(0.5 * overlap);
  constexpr double way = 0.001;
  for (int k = 1; k <= 20; ++k) {
    const ContactForce f = step(law, state, overlap, {way, 0, 0});
    EXPECT_NEAR(f.force.z(), normal, 1e-16);
    EXPECT_NEAR(f.force.x(), -std::min(ks * k * way, 0.2 * normal), 1e-16);
  }
  EXPECT_NEAR(step(law, state, overlap, {-way, 0, 0}).force.x(), -(0.2 * normal - ks * way), 1e-16);
}

// Sheared at a large overlap and released at a small one: with F_s kept the contact would give back F²/2k_s
// at the small overlap for F²/2k_s at the large one, more than it took. Rescaled it gives less.
TEST(Hertz, GivesBackNoMoreThanItTookWhenItUnloadsUnderShear) {
  const Hertz law = Hertz::from_values(
      values_of("hertz", {{"effective_young", 3}, {"effective_shear", 0.25}, {"friction", 10}}));
  Hertz::State state = law.formed(Vec3::UnitZ());
  const double large = 0.04;
  const double small = 0.01;
  const auto ks = [](double overlap) { return 8 * 0.25 * std::sqrt(0.5 * overlap); };
  constexpr int steps = 1000;
  constexpr double way = 0.004;
  double took = 0;
  step(law, state, large, Vec3::Zero());
  double before = 0;
  for (int k = 0; k < steps; ++k) {
    const double now = -step(law, state, large, {way / steps, 0, 0}).force.x();
    took += 0.5 * (before + now) * way / steps;
    before = now;
  }
  EXPECT_NEAR(took, 0.5 * ks(large) * way * way, 1e-15);
  for (int k = 1; k <= steps; ++k)
    before = -step(law, state, large + (small - large) * k / steps, Vec3::Zero()).force.x();
  // Many steps or one: √(U_2/U_1) in all.
  EXPECT_NEAR(before, ks(small) * way, 1e-15);
  EXPECT_NEAR(before * before / (2 * ks(small)), 0.5 * ks(small) * way * way, 1e-15);
  EXPECT_LT(before * before / (2 * ks(small)), took);
  const double unscaled = ks(large) * way;
  EXPECT_GT(unscaled * unscaled / (2 * ks(small)), took);  // what the rescaling prevents
}

TEST(Hertz, TakesItsParametersFromEquations) {
  const Hertz law = Hertz::from_values(
      values_of("hertz", {{"effective_young", 3}, {"effective_shear", 0.25}, {"friction", 1}}));
  const ContactMotion motion{.normal = Vec3::UnitZ(), .overlap = 0.02, .reduced_radius = 0.5};
  const ContactStiffness k = law.stiffness(motion, law.formed(Vec3::UnitZ()));
  EXPECT_NEAR(k.normal, 2 * 3 * std::sqrt(0.5 * 0.02), 1e-15);
  EXPECT_NEAR(k.shear, 8 * 0.25 * std::sqrt(0.5 * 0.02), 1e-15);
}

TEST(LoadingCone, OfRollingAndTwisting) {
  const RollingLinear law =
      RollingLinear::from_values(values_of("linear", {{"kn", 2}, {"kr", 0.3}, {"rolling_friction", 0.1}}));
  RollingLinear::State state = law.formed(Vec3::UnitZ());
  const Vec3 turn(0.001, 0, 0.002);
  const double limit = 0.1 * 0.5 * 2 * 0.02;  // μ_r R* k_n U
  for (int k = 1; k <= 10; ++k) {
    const ContactForce f = step(law, state, 0.02, Vec3::Zero(), turn);
    const double trial = 0.3 * k * turn.norm();
    EXPECT_LT((f.moment + std::min(trial, limit) * turn.normalized()).norm(), 1e-17);
    EXPECT_EQ(f.force, Vec3(0, 0, 0.04));
  }
}

// Load, unload, load again, and beyond: the corners of the hysteretic triangle.
TEST(Hysteretic, LoadsAndUnloadsAlongItsLines) {
  const Hysteretic law =
      Hysteretic::from_values(values_of("hysteretic", {{"kn", 2}, {"restitution", 0.5}}));  // k_2 = 8
  Hysteretic::State state = law.formed(Vec3::UnitZ());
  const auto force = [&](double overlap) { return step(law, state, overlap, Vec3::Zero()).force.z(); };
  EXPECT_NEAR(force(0.1), 0.2, 1e-16);
  EXPECT_NEAR(force(0.4), 0.8, 1e-16);
  EXPECT_NEAR(force(0.35), 0.4, 1e-15);  // 0.8 - 8·0.05
  EXPECT_NEAR(force(0.2), 0.0, 1e-16);   // U_0 = 0.3
  EXPECT_NEAR(force(0.35), 0.4, 1e-15);
  EXPECT_NEAR(force(0.5), 1.0, 1e-16);
  force(-0.1);
  EXPECT_NEAR(force(0.1), 0.2, 1e-16);  // opened, it has forgotten
}

/// A dashpot contact that moves with a velocity.
ContactForce damped_force(std::string_view law_name, test::Named named, double overlap, const Vec3& shear,
                          const Vec3& velocity) {
  const DampedLinear law = DampedLinear::from_values(values_of(law_name, named));
  DampedLinear::State next;
  ContactMotion motion{
      .normal = Vec3::UnitZ(), .overlap = overlap, .displacement = shear, .reduced_radius = 0.5};
  motion.velocity = velocity;
  motion.reduced_mass = 0.5;
  const ContactForce f = law.evaluate(motion, law.formed(Vec3::UnitZ()), next);
  motion.velocity = Vec3::Zero();
  DampedLinear::State at_rest;
  const Vec3 springs = law.evaluate(motion, law.formed(Vec3::UnitZ()), at_rest).force;
  EXPECT_LT((f.force - springs - next.viscous).norm(), 1e-15);
  EXPECT_EQ(at_rest.viscous, Vec3(0, 0, 0));
  return f;
}

TEST(Dashpots, OpposeTheVelocityWithTwoBetaRootMK) {
  // k_n = 2, k_s = 0.5, m = 1/2: c_n = 2·0.3·1, c_s = 2·0.4·1/2.
  const test::Named named{{"kn", 2}, {"ks", 0.5}, {"friction", 1}, {"beta_n", 0.3}, {"beta_s", 0.4}};
  const Vec3 force = damped_force("linear", named, 0.25, Vec3::Zero(), {1, 0, 2}).force;
  EXPECT_NEAR(force.z(), 0.5 - 0.6 * 2, 1e-15);
  EXPECT_NEAR(force.x(), -0.4 * 1, 1e-15);
  EXPECT_EQ(force.y(), 0);
}

TEST(Dashpots, RestAcrossTheNormalWhileTheContactSlides) {
  const test::Named named{{"kn", 2}, {"ks", 0.5}, {"friction", 0.1}, {"beta_n", 0.3}, {"beta_s", 0.4}};
  const Vec3 force = damped_force("linear", named, 0.25, {1, 0, 0}, {1, 0, 0}).force;
  EXPECT_NEAR(force.x(), -0.1 * 0.5, 1e-16);
}

TEST(Dashpots, NeverPullWithoutTension) {
  const test::Named named{{"kn", 2}, {"beta_n", 0.3}, {"no_tension", 1}};
  EXPECT_EQ(damped_force("linear", named, 0.25, Vec3::Zero(), {0, 0, 2}).force.z(), 0);
  EXPECT_NEAR(damped_force("linear", named, 0.25, Vec3::Zero(), {0, 0, -2}).force.z(), 0.5 + 1.2, 1e-15);
}

TEST(LawTable, TakesThePlainestClassThatServes) {
  const auto group = [](std::string_view law, test::Named named) {
    return assembly::new_group(BallBall::name, {.law = std::string(law), .parameters = values_of(law, named)},
                               0);
  };
  const auto is = [](const AnyGroup& any, auto tag) {
    return std::holds_alternative<ContactGroup<BallBall, typename decltype(tag)::type>>(any);
  };
  EXPECT_TRUE(is(group("linear", {{"kn", 1}}), TypeTag<LinearFrictionless>{}));
  EXPECT_TRUE(is(group("linear", {{"kn", 1}, {"ks", 1}, {"friction", 1}}), TypeTag<Linear>{}));
  EXPECT_TRUE(is(group("linear", {{"kn", 1}, {"beta_n", 1}}), TypeTag<DampedLinear>{}));
  EXPECT_TRUE(is(group("linear", {{"kn", 1}, {"restitution", 0.5}}), TypeTag<DampedLinear>{}));
  EXPECT_TRUE(is(group("linear", {{"kn", 1}, {"kr", 1}}), TypeTag<RollingLinear>{}));
  EXPECT_TRUE(is(group("hertz", {{"effective_young", 1}}), TypeTag<Hertz>{}));
  EXPECT_TRUE(is(group("hertz", {{"effective_young", 1}, {"kr", 1}}), TypeTag<RollingHertz>{}));
  EXPECT_EQ(sizeof(Linear::State), 6 * sizeof(double));
}

// Trailing parameters with defaults may be left out of a rule.
TEST(LawTable, FillsUpWithDefaults) {
  EXPECT_NO_THROW(assembly::new_group(BallBall::name, {.law = "linear", .parameters = {1.0}}, 0));
  EXPECT_THROW(assembly::new_group(BallBall::name, {.law = "linear", .parameters = {}}, 0), InputError);
  EXPECT_THROW(
      assembly::new_group(BallBall::name, {.law = "linear", .parameters = std::vector<double>(20, 1.0)}, 0),
      InputError);
}

}  // namespace
}  // namespace eigengrain::contact
