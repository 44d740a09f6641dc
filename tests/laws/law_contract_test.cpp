#include "eigengrain/contact/dissipation.hpp"
#include "eigengrain/contact/law_table.hpp"
#include "eigengrain/contact/laws.hpp"

#include "support/laws.hpp"

#include <gtest/gtest.h>

#include <array>
#include <functional>
#include <numbers>
#include <random>
#include <vector>

/// What every law owes its callers, checked on prescribed motions of one contact. A new law adds one line to
/// the table of specimens.
namespace eigengrain::contact {
namespace {

using test::values_of;

/// A law with the parameters that the tests try it with.
template <class Law>
struct Specimens;

template <>
struct Specimens<LinearFrictionless> {
  static std::vector<std::vector<double>> values() {
    return {values_of("linear", {{"kn", 2}}), values_of("linear", {{"kn", 2}, {"ks", 1}})};
  }
};
template <>
struct Specimens<Linear> {
  static std::vector<std::vector<double>> values() {
    return {
        values_of("linear", {{"kn", 2}, {"ks", 1.5}, {"friction", 0.3}}),
        values_of("linear", {{"kn", 2}, {"ks", 0.5}, {"friction", 0.8}, {"small_angle", 1}}),
        values_of("linear", {{"kn", 2}, {"ks", 0.5}, {"friction", 0.8}, {"small_angle", 1}, {"end_step", 1}}),
        values_of("linear", {{"kn", 2}, {"ks", 0.5}, {"friction", 0.8}, {"projected", 1}}),
        values_of("linear", {{"kn", 2}, {"ks", 1.5}, {"tension", 1}}),
        values_of("linear", {{"kn", 2}, {"tension", 1}})};
  }
};
template <>
struct Specimens<DampedLinear> {
  static std::vector<std::vector<double>> values() {
    return {
        values_of("linear", {{"kn", 2}, {"ks", 1.5}, {"friction", 0.3}, {"beta_n", 0.2}, {"beta_s", 0.4}}),
        values_of("linear", {{"kn", 2}, {"beta_n", 0.6}, {"no_tension", 1}}),
        values_of("linear", {{"kn", 2}, {"ks", 1.5}, {"tension", 1}, {"restitution", 0.5}})};
  }
};
template <>
struct Specimens<RollingLinear> {
  static std::vector<std::vector<double>> values() {
    return {values_of("linear",
                      {{"kn", 2}, {"ks", 1.5}, {"friction", 0.3}, {"kr", 0.5}, {"rolling_friction", 0.2}}),
            values_of("linear", {{"kn", 2}, {"ks", 1.5}, {"tension", 1}, {"kr", 0.5}, {"beta_n", 0.1}}),
            values_of("linear", {{"kn", 2}, {"kr", 0.5}, {"rolling_friction", 0.3}})};
  }
};
template <>
struct Specimens<Hertz> {
  static std::vector<std::vector<double>> values() {
    return {values_of("hertz", {{"effective_young", 2}, {"effective_shear", 0.4}, {"friction", 0.3}}),
            values_of("hertz", {{"effective_young", 2}, {"beta_n", 0.3}}),
            values_of("hertz", {{"effective_young", 2},
                                {"effective_shear", 0.4},
                                {"friction", 0.6},
                                {"restitution", 0.7},
                                {"beta_s", 0.2}})};
  }
};
template <>
struct Specimens<RollingHertz> {
  static std::vector<std::vector<double>> values() {
    return {values_of("hertz", {{"effective_young", 2},
                                {"effective_shear", 0.4},
                                {"friction", 0.3},
                                {"kr", 0.5},
                                {"rolling_friction", 0.2}})};
  }
};
template <>
struct Specimens<Hysteretic> {
  static std::vector<std::vector<double>> values() {
    return {values_of("hysteretic", {{"kn", 2}, {"restitution", 0.6}, {"ks", 1.5}, {"friction", 0.3}}),
            values_of("hysteretic", {{"kn", 2}, {"restitution", 1}})};
  }
};

template <class Law>
class LawContract : public testing::Test {
 protected:
  /// Calls try_one(law) for every specimen.
  template <class TryOne>
  static void for_each_specimen(const TryOne& try_one) {
    for (const std::vector<double>& values : Specimens<Law>::values()) {
      ASSERT_TRUE(Law::serves(values));
      try_one(Law::from_values(values));
    }
  }
};

template <class List>
struct ToTestTypes;
template <class... Laws>
struct ToTestTypes<TypeList<Laws...>> {
  using type = testing::Types<Laws...>;
};
TYPED_TEST_SUITE(LawContract, ToTestTypes<LawTypes>::type);

/// A motion whose displacement and overlap belong together: the sides approach by what the overlap grows.
ContactMotion moved(const Vec3& n, double overlap, const Vec3& displacement,
                    const Vec3& rotation = Vec3::Zero()) {
  return {.normal = n,
          .overlap = overlap - displacement.dot(n),
          .displacement = displacement,
          .rotation = rotation,
          .reduced_radius = 1,
          .reduced_mass = 1};
}

/// A contact that has already been loaded to an overlap, sheared and rolled, in random directions.
template <class Law>
typename Law::State sheared(const Law& law, const Vec3& n, double overlap, std::mt19937_64& random) {
  typename Law::State state = law.formed(n);
  const Vec3 across = n.cross(test::random_vector(random)).normalized();
  const Vec3 rotation = 0.05 * test::random_vector(random);
  law.evaluate(moved(n, overlap, 0.05 * across, rotation), typename Law::State(state), state);
  return state;
}

TYPED_TEST(LawContract, DescribesAllItsParameters) {
  const LawDescription* description = find_law(TypeParam::name);
  ASSERT_NE(description, nullptr);
  for (const auto& values : Specimens<TypeParam>::values())
    EXPECT_EQ(values.size(), description->parameters.size());
  for (const ParameterDescription& p : description->parameters) EXPECT_FALSE(p.description.empty()) << p.name;
}

TYPED_TEST(LawContract, EvaluateIsPure) {
  std::mt19937_64 random(1);
  this->for_each_specimen([&](const TypeParam& law) {
    const Vec3 n = test::random_vector(random).normalized();
    const auto old = sheared(law, n, 0.2, random);
    ContactMotion motion =
        moved(n, 0.2, 0.02 * test::random_vector(random), 0.02 * test::random_vector(random));
    motion.velocity = test::random_vector(random);
    typename TypeParam::State first;
    typename TypeParam::State second;
    const ContactForce f = law.evaluate(motion, old, first);
    law.evaluate(moved(n, 0.1, test::random_vector(random), test::random_vector(random)), old, second);
    const ContactForce again = law.evaluate(motion, old, second);
    EXPECT_EQ(f.force, again.force);
    EXPECT_EQ(f.moment, again.moment);
  });
}

TYPED_TEST(LawContract, NoForceWhereItDoesNotAct) {
  this->for_each_specimen([&](const TypeParam& law) {
    typename TypeParam::State next;
    ContactMotion apart{.normal = {0, 0, 1}, .overlap = -0.1, .reduced_radius = 1};
    apart.velocity = {1, 1, 1};
    apart.reduced_mass = 1;
    EXPECT_FALSE(law.acts(apart, typename TypeParam::State{}));
    const ContactForce f = law.evaluate(apart, typename TypeParam::State{}, next);
    EXPECT_EQ(f.force, Vec3(0, 0, 0));
    EXPECT_EQ(f.moment, Vec3(0, 0, 0));
    EXPECT_EQ(law.energy(apart, typename TypeParam::State{}), 0.0);
  });
}

TYPED_TEST(LawContract, PushesApartAlongTheNormal) {
  this->for_each_specimen([&](const TypeParam& law) {
    typename TypeParam::State next;
    const ContactMotion pressed = moved({0, 1, 0}, 0.1, Vec3::Zero());
    EXPECT_GT(law.evaluate(pressed, law.formed(pressed.normal), next).force.y(), 0);
  });
}

TYPED_TEST(LawContract, DoesNotKnowTheFrame) {
  std::mt19937_64 random(2);
  this->for_each_specimen([&](const TypeParam& law) {
    const Vec3 n = test::random_vector(random).normalized();
    const Vec3 n_next = (n + 0.01 * test::random_vector(random)).normalized();
    const Vec3 shift = 0.05 * n.cross(test::random_vector(random));
    const Vec3 delta = 0.02 * test::random_vector(random);
    const Vec3 roll = 0.02 * test::random_vector(random);
    const Vec3 velocity = test::random_vector(random);
    const double spin = 0.01 * test::random_vector(random).x();
    const auto force = [&](const Mat3& frame) {
      typename TypeParam::State sheared_state = law.formed(frame * n);
      law.evaluate(moved(frame * n, 0.2, frame * shift, frame * roll), law.formed(frame * n), sheared_state);
      typename TypeParam::State next;
      ContactMotion motion = moved(frame * n_next, 0.2, frame * delta, frame * roll);
      motion.spin = spin;
      motion.velocity = frame * velocity;
      return law.evaluate(motion, sheared_state, next);
    };
    const ContactForce straight = force(Mat3::Identity());
    for (int k = 0; k < 100; ++k) {
      const Mat3 q = test::random_rotation(random);
      const ContactForce turned = force(q);
      // Of k_n R = 2: sums of some ten roundings of numbers of order one.
      EXPECT_LT((q * straight.force - turned.force).norm(), 2e-14);
      EXPECT_LT((q * straight.moment - turned.moment).norm(), 2e-14);
    }
  });
}

/// Forward, backward and central differences of force or moment, with respect to displacement or rotation.
struct Differences {
  Mat3 central;
  bool smooth = true;  ///< no kink in between: forward and backward are alike
};

template <class Law, class Part>
Differences differences(const Law& law, const typename Law::State& old, const Part& part,
                        const std::function<ContactMotion(const Vec3&)>& motion) {
  constexpr double h = 1e-6;
  Differences result;
  typename Law::State next;
  const Vec3 here = part(law.evaluate(motion(Vec3::Zero()), old, next));
  for (int k = 0; k < 3; ++k) {
    const Vec3 plus = part(law.evaluate(motion(h * Vec3::Unit(k)), old, next));
    const Vec3 minus = part(law.evaluate(motion(-h * Vec3::Unit(k)), old, next));
    result.central.col(k) = -(plus - minus) / (2 * h);
    // A curvature of order ten makes a difference of 1e-5; a change of branch one of order one.
    result.smooth = result.smooth && (plus + minus - 2 * here).norm() / h < 1e-3;
  }
  return result;
}

TYPED_TEST(LawContract, TangentIsTheDerivativeOfTheForce) {
  std::mt19937_64 random(3);
  const auto force = [](const ContactForce& f) { return f.force; };
  const auto moment = [](const ContactForce& f) { return f.moment; };
  int tried = 0;
  int kinks = 0;
  this->for_each_specimen([&](const TypeParam& law) {
    // Small displacements stick, large ones slip; half of all unload; every branch is met.
    for (const double size : {0.001, 0.01, 0.3, 1.0})
      for (int k = 0; k < 40; ++k) {
        const Vec3 n = test::random_vector(random).normalized();
        const auto old = sheared(law, n, 0.5, random);
        const Vec3 delta = 0.1 * size * test::random_vector(random);
        const Vec3 roll = size * test::random_vector(random);
        const auto shifted = [&](const Vec3& step) { return moved(n, 0.5, delta + step, roll); };
        const auto turned = [&](const Vec3& step) { return moved(n, 0.5, delta, roll + step); };
        const ContactTangent found = law.tangent(shifted(Vec3::Zero()), old);
        const auto expect = [&](const Mat3& d, const Differences& numbers, const char* what) {
          ++tried;
          if (!numbers.smooth) {
            ++kinks;
            return;
          }
          // Differences of forces of order one over 2e-6: 1e-9 of rounding, and h² of curvature.
          EXPECT_LT((d - numbers.central).cwiseAbs().maxCoeff(), 2e-8) << what << ", size " << size;
        };
        expect(found.translation, differences(law, old, force, shifted), "dF/ddelta");
        expect(found.coupling, differences(law, old, moment, shifted), "dM/ddelta");
        expect(found.rotation, differences(law, old, moment, turned), "dM/dphi");
      }
  });
  EXPECT_LT(kinks, tried / 20);
}

TYPED_TEST(LawContract, StiffnessIsTheTangentOfAStickingContactThatUnloads) {
  this->for_each_specimen([&](const TypeParam& law) {
    const Vec3 n = Vec3(1, 1, -1).normalized();
    typename TypeParam::State pressed;
    law.evaluate(moved(n, 0.11, Vec3::Zero()), law.formed(n), pressed);
    const ContactMotion motion = moved(n, 0.1, Vec3::Zero());
    const ContactStiffness k = law.stiffness(motion, pressed);
    const ContactTangent tangent = law.tangent(motion, pressed);
    EXPECT_EQ(k.translation(n), tangent.translation);
    EXPECT_LT((k.rotation(n) - tangent.rotation).cwiseAbs().maxCoeff(), 1e-16);
    EXPECT_EQ(tangent.coupling, Mat3(Mat3::Zero()));
    EXPECT_EQ(law.needs_rotation(), k.shear > 0 || k.bending > 0 || k.twist > 0);
  });
}

TYPED_TEST(LawContract, EnergyIsTheWorkOfTheForce) {
  std::mt19937_64 random(4);
  this->for_each_specimen([&](const TypeParam& law) {
    // dE = -F·dδ - M·dφ by central differences: along n while it unloads, without shear; across n and in
    // rotation at constant overlap, while it sticks.
    const Vec3 n = test::random_vector(random).normalized();
    typename TypeParam::State pressed;
    law.evaluate(moved(n, 0.5, Vec3::Zero()), law.formed(n), pressed);
    typename TypeParam::State next;
    constexpr double h = 1e-5;
    const auto slope = [&](const Vec3& delta, const Vec3& phi, const Vec3& d_delta, const Vec3& d_phi) {
      const double plus = law.energy(moved(n, 0.5, delta + h * d_delta, phi + h * d_phi), pressed);
      const double minus = law.energy(moved(n, 0.5, delta - h * d_delta, phi - h * d_phi), pressed);
      return -(plus - minus) / (2 * h);
    };
    const Vec3 opening = 0.01 * n;
    // Third derivatives of order one, times h².
    EXPECT_NEAR(slope(opening, Vec3::Zero(), n, Vec3::Zero()),
                law.evaluate(moved(n, 0.5, opening), pressed, next).force.dot(n), 1e-9);
    const Vec3 across = 0.001 * n.cross(test::random_vector(random));
    const Vec3 phi = 0.001 * test::random_vector(random);
    const ContactForce f = law.evaluate(moved(n, 0.5, across, phi), pressed, next);
    for (int k = 0; k < 3; ++k) {
      const Vec3 along = Vec3::Unit(k) - n[k] * n;
      EXPECT_NEAR(slope(across, phi, along, Vec3::Zero()), f.force.dot(along), 1e-9);
      EXPECT_NEAR(slope(across, phi, Vec3::Zero(), Vec3::Unit(k)), f.moment[k], 1e-9);
    }
  });
}

/// All that a law says it has lost.
template <class Law>
double loss(const Law& law, const ContactMotion& motion, const typename Law::State& old,
            const typename Law::State& next) {
  if constexpr (DissipativeLaw<Law>) {
    const Dissipation lost = law.dissipation(motion, old, next);
    return lost.slip + lost.rolling + lost.viscous + lost.hysteresis;
  }
  return 0;
}

/// A smooth random closed path of displacement and rotation, that also unloads and slips.
class ClosedPath {
 public:
  ClosedPath(std::mt19937_64& random, double size) {
    for (Vec3& c : amplitude_) c = size * test::random_vector(random);
  }
  Vec3 displacement(double s) const { return at(s, 0); }
  Vec3 rotation(double s) const { return at(s, 4); }

 private:
  Vec3 at(double s, std::size_t first) const {
    const double a = 2 * std::numbers::pi * s;
    return amplitude_[first] * std::sin(a) + amplitude_[first + 1] * (1 - std::cos(a)) +
           amplitude_[first + 2] * std::sin(2 * a) + amplitude_[first + 3] * (1 - std::cos(3 * a));
  }
  std::array<Vec3, 8> amplitude_;
};

TYPED_TEST(LawContract, TakesMoreWorkThanItStores) {
  std::mt19937_64 random(5);
  this->for_each_specimen([&](const TypeParam& law) {
    for (int path = 0; path < 30; ++path) {
      const ClosedPath way(random, path % 3 == 0 ? 0.003 : 0.05);
      constexpr int steps = 4000;
      const Vec3 n = test::random_vector(random).normalized();
      typename TypeParam::State state = law.formed(n);
      const auto commit = [&](const ContactMotion& motion) {
        const typename TypeParam::State old = state;
        return law.evaluate(motion, old, state);
      };
      ContactForce before = commit(moved(n, 0.5, Vec3::Zero()));
      const double stored = law.energy(moved(n, 0.5, Vec3::Zero()), state);
      double work = 0;
      double lost = 0;
      for (int k = 1; k <= steps; ++k) {
        const double s0 = static_cast<double>(k - 1) / steps;
        const double s1 = static_cast<double>(k) / steps;
        const Vec3 d = way.displacement(s1) - way.displacement(s0);
        const Vec3 phi = way.rotation(s1) - way.rotation(s0);
        ContactMotion motion = moved(n, 0.5 - way.displacement(s0).dot(n), d, phi);
        motion.velocity = 0.5 * steps * d;
        const typename TypeParam::State old = state;
        const ContactForce now = commit(motion);
        lost += loss(law, motion, old, state);
        work -= 0.5 * (before.force + now.force).dot(d) + 0.5 * (before.moment + now.moment).dot(phi);
        before = now;
        const double gained =
            law.energy(moved(n, 0.5 - way.displacement(s1).dot(n), Vec3::Zero()), state) - stored;
        // The trapezoidal rule errs by 1/12 k'' d³ a step, in all some 1e-9; where a branch changes within a
        // step by up to 1/8 k d², 1e-7 each.
        ASSERT_GT(work - gained, -1e-6) << "path " << path << ", step " << k;
        ASSERT_NEAR(work - gained, lost, 1e-6) << "path " << path << ", step " << k;
      }
    }
  });
}

TYPED_TEST(LawContract, KeepsToTheCoulombCone) {
  std::mt19937_64 random(6);
  for (const std::vector<double>& values : Specimens<TypeParam>::values()) {
    const TypeParam law = TypeParam::from_values(values);
    const auto value = [&](std::string_view name) {
      for (std::size_t k = 0; k < values.size(); ++k)
        if (TypeParam::parameters[k].name == name) return values[k];
      return 0.0;
    };
    if (value("tension") != 0) continue;
    for (int k = 0; k < 200; ++k) {
      const Vec3 n = test::random_vector(random).normalized();
      const auto old = sheared(law, n, 0.5, random);
      const ContactMotion motion =
          moved(n, 0.5, 0.1 * test::random_vector(random), test::random_vector(random));
      if (motion.overlap <= 0) continue;
      typename TypeParam::State next;
      const ContactForce f = law.evaluate(motion, old, next);
      const double normal = f.force.dot(n);
      const double shear = (f.force - normal * n).norm();
      EXPECT_LE(shear, value("friction") * normal * (1 + 1e-14) + 2e-15);
      EXPECT_LE(f.moment.norm(), value("rolling_friction") * normal * (1 + 1e-14) + 2e-15);
    }
  }
}

// At constant overlap the trapezoidal rule is exact for springs, slip and dashpots: what the contact stores
// and dissipates is the work done on it.
TYPED_TEST(LawContract, DissipatesTheRestOfTheWork) {
  using State = typename TypeParam::State;
  std::mt19937_64 random(5);
  this->for_each_specimen([&](const TypeParam& law) {
    for (const double size : {0.001, 0.05, 0.5})
      for (int k = 0; k < 20; ++k) {
        const Vec3 n = test::random_vector(random).normalized();
        State old = sheared(law, n, 0.5, random);
        ContactMotion motion =
            moved(n, 0.5, size * n.cross(test::random_vector(random)), size * test::random_vector(random));
        const ContactMotion rest = moved(n, 0.5, Vec3::Zero());
        State next;
        State same;
        ContactForce before = law.evaluate(rest, old, same);
        if constexpr (asks_rate<TypeParam>) {
          motion.velocity = 0.3 * motion.displacement;
          old.viscous = 0.1 * n.cross(test::random_vector(random));
          before.force += old.viscous;
        }
        const ContactForce after = law.evaluate(motion, old, next);
        const double lost = loss(law, motion, old, next);
        const double stored = law.energy(rest, next) - law.energy(rest, old);
        const double work = -0.5 * (before.force + after.force).dot(motion.displacement) -
                            0.5 * (before.moment + after.moment).dot(motion.rotation);
        // Energies of order one, a few ulps each.
        EXPECT_NEAR(stored + lost, work, 1e-14);
        if constexpr (DissipativeLaw<TypeParam>) {
          EXPECT_GE(law.dissipation(motion, old, next).slip, 0);
          EXPECT_GE(law.dissipation(motion, old, next).rolling, 0);
        }
      }
  });
}

// Where it opens it loses what was left in the springs across n, less what these did on the way.
TYPED_TEST(LawContract, LosesItsShearWhereItOpens) {
  using State = typename TypeParam::State;
  std::mt19937_64 random(8);
  this->for_each_specimen([&](const TypeParam& law) {
    const Vec3 n = Vec3::UnitZ();
    const State old = sheared(law, n, 0.5, random);
    const ContactMotion rest = moved(n, 0.5, Vec3::Zero());
    const ContactMotion away{.normal = n, .overlap = -1e-3, .reduced_radius = rest.reduced_radius};
    if (law.acts(away, old)) return;
    State bare = law.formed(n);
    if constexpr (requires { bare.memory; }) bare.memory = old.memory;
    EXPECT_NEAR(loss(law, away, old, State{}), law.energy(rest, old) - law.energy(rest, bare), 1e-14);
  });
}

TEST(Linear, SlipsOnTheCoulombConeAndRemembersIt) {
  const Linear law({.kn = 2, .ks = 1.5, .friction = 0.3});
  const Vec3 n(0, 0, 1);
  Linear::State next;
  const ContactForce f = law.evaluate(moved(n, 0.5, {10, 0, 0}), law.formed(n), next);
  EXPECT_NEAR(f.force.z(), 1.0, 1e-15);
  EXPECT_NEAR(f.force.x(), -0.3, 1e-15);
  EXPECT_NEAR(next.shear.x(), -0.3, 1e-15);
  // Turning back sticks again, from the cone inwards.
  Linear::State back;
  EXPECT_NEAR(law.evaluate(moved(n, 0.5, {-0.1, 0, 0}), next, back).force.x(), -0.15, 1e-15);
}

TEST(Linear, ASquareShearPathReturnsToZero) {
  const Linear law({.kn = 2, .ks = 1.5, .friction = 10});
  const Vec3 n(0, 0, 1);
  Linear::State state = law.formed(n);
  for (const Vec3& side : {Vec3(0.1, 0, 0), Vec3(0, 0.1, 0), Vec3(-0.1, 0, 0), Vec3(0, -0.1, 0)}) {
    Linear::State next;
    law.evaluate(moved(n, 0.5, side), state, next);
    state = next;
  }
  EXPECT_LT(state.shear.norm(), 1e-16);
}

TEST(Linear, ForgetsItsShearWhenItOpens) {
  const Linear law({.kn = 2, .ks = 1.5, .friction = 0.3});
  const Vec3 n(0, 0, 1);
  Linear::State sheared;
  law.evaluate(moved(n, 0.5, {0.1, 0, 0}), law.formed(n), sheared);
  ASSERT_GT(sheared.shear.norm(), 0);
  Linear::State open;
  law.evaluate({.normal = n, .overlap = -0.1}, sheared, open);
  EXPECT_FALSE(open.formed());
  Linear::State again;
  const ContactForce f = law.evaluate({.normal = n, .overlap = 0.1, .displacement = {1, 0, 0}}, open, again);
  EXPECT_EQ(f.force, Vec3(0, 0, 0.2));
}

TEST(Linear, PullsAndNeverSlipsWithTension) {
  const Linear law({.kn = 2, .ks = 1.5, .friction = 0, .tension = true});
  const Vec3 n(0, 0, 1);
  Linear::State next;
  const ContactForce f = law.evaluate(moved(n, 0.0, {1, 0, 0.5}), law.formed(n), next);
  EXPECT_EQ(f.force, Vec3(-1.5, 0, -1.0));
  EXPECT_TRUE(next.formed());
}

TEST(Linear, ShearStiffnessCountsOnlyWithFriction) {
  EXPECT_FALSE(Linear({.kn = 1, .ks = 1, .friction = 0}).needs_rotation());
  EXPECT_TRUE(Linear({.kn = 1, .ks = 1, .friction = 0.1}).needs_rotation());
  EXPECT_TRUE(Linear({.kn = 1, .ks = 1, .friction = 0, .tension = true}).needs_rotation());
}

}  // namespace
}  // namespace eigengrain::contact
