#include "eigengrain/io/diagnostics.hpp"
#include "eigengrain/io/suggest.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>
#include <vector>

namespace eigengrain::io {
namespace {

using testing::ElementsAre;

TEST(SpellingDistance, CountsEdits) {
  EXPECT_EQ(spelling_distance("", ""), 0);
  EXPECT_EQ(spelling_distance("", "abc"), 6);
  EXPECT_EQ(spelling_distance("friction", "friction"), 0);
  EXPECT_EQ(spelling_distance("fricton", "friction"), 2);
  EXPECT_EQ(spelling_distance("firction", "friction"), 2);  // a swap is one edit
  EXPECT_EQ(spelling_distance("Friction", "friction"), 1);
  EXPECT_EQ(spelling_distance("kitten", "sitting"), 6);
}

TEST(DidYouMean, NamesOnlyWhatIsNear) {
  const std::vector<std::string> keys{"kn", "ks", "friction", "tension"};
  EXPECT_EQ(did_you_mean("fricton", keys), "; did you mean \"friction\"?");
  EXPECT_EQ(did_you_mean("KN", keys), "; did you mean \"kn\"?");
  EXPECT_EQ(did_you_mean("colour", keys), "");
  EXPECT_EQ(did_you_mean("x", keys), "");
  EXPECT_EQ(did_you_mean("", keys), "");
  EXPECT_EQ(did_you_mean("kn", {}), "");
  EXPECT_EQ(did_you_mean(std::string(100000, 'k'), keys), "");
}

std::vector<std::string> texts(const Diagnostics& diagnostics) {
  std::vector<std::string> result;
  for (const Mistake& mistake : diagnostics.mistakes()) result.push_back(mistake.text());
  return result;
}

TEST(Diagnostics, ListsFilesAsTheyAppearAndLinesInOrder) {
  Diagnostics diagnostics;
  EXPECT_NO_THROW(diagnostics.throw_if_any());
  diagnostics.add({"b", 7}, "late");
  diagnostics.add({"a", 1}, "other file");
  diagnostics.add({"b", 3}, "early");
  EXPECT_THAT(texts(diagnostics), ElementsAre("b:3: early", "b:7: late", "a:1: other file"));
  EXPECT_THROW(diagnostics.throw_if_any(), InputError);
}

TEST(Diagnostics, CountsWhatRepeatsTooOften) {
  Diagnostics diagnostics;
  for (int line = 1; line <= 10000; ++line) diagnostics.add({"big", line}, "not a number", "number");
  diagnostics.add({"big", 20000}, "another kind", "radius");
  diagnostics.add({"other", 5}, "not a number", "number");
  const std::vector<std::string> all = texts(diagnostics);
  ASSERT_EQ(all.size(), 23U);
  EXPECT_EQ(all[19], "big:20: not a number");
  EXPECT_EQ(all[20], "big: and 9,980 more like it");
  EXPECT_EQ(all[21], "big:20000: another kind");
  EXPECT_EQ(all[22], "other:5: not a number");
  EXPECT_EQ(diagnostics.count(), 10002);
}

}  // namespace
}  // namespace eigengrain::io
