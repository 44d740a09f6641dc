#include "eigengrain/contact/dissipation.hpp"
#include "eigengrain/contact/law_table.hpp"
#include "eigengrain/contact/laws.hpp"

#include "support/scenes.hpp"

#include <gtest/gtest.h>

#include <random>
#include <vector>

/// What every law owes its callers, checked on prescribed motions of one contact. A new law adds one line to
/// the table of specimens.
namespace eigengrain::contact {
namespace {

/// A law with the parameters that the tests try it with.
template <class Law>
struct Specimens;

template <>
struct Specimens<LinearFrictionless> {
  static std::vector<std::vector<double>> values() {
    return {{2.0, 0.0, 0.0, 0, 0, 0}, {2.0, 1.0, 0.0, 0, 0, 0}};
  }
};
template <>
struct Specimens<Linear> {
  static std::vector<std::vector<double>> values() {
    return {{2.0, 1.5, 0.3, 0, 0, 0},
            {2.0, 0.5, 0.8, 0, 1, 0},
            {2.0, 0.5, 0.8, 0, 1, 1},
            {2.0, 1.5, 0.0, 1, 0, 0},
            {2.0, 0.0, 0.0, 1, 0, 0}};
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
ContactMotion moved(const Vec3& n, double overlap, const Vec3& displacement) {
  return {.normal = n, .overlap = overlap - displacement.dot(n), .displacement = displacement};
}

/// A contact that has already been sheared, in a random direction.
template <class Law>
typename Law::State sheared(const Law& law, const Vec3& n, double overlap, std::mt19937_64& random) {
  typename Law::State state = law.formed(n);
  const Vec3 across = n.cross(test::random_vector(random)).normalized();
  law.evaluate(moved(n, overlap, 0.05 * across), typename Law::State(state), state);
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
    const ContactMotion motion = moved(n, 0.2, 0.02 * test::random_vector(random));
    typename TypeParam::State first;
    typename TypeParam::State second;
    const ContactForce f = law.evaluate(motion, old, first);
    law.evaluate(moved(n, 0.1, test::random_vector(random)), old, second);
    const ContactForce again = law.evaluate(motion, old, second);
    EXPECT_EQ(f.force, again.force);
    EXPECT_EQ(f.moment, again.moment);
  });
}

TYPED_TEST(LawContract, NoForceWhereItDoesNotAct) {
  this->for_each_specimen([&](const TypeParam& law) {
    typename TypeParam::State next;
    const ContactMotion apart{.normal = {0, 0, 1}, .overlap = -0.1};
    EXPECT_FALSE(law.acts(apart, typename TypeParam::State{}));
    EXPECT_EQ(law.evaluate(apart, typename TypeParam::State{}, next).force, Vec3(0, 0, 0));
    EXPECT_EQ(law.energy(apart, typename TypeParam::State{}), 0.0);
  });
}

TYPED_TEST(LawContract, PushesApartAlongTheNormal) {
  this->for_each_specimen([&](const TypeParam& law) {
    typename TypeParam::State next;
    const ContactMotion pressed{.normal = {0, 1, 0}, .overlap = 0.1};
    EXPECT_GT(law.evaluate(pressed, law.formed(pressed.normal), next).force.y(), 0);
  });
}

TYPED_TEST(LawContract, DoesNotKnowTheFrame) {
  std::mt19937_64 random(2);
  this->for_each_specimen([&](const TypeParam& law) {
    const Mat3 q = test::random_rotation(random);
    const Vec3 n = test::random_vector(random).normalized();
    const Vec3 n_next = (n + 0.01 * test::random_vector(random)).normalized();
    const Vec3 shift = 0.05 * n.cross(test::random_vector(random));
    const Vec3 delta = 0.02 * test::random_vector(random);
    const double spin = 0.01 * test::random_vector(random).x();
    const auto force = [&](const Mat3& frame) {
      typename TypeParam::State sheared_state = law.formed(frame * n);
      law.evaluate(moved(frame * n, 0.2, frame * shift), law.formed(frame * n), sheared_state);
      typename TypeParam::State next;
      const ContactMotion motion{
          .normal = frame * n_next, .overlap = 0.2, .displacement = frame * delta, .spin = spin};
      return law.evaluate(motion, sheared_state, next).force;
    };
    EXPECT_LT((q * force(Mat3::Identity()) - force(q)).norm(), 1e-14);
  });
}

/// -dF/dδ by central differences, the overlap moving with δ.
template <class Law>
Mat3 numerical_tangent(const Law& law, const typename Law::State& old, const Vec3& n, double overlap,
                       const Vec3& displacement) {
  constexpr double h = 1e-6;
  Mat3 result;
  for (int k = 0; k < 3; ++k) {
    typename Law::State next;
    const Vec3 step = h * Vec3::Unit(k);
    const Vec3 plus = law.evaluate(moved(n, overlap, displacement + step), old, next).force;
    const Vec3 minus = law.evaluate(moved(n, overlap, displacement - step), old, next).force;
    result.col(k) = -(plus - minus) / (2 * h);
  }
  return result;
}

TYPED_TEST(LawContract, TangentIsTheDerivativeOfTheForce) {
  std::mt19937_64 random(3);
  this->for_each_specimen([&](const TypeParam& law) {
    // Small displacements stick, large ones slip; both branches are met.
    for (const double size : {0.001, 0.01, 0.3, 1.0})
      for (int k = 0; k < 20; ++k) {
        const Vec3 n = test::random_vector(random).normalized();
        const auto old = sheared(law, n, 0.5, random);
        const Vec3 delta = 0.1 * size * test::random_vector(random);
        const ContactMotion motion = moved(n, 0.5, delta);
        const Mat3 expected = numerical_tangent(law, old, n, 0.5, delta);
        // Differences of forces of order one over 2e-6: 1e-9 of rounding, and h² of curvature.
        EXPECT_LT((law.tangent(motion, old).translation - expected).cwiseAbs().maxCoeff(), 2e-8);
      }
  });
}

TYPED_TEST(LawContract, StiffnessIsTheTangentOfAStickingContact) {
  this->for_each_specimen([&](const TypeParam& law) {
    const ContactMotion motion{.normal = Vec3(1, 1, -1).normalized(), .overlap = 0.1};
    const auto state = law.formed(motion.normal);
    EXPECT_EQ(law.stiffness(motion, state).translation(motion.normal),
              law.tangent(motion, state).translation);
    EXPECT_EQ(law.needs_rotation(), law.stiffness(motion, state).shear > 0);
  });
}

TYPED_TEST(LawContract, EnergyIsTheWorkOfTheForce) {
  std::mt19937_64 random(4);
  this->for_each_specimen([&](const TypeParam& law) {
    // Sticking: dE = -F·dδ by central differences of the energy.
    const Vec3 n = test::random_vector(random).normalized();
    const auto old = law.formed(n);
    const Vec3 delta = 0.001 * test::random_vector(random);
    typename TypeParam::State next;
    const Vec3 force = law.evaluate(moved(n, 0.5, delta), old, next).force;
    for (int k = 0; k < 3; ++k) {
      constexpr double h = 1e-5;
      const double plus = law.energy(moved(n, 0.5, delta + h * Vec3::Unit(k)), old);
      const double minus = law.energy(moved(n, 0.5, delta - h * Vec3::Unit(k)), old);
      EXPECT_NEAR(-(plus - minus) / (2 * h), force[k], 1e-9);
    }
  });
}

// At constant overlap the trapezoidal rule is exact for springs and slip: what the contact stores and
// dissipates is the work done on it.
TYPED_TEST(LawContract, DissipatesTheRestOfTheWork) {
  using State = typename TypeParam::State;
  std::mt19937_64 random(5);
  this->for_each_specimen([&](const TypeParam& law) {
    for (const double size : {0.001, 0.05, 0.5})
      for (int k = 0; k < 20; ++k) {
        const Vec3 n = test::random_vector(random).normalized();
        const auto old = sheared(law, n, 0.5, random);
        const ContactMotion motion = moved(n, 0.5, size * n.cross(test::random_vector(random)));
        const ContactMotion rest = moved(n, 0.5, Vec3::Zero());
        State next;
        State same;
        const Vec3 before = law.evaluate(rest, old, same).force;
        const Vec3 after = law.evaluate(motion, old, next).force;
        double lost = 0;
        if constexpr (DissipativeLaw<TypeParam>) lost = law.dissipation(motion, old, next).slip;
        const double stored = law.energy(rest, next) - law.energy(rest, old);
        // Energies of order one, a few ulps each.
        EXPECT_NEAR(stored + lost, -0.5 * (before + after).dot(motion.displacement), 5e-15);
        EXPECT_GE(lost, 0);
      }
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
