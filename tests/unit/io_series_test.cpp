#include "eigengrain/io/series.hpp"

#include "support/states.hpp"
#include "unit/io_support.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <sstream>

namespace eigengrain::io {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

std::string text_of_file(const std::filesystem::path& file) {
  std::ifstream input(file, std::ios::binary);
  std::ostringstream text;
  text << input.rdbuf();
  return text.str();
}

assembly::State pair_at(std::int64_t step) {
  return test::state_of(test::SceneBuilder().ball({0, 0, 0}).ball({1.9, 0, 0}), step,
                        0.1 * static_cast<double>(step));
}

/// What continue_from says of a list of frames; empty if it takes it.
std::string refusal(const TemporaryFolder& folder, const std::string& list, std::int64_t step = 1000) {
  folder.write("run.pvd", list);
  try {
    Series(folder.path(), "run").continue_from(step);
  } catch (const InputError& error) {
    return error.what();
  }
  return {};
}

TEST(Series, WritesNothingBeforeTheFirstFrame) {
  const TemporaryFolder folder;
  Series series(folder.path(), "run");
  series.continue_from(5);
  EXPECT_TRUE(std::filesystem::is_empty(folder.path()));
}

TEST(Series, ListNamesEachFrameOnce) {
  const TemporaryFolder folder;
  Series series(folder.path() / "new", "run");
  for (const std::int64_t step : {0, 5, 5, 10}) series.add(pair_at(step));
  EXPECT_THAT(series.steps(), ElementsAre(0, 5, 10));
  EXPECT_EQ(text_of_file(folder.path() / "new" / "run.pvd"),
            R"(<?xml version="1.0"?>
<VTKFile type="Collection" version="1.0" byte_order="LittleEndian">
<Collection>
<DataSet timestep="0" part="0" file="run_series/run_0000000000.vtu"/>
<DataSet timestep="0.5" part="0" file="run_series/run_0000000005.vtu"/>
<DataSet timestep="1" part="0" file="run_series/run_0000000010.vtu"/>
</Collection>
</VTKFile>
)");
  std::vector<std::string> names;
  for (const auto& entry : std::filesystem::directory_iterator(folder.path() / "new" / "run_series"))
    names.push_back(entry.path().filename());
  std::sort(names.begin(), names.end());
  EXPECT_THAT(names, ElementsAre("run_0000000000.vtu", "run_0000000005.vtu", "run_0000000010.vtu"));
}

TEST(Series, ContinuesWithoutGapsOrRepeats) {
  const TemporaryFolder folder;
  {
    Series first(folder.path(), "run");
    for (const std::int64_t step : {0, 5, 10, 15, 20}) first.add(pair_at(step));
  }
  const std::string frame_ten = text_of_file(Series(folder.path(), "run").frame_file(10));
  Series second(folder.path(), "run");
  second.continue_from(12);
  EXPECT_THAT(second.steps(), ElementsAre(0, 5, 10));
  EXPECT_THAT(text_of_file(second.list_file()), testing::Not(HasSubstr("0000000015")));
  second.add(pair_at(15));
  EXPECT_THAT(second.steps(), ElementsAre(0, 5, 10, 15));

  Series third(folder.path(), "run");
  third.continue_from(10);
  assembly::State other = pair_at(10);
  other.model.bodies.radius[0] = 7;
  third.add(other);  // the frame of the step itself stays as it was
  EXPECT_THAT(third.steps(), ElementsAre(0, 5, 10));
  EXPECT_EQ(text_of_file(third.frame_file(10)), frame_ten);
  third.add(pair_at(15));
  EXPECT_THAT(third.steps(), ElementsAre(0, 5, 10, 15));
}

TEST(Series, WithoutContinuationAFirstFrameBeginsAnew) {
  const TemporaryFolder folder;
  Series first(folder.path(), "run");
  first.add(pair_at(3));
  Series second(folder.path(), "run");
  second.add(pair_at(0));
  EXPECT_THAT(text_of_file(second.list_file()), testing::Not(HasSubstr("0000000003")));
}

TEST(Series, NamesThatXmlWouldMisread) {
  const TemporaryFolder folder;
  const std::string stem = "a&b <\"c\">";
  Series(folder.path(), stem).add(pair_at(0));
  Series again(folder.path(), stem);
  again.continue_from(0);
  EXPECT_THAT(again.steps(), ElementsAre(0));
  EXPECT_THAT(text_of_file(again.list_file()), HasSubstr("file=\"a&amp;b &lt;&quot;c&quot;>_series/a&amp;b"));
}

TEST(Series, AListThatIsDamagedOrForeignIsRefused) {
  const TemporaryFolder folder;
  Series series(folder.path(), "run");
  for (const std::int64_t step : {0, 5}) series.add(pair_at(step));
  const std::string list = text_of_file(series.list_file());
  ASSERT_EQ(refusal(folder, list), "");
  const std::string place = (folder.path() / "run.pvd").string();
  const auto changed = [&](const std::string& from, const std::string& to) {
    std::string text = list;
    return text.replace(text.find(from), from.size(), to);
  };
  // Wherever it is cut off, even behind a whole frame.
  for (std::size_t size = 0; size < list.size(); ++size)
    EXPECT_THAT(refusal(folder, list.substr(0, size)), HasSubstr("to begin a new series")) << size;
  EXPECT_EQ(
      refusal(folder, "<html>\n"),
      place +
          ":1: begins with \"<html>\", so this is not the list of frames of an earlier run; move it and "
          "run_series away to begin a new series, or restore it");
  EXPECT_THAT(refusal(folder, changed("run_series/run_0000000005", "run_series/other_0000000005")),
              HasSubstr(place + ":5: \"<DataSet timestep=\"0.5\" part=\"0\" "
                                "file=\"run_series/other_0000000005.vtu\"/>\" is no frame of \"run\""));
  EXPECT_THAT(refusal(folder, changed("timestep=\"0.5\"", "timestep=\"0.50\"")), HasSubstr(":5: "));
  EXPECT_THAT(refusal(folder, changed("timestep=\"0.5\"", "timestep=\"\"")), HasSubstr(":5: "));
  EXPECT_THAT(refusal(folder, changed("run_0000000005", "run_0000000000")),
              HasSubstr(":5: step 0 stands behind step 0"));
  EXPECT_THAT(refusal(folder, list + "\n"), HasSubstr("to begin a new series"));
  EXPECT_THAT(refusal(folder, changed("0000000005", "99999999999999999999999")), HasSubstr(":5: "));
  EXPECT_THAT(refusal(folder, changed("0000000005", "0000000006")),
              HasSubstr("names the frame of step 6, and there is no \""));
  // A frame that is dropped anyway may be gone.
  EXPECT_EQ(refusal(folder, changed("0000000005", "0000000006"), 5), "");
}

TEST(Series, WhereNothingCanBeWritten) {
  const TemporaryFolder folder;
  folder.write("file", "");
  Series series(folder.path() / "file", "run");
  try {
    series.add(pair_at(0));
    FAIL();
  } catch (const InputError& error) {
    EXPECT_THAT(error.what(), HasSubstr("cannot be written ("));
  }
  // What stood there stays where a frame cannot take its place.
  Series blocked(folder.path(), "run");
  std::filesystem::create_directories(blocked.frame_file(0));
  EXPECT_THROW(blocked.add(pair_at(0)), InputError);
  EXPECT_THAT(blocked.steps(), IsEmpty());
  EXPECT_FALSE(std::filesystem::exists(blocked.list_file()));
  EXPECT_FALSE(std::filesystem::exists(blocked.frame_file(0).string() + ".part"));
}

TEST(Series, OnlyTheArraysThatTheStateHas) {
  const TemporaryFolder folder;
  std::mt19937_64 random(1);
  Series series(folder.path(), "run");
  series.add(test::state_of(test::moving_cluster(random, false), 0, 0));
  series.add(test::state_of(test::moving_cluster(random, true), 1, 0));
  EXPECT_THAT(text_of_file(series.frame_file(0)), testing::Not(HasSubstr("Name=\"spin\"")));
  EXPECT_THAT(text_of_file(series.frame_file(1)), HasSubstr("Name=\"spin\" NumberOfComponents=\"3\""));
}

}  // namespace
}  // namespace eigengrain::io
