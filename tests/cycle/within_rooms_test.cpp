// Contacts as they can be while bodies stay in their rooms: against the contacts of bodies that are anywhere
// in theirs, and against themselves made anew.
#include "eigengrain/assembly/within_rooms.hpp"

#include "eigengrain/cycle/step_prover.hpp"
#include "eigengrain/io/scene_reader.hpp"

#include "support/dense.hpp"
#include "support/motion.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <limits>
#include <random>
#include <string>
#include <vector>

namespace eigengrain::test {
namespace {

using assembly::WithinRooms;

/// Balls of several sizes that touch, in a cube with sides of so many mm, with their near list.
assembly::State heap(const std::string& law, int side) {
  const std::string box = fmt::format("{{min: [0, 0, 0], max: [{0} mm, {0} mm, {0} mm]}}", side);
  return cycle::start(io::read_scene_text(
      "materials: [{name: grain, density: 2500}]\n"
      "contacts: [{between: [grain, grain], " +
          law +
          "}]\n"
          "balls: [{fill: dense, mean_overlap: 1e-3, sizes: {distribution: uniform, min: 3 mm, max: 7 mm}, "
          "seed: 3, material: grain, box: " +
          box +
          "}]\n"
          "walls: [{box: " +
          box + ", material: grain}]\n",
      "."));
}

const std::vector<std::string> laws{"law: linear, kn: 1e5, ks: 5e4, friction: 0.5, beta_n: 0.2, beta_s: 0.1",
                                    "law: hertz, effective_young: 1e7, effective_shear: 3e6, friction: 0.3"};

double proven_within(const WithinRooms& contacts) {
  std::vector<double> alpha;
  for (const double growth : contacts.growth()) alpha.push_back(growth - 1);
  return cycle::StepProver(contacts.system(), alpha).sharpen(std::numeric_limits<double>::infinity());
}

Vec3 random_direction(std::mt19937_64& random) {
  std::normal_distribution<double> normal;
  return Vec3(normal(random), normal(random), normal(random)).normalized();
}

// Two contacts at a right angle turn towards each other: what is proven without growth() would be too long.
TEST(WithinRooms, CountsTurnsOfContacts) {
  constexpr double room = 0.01;
  const auto ball_in_corner = [](const Vec3& centre) {
    SceneBuilder builder({.kn = 1});
    const model::FixedComponents fixed(63);
    return builder.ball(centre).ball({1.98, 0, 0}, 1, 1, fixed).ball({0, 1.98, 0}, 1, 1, fixed);
  };
  const assembly::Model model = assembly::build_model(ball_in_corner(Vec3::Zero()).scene(), 0.1);
  const WithinRooms contacts(model, model.bodies.position, {room, room, room}, 0);
  const double proven = proven_within(contacts);
  const double unturned =
      cycle::StepProver(contacts.system()).sharpen(std::numeric_limits<double>::infinity());
  std::mt19937_64 random(1);
  double shortest = unturned;
  for (int k = 0; k < 1000; ++k) {
    const double truth = dense_truth(System(ball_in_corner(room * random_direction(random))));
    EXPECT_LE(proven, truth);
    shortest = std::min(shortest, truth);
  }
  EXPECT_LT(shortest, 0.999 * unturned);
}

TEST(WithinRooms, HoldWhereverBodiesAreInThem) {
  std::mt19937_64 random(2);
  for (const std::string& law : laws) {
    assembly::State state = heap(law, 25);
    model::Bodies& bodies = state.model.bodies;
    const std::vector<Vec3> middle = bodies.position;
    std::vector<double> room;
    std::uniform_real_distribution<double> uniform(0, 0.4 * state.list.skin);
    for (std::size_t i = 0; i < middle.size(); ++i) room.push_back(uniform(random));
    const double proven = proven_within(WithinRooms(state.model, middle, room, 0));
    ASSERT_GT(proven, 0);
    for (int k = 0; k < 20; ++k) {
      for (std::size_t i = 0; i < middle.size(); ++i)
        bodies.position[i] = middle[i] + room[i] * random_direction(random);
      EXPECT_LE(proven, dense_limit(assembly::LinearSystem(state.model), {})) << law;
    }
  }
}

bool same(const contact::ContactElement& l, const contact::ContactElement& r) {
  return l.a == r.a && l.b == r.b && l.normal == r.normal && l.lever_a == r.lever_a &&
         l.lever_b == r.lever_b && l.stiffness.normal == r.stiffness.normal &&
         l.stiffness.shear == r.stiffness.shear;
}

TEST(WithinRooms, AreToTheBitWhatTheyAreMadeAnewAfterBodiesGotOthers) {
  std::mt19937_64 random(4);
  for (const std::string& law : laws) {
    const assembly::State state = heap(law, 50);
    std::vector<Vec3> position = state.model.bodies.position;
    std::vector<double> room(position.size(), 1e-6);
    WithinRooms contacts(state.model, position, room, 0);
    std::uniform_int_distribution<std::int32_t> any(0, static_cast<std::int32_t>(position.size()) - 1);
    for (int k = 0; k < 30; ++k) {
      std::vector<std::int32_t> bodies{any(random), any(random)};
      for (const std::int32_t body : bodies) {
        const auto row = static_cast<std::size_t>(body);
        position[row] += 0.02 * state.list.skin * random_direction(random);
        room[row] = 0.01 * state.list.skin * (1 + any(random) % 7);
      }
      const std::vector<contact::ContactElement> before = contacts.system().elements;
      const std::vector<std::int32_t> changed = contacts.move(state.model, bodies, position, room);
      const WithinRooms anew(state.model, position, room, 0);
      ASSERT_EQ(contacts.growth(), anew.growth()) << law;
      for (std::size_t e = 0; e < before.size(); ++e) {
        ASSERT_TRUE(same(contacts.system().elements[e], anew.system().elements[e])) << law << e;
        if (!std::ranges::binary_search(changed, static_cast<std::int32_t>(e))) {
          ASSERT_TRUE(same(contacts.system().elements[e], before[e])) << law << e;
        }
        if (!anew.system().damping.empty()) {
          ASSERT_EQ(contacts.system().damping[e].normal, anew.system().damping[e].normal) << law << e;
        }
      }
    }
  }
}

}  // namespace
}  // namespace eigengrain::test
