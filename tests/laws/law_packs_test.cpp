// Every law with several contacts at a time, as the cycle evaluates it, against the same law asked contact by
// contact: sums on bodies, and the states that are committed.
#include "eigengrain/assembly/forces.hpp"
#include "eigengrain/contact/state_numbers.hpp"

#include "support/laws.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <random>
#include <string>
#include <type_traits>
#include <vector>

namespace eigengrain::test {
namespace {

using assembly::Model;
using assembly::Trial;

struct Case {
  std::string what;
  SceneBuilder builder;
};

std::vector<Case> cases() {
  const auto linear = [](Named named) { return with_law("linear", named); };
  const auto hertz = [](Named named) { return with_law("hertz", named); };
  return {
      {"frictionless", linear({{"kn", 2}})},
      {"linear", linear({{"kn", 2}, {"ks", 1}, {"friction", 0.3}})},
      {"small angle", linear({{"kn", 2}, {"ks", 1}, {"friction", 0.3}, {"small_angle", 1}})},
      {"end of the step", linear({{"kn", 2}, {"ks", 1}, {"friction", 0.3}, {"end_step", 1}})},
      {"projected", linear({{"kn", 2}, {"ks", 1}, {"friction", 0.3}, {"projected", 1}})},
      {"tension", linear({{"kn", 2}, {"ks", 1}, {"tension", 1}})},
      {"dashpots", linear({{"kn", 2}, {"ks", 1}, {"friction", 0.3}, {"beta_n", 0.2}, {"beta_s", 0.4}})},
      {"no tension", linear({{"kn", 2}, {"beta_n", 3}, {"no_tension", 1}})},
      {"rolling", linear({{"kn", 2}, {"ks", 1}, {"friction", 0.3}, {"kr", 0.5}, {"rolling_friction", 0.1}})},
      {"hertz", hertz({{"effective_young", 2}, {"effective_shear", 0.4}, {"friction", 0.3}})},
      {"hertz without friction", hertz({{"effective_young", 2}, {"restitution", 0.5}})},
      {"rolling hertz", hertz({{"effective_young", 2},
                               {"effective_shear", 0.4},
                               {"friction", 0.3},
                               {"kr", 0.5},
                               {"rolling_friction", 0.1}})},
      {"hysteretic", with_law("hysteretic", {{"kn", 2}, {"restitution", 0.7}, {"ks", 1}, {"friction", 0.3}})},
  };
}

template <class Law>
std::vector<double> numbers(const typename Law::State& state) {
  std::vector<double> result;
  const std::vector<contact::NamedNumbers> parts = contact::numbers_of<Law>(state);
  for (std::size_t k = 0; k < parts.size(); ++k)
    result.insert(result.end(), parts[k].value.begin(),
                  parts[k].value.begin() + Law::state_fields[k].components);
  return result;
}

/// Balls anywhere in a cell so small that some touch their own images, with masses of their own. Near pairs
/// are listed too.
Model crowd(SceneBuilder builder, int balls, std::mt19937_64& random) {
  std::uniform_real_distribution<double> unit(0, 1);
  const double edge = 1.9 * std::cbrt(static_cast<double>(balls));
  builder.periodic({edge, edge, edge});
  for (int k = 0; k < balls; ++k)
    builder.ball(edge * Vec3(unit(random), unit(random), unit(random)), 0.8 + 0.4 * unit(random),
                 1 + unit(random));
  return assembly::build_model(builder.scene(), 0.3);
}

/// States of all contacts as rows of numbers, group after group; by the law alone, after a trial.
std::vector<std::vector<double>> expected_states(const Model& model, const Trial& trial) {
  std::vector<std::vector<double>> result;
  const contact::Placement placement = assembly::placement_in(model, trial);
  model.contacts.for_each_group([&](const auto& group) {
    using Group = std::decay_t<decltype(group)>;
    using Law = typename Group::LawType;
    using Kinematics = typename Group::KinematicsType;
    if constexpr (std::is_same_v<Kinematics, contact::BallBall> && !contact::in_total_form<Law>)
      for (std::size_t c = 0; c < group.pairs.size(); ++c) {
        const contact::ContactGeometry geometry = Kinematics::geometry(placement, group.pairs[c]);
        typename Group::State next{};
        if (group.law.acts(contact::at_rest(geometry), group.states[c]))
          group.law.evaluate(
              assembly::motion_in<Kinematics>(group.law, placement, trial, group.pairs[c], geometry),
              group.states[c], next);
        result.push_back(numbers<Law>(next));
      }
  });
  return result;
}

/// States of all contacts of balls as rows of numbers, group after group.
std::vector<std::vector<double>> states_of(const Model& model) {
  std::vector<std::vector<double>> result;
  model.contacts.for_each_group([&](const auto& group) {
    using Law = typename std::decay_t<decltype(group)>::LawType;
    for (const auto& state : group.states) result.push_back(numbers<Law>(state));
  });
  return result;
}

// Which contacts are evaluated is chosen anew only where bodies may have come near each other since: here
// every sixth step or so, and forces are those of a sum that chooses now, to the bit.
TEST(LawsInPacks, AreTheSameWheneverContactsWereChosen) {
  for (const Case& each : cases()) {
    std::mt19937_64 random(3);
    Model model = crowd(each.builder, 150, random);
    assembly::ContactForceSum kept(model, true);
    std::vector<Vec3> velocity;
    std::vector<Vec3> spin;
    for (std::size_t i = 0; i < model.bodies.position.size(); ++i) {
      velocity.push_back(2e-3 * random_vector(random));
      spin.push_back(0.4 * random_vector(random));
    }
    for (int step = 0; step < 100; ++step) {
      for (std::size_t i = 0; i < velocity.size(); ++i) {
        model.bodies.position[i] += 0.1 * velocity[i];
        model.bodies.radius[i] *= 1 + 1e-5;
      }
      const Trial trial{.position = model.bodies.position,
                        .velocity = velocity,
                        .spin = spin,
                        .duration = 0.1,
                        .per_second = 10};
      Model copy = model;
      assembly::BodyForces expected;
      assembly::ContactForceSum(copy, true).advance(copy, trial, expected);
      assembly::BodyForces found;
      if (step % 30 == 7) kept.evaluate(model, trial, found);  // writes into the same places
      kept.advance(model, trial, found);
      ASSERT_EQ(found.force, expected.force) << each.what << " " << step;
      ASSERT_EQ(found.moment, expected.moment) << each.what << " " << step;
      ASSERT_EQ(states_of(model), states_of(copy)) << each.what << " " << step;
    }
  }
}

TEST(LawsInPacks, AreTheLawsContactByContact) {
  for (const Case& each : cases())
    for (const int balls : {1, 2, 5, 40, 300}) {
      std::mt19937_64 random(static_cast<std::uint64_t>(balls));
      Model model = crowd(each.builder, balls, random);
      const bool turns = balls % 2 == 0 || balls == 5;  // one of the sizes without moments
      assembly::ContactForceSum forces(model, turns);
      int acting = 0;
      // Contacts form, slip, unload and open: 4% of the radius a step, to and fro.
      for (int step = 0; step < 12; ++step) {
        std::vector<Vec3> velocity;
        std::vector<Vec3> spin;
        for (Vec3& x : model.bodies.position) {
          velocity.push_back(0.4 * random_vector(random));
          spin.push_back(0.4 * random_vector(random));
          x += 0.1 * velocity.back();
        }
        const Mat3 cell_step = 0.01 * random_vector(random) * random_vector(random).transpose();
        const Trial trial{.position = model.bodies.position,
                          .velocity = velocity,
                          .spin = spin,
                          .duration = 0.1,
                          .per_second = 10,
                          .cell_step = step % 2 == 0 ? nullptr : &cell_step};
        const std::vector<std::vector<double>> states = expected_states(model, trial);
        assembly::BodyForces expected;
        assembly::ContactForceSum(model, turns).evaluate(model, trial, expected);
        assembly::BodyForces found;
        forces.advance(model, trial, found);
        double scale = 1;
        for (const Vec3& f : expected.force) scale = std::max(scale, f.norm());
        for (std::size_t i = 0; i < expected.force.size(); ++i) {
          acting += expected.force[i].isZero(0) ? 0 : 1;
          // Sums of some twenty forces of order one, each rounded some hundred times.
          EXPECT_LT((found.force[i] - expected.force[i]).norm(), 1e-13 * scale) << each.what << " " << step;
          if (turns) {
            EXPECT_LT((found.moment[i] - expected.moment[i]).norm(), 1e-13 * scale)
                << each.what << " " << step;
          }
        }
        ASSERT_EQ(found.moment.size(), turns ? expected.force.size() : 0);
        std::size_t c = 0;
        model.contacts.for_each_group([&](const auto& group) {
          using Law = typename std::decay_t<decltype(group)>::LawType;
          if constexpr (!contact::in_total_form<Law>)
            for (const auto& state : group.states) {
              const std::vector<double> now = numbers<Law>(state);
              for (std::size_t k = 0; k < now.size(); ++k)
                ASSERT_NEAR(now[k], states[c][k], 1e-13 * scale) << each.what << " " << step;
              ++c;
            }
        });
      }
      EXPECT_GT(acting, balls > 2 ? 12 : -1) << each.what << " " << balls;
    }
}

// A ball that is nowhere does not spoil those that it touched.
TEST(LawsInPacks, LeaveOutWhatIsNotANumber) {
  Model model = with_law("linear", {{"kn", 2}, {"ks", 1}, {"friction", 0.3}})
                    .ball({0, 0, 0})
                    .ball({1.9, 0, 0})
                    .ball({0, 1.9, 0})
                    .build();
  const std::vector<Vec3> still(3, Vec3::Zero());
  assembly::ContactForceSum forces(model, true);
  assembly::BodyForces sum;
  forces.advance(model, Trial{model.bodies.position, still, still, 1.0}, sum);
  const auto lost =
      static_cast<std::size_t>(std::find(model.bodies.identity.begin(), model.bodies.identity.end(), 2) -
                               model.bodies.identity.begin());
  model.bodies.position[lost].setConstant(std::nan(""));
  forces.advance(model, Trial{model.bodies.position, still, still, 1.0}, sum);
  for (std::size_t i = 0; i < 3; ++i) {
    if (i == lost) continue;
    EXPECT_NEAR(sum.force[i].norm(), 0.2, 1e-15);
    EXPECT_TRUE(sum.moment[i].isZero(0));
  }
}

}  // namespace
}  // namespace eigengrain::test
