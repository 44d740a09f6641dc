// Bonds through a run: none is lost, those that break are told in one order on any number of threads, and a
// restart goes on to the bit.
#include "eigengrain/assembly/bonds.hpp"
#include "eigengrain/base/parallel.hpp"
#include "eigengrain/io/break_file.hpp"
#include "eigengrain/io/scene_reader.hpp"
#include "eigengrain/io/state_file.hpp"

#include "support/bits.hpp"
#include "support/bonds.hpp"
#include "support/motion.hpp"
#include "unit/io_support.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <fstream>
#include <iterator>
#include <random>
#include <sstream>

namespace eigengrain::test {
namespace {

using assembly::BondBreak;
using assembly::State;
using cycle::Cycle;

/// Everything of an event, to the bit.
std::string text_of(const BondBreak& found) {
  return fmt::format("{} {:a} {} {} {:a} {:a} {:a} {:a} {:a} {:a} {} {}\n", found.step, found.time,
                     found.first, found.second, found.place.x(), found.place.y(), found.place.z(),
                     found.normal.x(), found.normal.y(), found.normal.z(), static_cast<int>(found.mode),
                     found.rule);
}
std::string text_of(const std::vector<BondBreak>& breaks) {
  std::string text;
  for (const BondBreak& found : breaks) text += text_of(found);
  return text;
}

/// A simple cubic block of bonded balls, periodic along x, that is shaken to pieces.
SceneBuilder block(int edge, const model::BondRule& bond) {
  std::mt19937_64 random(5);
  SceneBuilder builder(Springs{.kn = 1, .ks = 0.5, .tension = false});
  for (int k = 0; k < edge; ++k)
    for (int j = 0; j < edge; ++j)
      for (int i = 0; i < edge; ++i)
        builder.ball(2.0 * Vec3(i + 0.5, j + 0.5, k + 0.5))
            .moving(0.02 * random_vector(random), 0.02 * random_vector(random));
  return builder.periodic(Vec3::Constant(2.0 * edge), {true, false, false}).bonded(bond);
}

class Breaks : public testing::TestWithParam<model::BondRule> {};

TEST_P(Breaks, AreTheSameInTheSameOrderOnAnyNumberOfThreads) {
  const auto run = [&](int count) {
    const Threads threads(count);
    Cycle cycle = cycle_of(block(9, GetParam()), 0.3);
    cycle.run(200);
    return cycle.release();
  };
  const State one = run(1);
  // All bonds of the block: along x every ball through the cell, along y and z one fewer.
  const std::int64_t made = 9 * 9 * 9 + 2 * 9 * 9 * 8;
  std::printf("%zu of %lld bonds broke\n", one.breaks.size(), static_cast<long long>(made));
  EXPECT_EQ(std::ssize(one.breaks) + assembly::count_bonds(one.model), made);
  EXPECT_GT(std::ssize(one.breaks), made / 20);
  EXPECT_GT(assembly::count_bonds(one.model), made / 20);
  for (std::size_t k = 1; k < one.breaks.size(); ++k) EXPECT_LE(one.breaks[k - 1].step, one.breaks[k].step);
  for (const int count : {2, 3}) {
    const State many = run(count);
    EXPECT_EQ(text_of(one.breaks), text_of(many.breaks)) << count << " threads";
    EXPECT_EQ(bits_of(one), bits_of(many)) << count << " threads";
  }
}

INSTANTIATE_TEST_SUITE_P(
    OfEveryKind, Breaks,
    testing::Values(
        Cemented{.kn = 1, .ks = 0.5, .tension = 0.012, .shear = 0.012}.rule(),
        Cemented{.kn = 1, .ks = 0.5, .tension = 0.012, .shear = 0.012, .incremental = true}.rule(),
        model::BondRule{.kind = "contact", .parameters = {0.03, 0.03}, .gap = 1e-9}));

TEST(Bonds, HoldWhateverTheListKnows) {
  // Far apart from the start and farther later, with lists made anew all the time: the list's reach is 0.05.
  SceneBuilder builder(Springs{.kn = 1, .tension = false});
  builder.ball({0, 0, 0}).ball({3, 0, 0}).ball({0, 3, 0}).ball({30, 0, 0}).without_law();
  builder.scene().bodies.velocity = {{-0.2, 0, 0}, {0.2, 0, 0}, {0, 0.1, 0}, {1, 0, 0}};
  Cycle cycle = cycle_of(builder.bonded(Cemented{.kn = 0.01, .ks = 0.005, .gap = 1.5}.rule()), 0.1);
  double farthest = 0;
  for (int step = 0; step < 1000; ++step) {
    cycle.step();
    farthest = std::max(farthest, (position_of(cycle.state(), 1) - position_of(cycle.state(), 0)).norm());
    ASSERT_EQ(assembly::count_bonds(cycle.state().model), 2);
  }
  EXPECT_GT(farthest, 5);
  EXPECT_GT(cycle.state().list.rebuilds, 100);
}

TEST(Bonds, OfBothKindsAreMadeWithinTheirGapAndNotBeyond) {
  for (const auto& kind :
       {Cemented{.gap = 0.1}.rule(), model::BondRule{.kind = "contact", .parameters = {9, 9}, .gap = 0.1}}) {
    SceneBuilder builder(Springs{.kn = 1, .tension = false});
    builder.ball({0, 0, 0}).ball({2.1 - 1e-12, 0, 0}).ball({0, 2.1 + 1e-12, 0}).ball({0, 0, 1.9});
    // Two touch or nearly so; the third pair is a hair too far.
    EXPECT_EQ(assembly::count_bonds(builder.bonded(kind).build()), 2) << kind.kind;
  }
}

/// Bonds of every kind between balls that are thrown about, as a scene file has them.
std::string scene_text(bool incremental) {
  std::string text = fmt::format(R"(
materials: [{{name: rock, density: 2500}}, {{name: sand, density: 2500}}]
contacts:
  - {{between: [rock, rock], law: linear, kn: 1e5, ks: 5e4, friction: 0.3,
     bond: {{kind: parallel, kn: 1e9, ks: 5e8, tension: 20 kPa, shear: 20 kPa, gap: 10 um, incremental: {}}}}}
  - {{between: [any, any], law: linear, kn: 1e5, ks: 5e4, friction: 0.3,
     bond: {{kind: contact, tension: 1 N, shear: 1 N, gap: 10 um}}}}
damping: {{local: 0}}
timestep: {{policy: fixed, dt: 20 us}}
run: {{steps: 300}}
balls:
)",
                                 incremental);
  std::mt19937_64 random(9);
  for (int k = 0; k < 4; ++k)
    for (int j = 0; j < 4; ++j)
      for (int i = 0; i < 4; ++i) {
        const Vec3 v = 0.3 * random_vector(random);
        text += fmt::format(
            "  - {{position: [{}, {}, {}], radius: 5 mm, material: {}, velocity: [{}, {}, {}]}}\n", 0.01 * i,
            0.01 * j, 0.01 * k, k < 2 ? "rock" : "sand", v.x(), v.y(), v.z());
      }
  return text;
}

TEST(Bonds, GoOnFromAStateToTheBit) {
  for (const bool incremental : {false, true}) {
    const io::TemporaryFolder folder;
    const model::Scene scene = io::read_scene_text(scene_text(incremental), ".", "scene.yaml");
    const auto policy = fixed_step(2e-5);
    Cycle scout(cycle::start(scene), policy);
    scout.run(300);
    const auto all = scout.take_breaks();
    ASSERT_GT(all.size(), 3U);
    const std::int64_t half = all[all.size() / 2].step;  // in the middle of the breaking
    Cycle whole(cycle::start(scene), policy);
    whole.run(half);
    whole.take_breaks();
    io::write_state(whole.state(), folder.path() / "half.h5");
    whole.run(300 - half);
    const auto late = whole.take_breaks();
    ASSERT_GT(late.size(), 0U);
    Cycle continued(io::read_state(folder.path() / "half.h5"), policy);
    EXPECT_EQ(continued.state().model.bodies.orientation.empty(), incremental);
    continued.run(300 - half);
    EXPECT_EQ(text_of(continued.take_breaks()), text_of(late));
    EXPECT_EQ(bits_of(continued.state()), bits_of(whole.state()));
    EXPECT_GT(assembly::count_bonds(whole.state().model), 0);
  }
}

std::string refusal(const std::filesystem::path& file, const std::string& override_text) {
  try {
    io::read_state(file, std::vector{override_text});
  } catch (const InputError& error) {
    return error.what();
  }
  return {};
}

TEST(Bonds, OfAStateKeepTheirKindAndForm) {
  const io::TemporaryFolder folder;
  const std::filesystem::path file = folder.path() / "bonded.h5";
  io::write_state(cycle::start(io::read_scene_text(scene_text(false), ".", "scene.yaml")), file);
  EXPECT_EQ(refusal(file, "contacts.0.bond.tension=1 MPa"), "");
  EXPECT_THAT(refusal(file, "contacts.0.bond.incremental=true"),
              testing::HasSubstr("contacts[0].bond: another form than that of the bonds of the state; keep"));
  EXPECT_THAT(
      refusal(file, "contacts.0.bond={kind: contact}"),
      testing::HasSubstr("contacts[0].bond: contact; the bonds of a state are those it was started with "
                         "(parallel); keep the kind, or start from the scene"));
}

TEST(Bonds, OfAStateStayWhenDashpotsComeOnAndGo) {
  const io::TemporaryFolder folder;
  const assembly::State before = cycle::start(io::read_scene_text(scene_text(false), ".", "scene.yaml"));
  io::write_state(before, folder.path() / "plain.h5");
  const State damped =
      io::read_state(folder.path() / "plain.h5", std::vector<std::string>{"contacts.1.beta_n=0.2"});
  EXPECT_EQ(assembly::count_bonds(damped.model), assembly::count_bonds(before.model));
  io::write_state(damped, folder.path() / "damped.h5");
  const State plain =
      io::read_state(folder.path() / "damped.h5", std::vector<std::string>{"contacts.1.beta_n=0"});
  EXPECT_EQ(assembly::count_bonds(plain.model), assembly::count_bonds(before.model));
  EXPECT_EQ(shears_of(plain), shears_of(before));
}

std::string contents(const std::filesystem::path& file) {
  std::ifstream input(file);
  return {std::istreambuf_iterator<char>(input), {}};
}

TEST(BreakFile, HoldsEveryBreakOnceThroughARestart) {
  const io::TemporaryFolder folder;
  std::vector<BondBreak> breaks(5);
  for (std::size_t k = 0; k < breaks.size(); ++k) {
    breaks[k].step = static_cast<std::int64_t>(k / 2);  // two at one step
    breaks[k].time = 0.1 * static_cast<double>(k);
    breaks[k].place = Vec3(1, 2, 1.0 / 3);
    breaks[k].mode = k % 2 == 0 ? contact::BreakMode::tension : contact::BreakMode::shear;
  }
  io::BreakFile(folder.path(), "whole.csv").add(breaks);
  io::BreakFile(folder.path(), "parts.csv").add(breaks);
  std::ofstream(folder.path() / "parts.csv", std::ios::app) << "2,0.";  // cut off by a kill
  io::BreakFile(folder.path(), "parts.csv", 1).add(std::span(breaks).subspan(4));
  const std::string text = contents(folder.path() / "whole.csv");
  EXPECT_EQ(contents(folder.path() / "parts.csv"), text);
  EXPECT_THAT(text, testing::StartsWith("step,time [s],ball a,ball b,x [m],y [m],z [m],normal x"));
  EXPECT_THAT(text,
              testing::HasSubstr("\n1,0.30000000000000004,0,0,1,2,0.33333333333333331,0,0,0,shear,0\n"));
}

TEST(BreakFile, RefusesAnotherTable) {
  const io::TemporaryFolder folder;
  folder.write("other.csv", "step,kinetic [J]\n1,2\n");
  EXPECT_THROW(io::BreakFile(folder.path(), "other.csv", 1), InputError);
}

}  // namespace
}  // namespace eigengrain::test
