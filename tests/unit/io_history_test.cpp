#include "eigengrain/io/history.hpp"

#include "support/states.hpp"
#include "unit/io_support.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstdlib>
#include <sstream>

namespace eigengrain::io {
namespace {

using testing::HasSubstr;

std::string text_of_file(const std::filesystem::path& file) {
  std::ifstream input(file, std::ios::binary);
  std::ostringstream text;
  text << input.rdbuf();
  return text.str();
}

model::History energies_every(std::int64_t every) {
  return {.file = "table.csv", .every = every, .energies = true, .balls = {}};
}

assembly::State ball_at(std::int64_t step) {
  return test::state_of(test::SceneBuilder().ball({0, 0, 1}), step, 0.5 * static_cast<double>(step));
}

HistoryValues kinetic(double joule) {
  return {.energies = {.kinetic = joule}};
}

void run(const std::filesystem::path& folder, const model::History& history, std::int64_t from,
         std::int64_t to, std::optional<std::int64_t> restart = {}) {
  HistoryFile file(folder, history, {}, restart);
  for (std::int64_t step = from; step <= to; ++step)
    file.add(ball_at(step), kinetic(static_cast<double>(step)));
}

/// What opening for a restart at step 100 says of a file with this text; empty if it takes it.
std::string refusal(const TemporaryFolder& folder, const std::string& text) {
  folder.write("table.csv", text);
  try {
    const HistoryFile file(folder.path(), energies_every(1), {}, 100);
  } catch (const InputError& error) {
    return error.what();
  }
  return {};
}

TEST(History, ColumnsAreThoseOfTheHistory) {
  const TemporaryFolder folder;
  const model::History all{
      .file = "all.csv", .energies = true, .unbalanced = true, .walls = true, .balls = {1}};
  const std::vector<std::string> walls{"wall 1 (plane)", "the \"left\", at x = 0"};
  test::SceneBuilder builder;
  builder.ball({0, 0, 5}).ball({1.5, 2, 3}).ball({-5, 0, 5});
  builder.scene().bodies.velocity = {Vec3::Zero(), {0.1, -2, 1e-300}, Vec3::Zero()};
  {
    HistoryFile file(folder.path() / "results", all, walls);
    file.add(
        test::state_of(builder, 0, 0.1),
        {.energies = {1, 2, -3.5}, .unbalanced = {0.25, 1.0 / 3}, .wall_forces = {{1, 2, 3}, {4, 5, 6}}});
  }
  EXPECT_EQ(text_of_file(folder.path() / "results" / "all.csv"),
            "step,time [s],kinetic [J],elastic [J],gravitational [J],unbalanced mean,unbalanced max,"
            "wall 1 (plane) force x [N],wall 1 (plane) force y [N],wall 1 (plane) force z [N],"
            "\"the \"\"left\"\", at x = 0 force x [N]\",\"the \"\"left\"\", at x = 0 force y [N]\","
            "\"the \"\"left\"\", at x = 0 force z [N]\","
            "ball 1 x [m],ball 1 y [m],ball 1 z [m],ball 1 vx [m/s],ball 1 vy [m/s],ball 1 vz [m/s],"
            "ball 1 wx [rad/s],ball 1 wy [rad/s],ball 1 wz [rad/s]\n"
            "0,0.10000000000000001,1,2,-3.5,0.25,0.33333333333333331,1,2,3,4,5,6,"
            "1.5,2,3,0.10000000000000001,-2,1e-300,0,0,0\n");
}

TEST(History, BallsAreFoundWhereverTheyAreStored) {
  const TemporaryFolder folder;
  std::mt19937_64 random(7);
  test::SceneBuilder builder = test::moving_cluster(random, true);
  assembly::State state = test::state_of(builder, 0, 0);
  HistoryFile file(folder.path(), {.file = "balls.csv", .balls = {3, 8}}, {});
  const std::vector<std::int32_t> turned{9, 8, 7, 6, 5, 4, 3, 2, 1, 0};
  for (; state.step < 3; ++state.step) {
    file.add(state, {});
    state.model.bodies = model::reordered(state.model.bodies, turned);
  }
  std::istringstream lines(text_of_file(folder.path() / "balls.csv"));
  std::string text;
  std::getline(lines, text);
  const model::Bodies& given = builder.scene().bodies;
  for (int step = 0; step < 3; ++step) {
    std::getline(lines, text, ',');
    EXPECT_EQ(text, std::to_string(step));
    std::getline(lines, text, ',');
    for (const std::size_t ball : {3, 8})
      for (const auto* column : {&given.position, &given.velocity, &given.spin})
        for (int k = 0; k < 3; ++k) {
          std::getline(lines, text, ball == 8 && column == &given.spin && k == 2 ? '\n' : ',');
          EXPECT_EQ(std::strtod(text.c_str(), nullptr), (*column)[ball][k]);  // to the last bit
        }
  }
}

TEST(History, LinesAreThereAtOnceAndOnlyWhereTheyAreDue) {
  const TemporaryFolder folder;
  HistoryFile file(folder.path(), energies_every(10), {});
  EXPECT_TRUE(file.due(0) && file.due(20));
  EXPECT_FALSE(file.due(5));
  for (const std::int64_t step : {0, 5, 10, 10, 20}) file.add(ball_at(step), kinetic(1));
  file.sync();
  const std::string header = "step,time [s],kinetic [J],elastic [J],gravitational [J]\n";
  EXPECT_EQ(text_of_file(folder.path() / "table.csv"), header + "0,0,1,0,0\n10,5,1,0,0\n20,10,1,0,0\n");
}

TEST(History, ContinuesWithoutGapsOrRepeats) {
  const TemporaryFolder whole;
  run(whole.path(), energies_every(3), 0, 30);
  const std::string expected = text_of_file(whole.path() / "table.csv");
  for (const std::int64_t restart : {0, 1, 9, 10, 11, 12, 29, 30}) {
    const TemporaryFolder folder;
    const auto file = folder.path() / "table.csv";
    run(folder.path(), energies_every(3), 0, 30);
    // Killed in the middle of a line, if ever the system wrote half of one.
    std::ofstream(file, std::ios::app) << "33,16.";
    // With and without the step of the checkpoint itself.
    run(folder.path(), energies_every(3), restart + restart % 2, 30, restart);
    EXPECT_EQ(text_of_file(file), expected) << restart;
  }
}

TEST(History, WithoutContinuationAFileBeginsAnew) {
  const TemporaryFolder folder;
  run(folder.path(), energies_every(1), 0, 5);
  run(folder.path(), energies_every(1), 0, 1);
  EXPECT_THAT(text_of_file(folder.path() / "table.csv"), testing::EndsWith("[J]\n0,0,0,0,0\n1,0.5,1,0,0\n"));
  // Nor is there anything to continue where the table is new in the scene.
  const TemporaryFolder empty;
  run(empty.path(), energies_every(1), 7, 7, 6);
  EXPECT_THAT(text_of_file(empty.path() / "table.csv"), testing::EndsWith("[J]\n7,3.5,7,0,0\n"));
}

TEST(History, FilesOfOtherTablesAreRefused) {
  const TemporaryFolder folder;
  const std::string place = (folder.path() / "table.csv").string();
  const std::string header = "step,time [s],kinetic [J],elastic [J],gravitational [J]\n";
  EXPECT_EQ(refusal(folder, header), "");
  EXPECT_EQ(refusal(folder, header + "0,0,1,2,3\n"), "");
  EXPECT_EQ(
      refusal(folder, "step,time [s],unbalanced mean,unbalanced max\n0,0,1,1\n"),
      place +
          ":1: the columns are \"step,time [s],unbalanced mean,unbalanced max\", and this run would write "
          "\"step,time [s],kinetic [J],elastic [J],gravitational [J]\"; move the file away, or give the "
          "table another name under histories");
  EXPECT_THAT(refusal(folder, ""), HasSubstr(place + ":1: the columns are \"\""));
  EXPECT_EQ(
      refusal(folder, header + "0,0,1,2,3\n5,0,1,2\n"),
      place +
          ":3: \"5,0,1,2\" is no line of this table: a step above that of the line before and 4 values are "
          "wanted; restore the file, or move it away to begin a new table");
  EXPECT_THAT(refusal(folder, header + "0,0,1,2,3\n0,0,1,2,3\n"), HasSubstr(place + ":3: "));
  EXPECT_THAT(refusal(folder, header + "x,0,1,2,3\n"), HasSubstr(place + ":2: "));
  EXPECT_THAT(refusal(folder, header + "\n0,0,1,2,3\n"), HasSubstr(place + ":2: "));
}

TEST(History, WhereNothingCanBeWritten) {
  const TemporaryFolder folder;
  folder.write("file", "");
  EXPECT_THROW(HistoryFile(folder.path() / "file", energies_every(1), {}), InputError);
  std::filesystem::create_directory(folder.path() / "table.csv");
  EXPECT_THROW(HistoryFile(folder.path(), energies_every(1), {}), InputError);
}

TEST(History, ABallThatIsNotThere) {
  const TemporaryFolder folder;
  HistoryFile file(folder.path(), {.file = "balls.csv", .balls = {1}}, {});
  EXPECT_THROW(file.add(ball_at(0), {}), InputError);
}

}  // namespace
}  // namespace eigengrain::io
