// States with clumps: to a file and back, and on to the bit.
#include "support/restart.hpp"

#include "eigengrain/io/series.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <fstream>
#include <sstream>

namespace eigengrain::test {
namespace {

const char* const heap = R"(
gravity: [0, 0, -9.81]
materials: [{name: grain, density: 2500}]
contacts: [{between: [any, any], law: linear, kn: 1e4, ks: 5e3, friction: 0.4, beta_n: 0.1}]
periodic: {box: [0.06, 0.06, 1], axes: [x, y]}
balls: [{position: [0.05, 0.05, 0.006], radius: 5 mm, material: grain, spin: [0, 3, 0]}]
clumps:
  - balls: [{at: [0, 0, 0], radius: 5 mm}, {at: [6 mm, 0, 0], radius: 4 mm}, {at: [1 mm, 6 mm, 2 mm], radius: 3 mm}]
    material: grain
    instances:
      - {position: [0.02, 0.02, 0.01], velocity: [1, 0, -1], spin: [10, 0, 40], axis: [1, 1, 0], angle: 40 deg}
      - {position: [0.045, 0.02, 0.01], velocity: [-1, 0.3, 0]}
      - {position: [0.059, 0.05, 0.03], spin: [0, 0, 5], fix: [z, wx, wy, wz]}
walls: [{plane: {point: [0, 0, 0], normal: [0, 0, 1]}, material: grain}]
damping: {local: 0.1}
timestep: {policy: bound}
)";

TEST(ClumpRestart, GoesOnToTheBit) {
  expect_to_continue(io::read_scene_text(heap, ".", "heap.yaml"), 1500, {0, 1, 700});
}

TEST(ClumpRestart, KeepsWhatAClumpIs) {
  const io::TemporaryFolder folder;
  cycle::Cycle cycle(cycle::start(io::read_scene_text(heap, ".", "heap.yaml")), fixed_step(1e-5));
  cycle.run(10);
  io::write_state(cycle.state(), folder.path() / "state.h5");
  const assembly::State read = io::read_state(folder.path() / "state.h5");
  const model::Clumps& now = read.model.bodies.clumps;
  const model::Clumps& then = cycle.state().model.bodies.clumps;
  EXPECT_EQ(now.member, then.member);
  EXPECT_EQ(now.starts, then.starts);
  EXPECT_EQ(now.place, then.place);
  EXPECT_EQ(now.inertia, then.inertia);
  EXPECT_EQ(now.mass, then.mass);
  EXPECT_EQ(now.radius, then.radius);
  EXPECT_EQ(now.volume, then.volume);
  EXPECT_EQ(now.of_row, then.of_row);
}

TEST(ClumpRestart, TakesNoOtherClumps) {
  const io::TemporaryFolder folder;
  const auto file = folder.path() / "state.h5";
  io::write_state(cycle::start(io::read_scene_text(heap, ".", "heap.yaml")), file);
  const std::vector<std::string> overrides{"clumps=[]"};
  try {
    io::read_state(file, overrides);
    FAIL();
  } catch (const InputError& error) {
    EXPECT_THAT(error.what(), testing::HasSubstr("a state has its clumps already"));
  }
}

TEST(ClumpSeries, NamesTheClumpOfEachBall) {
  const io::TemporaryFolder folder;
  const assembly::State state = cycle::start(io::read_scene_text(heap, ".", "heap.yaml"));
  io::Series series(folder.path(), "heap");
  series.add(state);
  std::ifstream file(series.frame_file(0), std::ios::binary);
  std::ostringstream text;
  text << file.rdbuf();
  const std::string all = text.str();
  EXPECT_THAT(all, testing::HasSubstr("Name=\"clump\""));
  const std::vector<std::int64_t> expected{-1, 0, 0, 0, 1, 1, 1, 2, 2, 2};
  EXPECT_NE(all.find(std::string(reinterpret_cast<const char*>(expected.data()), expected.size() * 8)),
            std::string::npos);
}

}  // namespace
}  // namespace eigengrain::test
