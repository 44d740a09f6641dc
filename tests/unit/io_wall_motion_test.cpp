// How scenes say that walls move, and what they get wrong.
#include "unit/io_support.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>

namespace eigengrain::io {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

std::string scene_with(const std::string& wall, const std::string& rest = "") {
  return "materials: [{name: grain, density: 2500}]\n"
         "contacts: [{between: [any, any], law: linear, kn: 1e5}]\n"
         "balls: [{position: [0.1, 0.1, 0.1], radius: 5 mm, material: grain}]\n"
         "walls: [{material: grain, " +
         wall + "}]\n" + rest;
}

const std::string floor_plane = "plane: {point: [0, 0, -0.5], normal: [0, 0, 1]}, ";

std::vector<std::string> reported(const std::string& wall, const std::string& rest = "",
                                  const std::filesystem::path& folder = ".") {
  return texts_of(mistakes_in(scene_with(wall, rest), {}, folder));
}

TEST(ReadWallMotion, AVelocityIsAMotionWithOneRow) {
  const model::Scene scene =
      read_scene_text(scene_with(floor_plane + "velocity: [0, 0, 10 mm/s], spin: [0, 0, 2]"), ".");
  ASSERT_EQ(scene.wall_motions.size(), 1U);
  const model::WallMotion& motion = scene.wall_motions[0];
  EXPECT_EQ(motion.wall, 0);
  EXPECT_EQ(motion.start, Vec3(0, 0, -0.5));
  EXPECT_EQ(motion.at(7).translation, Vec3(0, 0, 0.01));
  EXPECT_EQ(motion.at(7).spin, Vec3(0, 0, 2));
}

TEST(ReadWallMotion, WallsStandStillWithoutOne) {
  const model::Scene scene = read_scene_text(scene_with(floor_plane + "centre: [1, 2, 3]"), ".");
  EXPECT_THAT(scene.wall_motions, IsEmpty());
  EXPECT_EQ(scene.walls[0].centre, Vec3(1, 2, 3));
}

TEST(ReadWallMotion, TheSidesOfABoxMoveAsOne) {
  const model::Scene scene =
      read_scene_text(scene_with("box: {min: [0, 0, 0], max: [1, 1, 2], open: [+z]}, spin: [0, 0, 1]"), ".");
  ASSERT_EQ(scene.wall_motions.size(), 5U);
  for (std::size_t k = 0; k < 5; ++k) {
    EXPECT_EQ(scene.wall_motions[k].wall, static_cast<std::int32_t>(k));
    EXPECT_EQ(scene.wall_motions[k].start, Vec3(0.5, 0.5, 1));
    EXPECT_EQ(scene.walls[k].centre, Vec3(0.5, 0.5, 1));
  }
}

TEST(ReadWallMotion, RowsStandInTheSceneOrInAFile) {
  const TemporaryFolder folder;
  folder.write("motion.csv", "# time, vx, vy, vz\n0, 0, 0, 0\n\n0.1, 0, 0, -0.5  # down\n 0.2 1 2 3 4 5 6\n");
  const model::Scene file =
      read_scene_text(scene_with(floor_plane + "motion_file: motion.csv"), folder.path());
  const model::Scene rows =
      read_scene_text(scene_with(floor_plane + "motion: [{time: 0}, {time: 100 ms, velocity: [0, 0, -0.5]}, "
                                               "{time: 0.2, velocity: [1, 2, 3], spin: [4, 5, 6]}]"),
                      folder.path());
  for (const model::Scene* scene : {&file, &rows}) {
    ASSERT_EQ(scene->wall_motions.size(), 1U);
    const model::WallMotion& motion = scene->wall_motions[0];
    EXPECT_THAT(motion.time, ElementsAre(0, 0.1, 0.2));
    EXPECT_EQ(motion.velocity[1].translation, Vec3(0, 0, -0.5));
    EXPECT_EQ(motion.velocity[1].spin, Vec3(0, 0, 0));
    EXPECT_EQ(motion.velocity[2].translation, Vec3(1, 2, 3));
    EXPECT_EQ(motion.velocity[2].spin, Vec3(4, 5, 6));
  }
  // A state may be read from any folder.
  EXPECT_THAT(file.document, HasSubstr((folder.path() / "motion.csv").string()));
}

TEST(WallMotionMistakes, MoreThanOneWayToMove) {
  EXPECT_THAT(reported(floor_plane + "velocity: [0, 0, 1], motion: [{time: 0}]"),
              ElementsAre("scene.yaml:4: walls[0]: velocity and spin, motion, motion_file: one of the three "
                          "says how a wall moves; keep one"));
}

TEST(WallMotionMistakes, Rows) {
  EXPECT_THAT(reported(floor_plane + "motion: []"), ElementsAre(HasSubstr("walls[0].motion: no rows")));
  EXPECT_THAT(reported(floor_plane + "motion: [{time: 1}, {time: 1}]"),
              ElementsAre("scene.yaml:4: walls[0].motion[1].time: time 1 s is not above the 1 s of the row "
                          "before; sort the rows by time"));
  EXPECT_THAT(reported(floor_plane + "motion: [{velocity: [0, 0, 1]}]"),
              ElementsAre(HasSubstr("walls[0].motion[0]: time is missing; add e.g. \"time: 100 ms\"")));
  EXPECT_THAT(reported(floor_plane + "velocity: [0, 0, 1 m]"),
              ElementsAre(HasSubstr("walls[0].velocity[2]: \"1 m\" is a length; a velocity is wanted")));
}

TEST(WallMotionMistakes, Files) {
  const TemporaryFolder folder;
  const std::string wall = floor_plane + "motion_file: motion.csv";
  const auto says = [&](const std::string& text) {
    folder.write("motion.csv", text);
    return reported(wall, "", folder.path());
  };
  const std::string file = (folder.path() / "motion.csv").string();
  EXPECT_THAT(reported(wall, "", folder.path()),
              ElementsAre(HasSubstr("walls[0].motion_file: there is no file")));
  EXPECT_THAT(says("# nothing\n"), ElementsAre(HasSubstr("holds no rows; a line is time, vx, vy, vz")));
  EXPECT_THAT(says("time,vx,vy,vz\n0,0,0,0\n"),
              ElementsAre(file + ":1: \"time\" is not a number; columns are plain numbers in SI units, and "
                                 "other lines begin with #"));
  EXPECT_THAT(says("0 0 0 0\n1 0 0\n"), ElementsAre(HasSubstr(file + ":2: 3 columns; four or seven")));
  EXPECT_THAT(says("0 0 0 0\n2 0 0 0\n1 0 0 0\n"),
              ElementsAre(HasSubstr(file + ":3: time 1 s is not above the 2 s of the row before")));
  EXPECT_THAT(says("0 0 0 1m\n"), testing::Contains(HasSubstr(file + ":1: \"1m\" is not a number")));
}

TEST(WallMotionMistakes, PlanesThatTurnOutOfAPeriodicAxis) {
  const std::string cell = "periodic: {box: [1, 1, 1], axes: [x]}\n";
  EXPECT_THAT(reported(floor_plane + "spin: [0, 1, 0]", cell),
              ElementsAre(HasSubstr("walls[0]: the spin (0, 1, 0) rad/s turns the wall out of x, which is "
                                    "periodic")));
  EXPECT_THAT(reported(floor_plane + "spin: [1, 0, 0]", cell), IsEmpty());
  EXPECT_THAT(reported(floor_plane + "spin: [0, 0, 1]", cell), IsEmpty());
  EXPECT_THAT(reported(floor_plane + "spin: [0, 1, 0]"), IsEmpty());
}

}  // namespace
}  // namespace eigengrain::io
