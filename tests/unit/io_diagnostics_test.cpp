#include "io/diagnostics.hpp"
#include "unit/io_support.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace eigengrain::io {
namespace {

using testing::ElementsAre;

TEST(Diagnostics, ListsFilesAsTheyAppearAndLinesInOrder) {
  Diagnostics diagnostics;
  EXPECT_NO_THROW(diagnostics.throw_if_any());
  diagnostics.add({"b", 7}, "late");
  diagnostics.add({"a", 1}, "other file");
  diagnostics.add({"b", 3}, "early");
  EXPECT_THAT(texts_of(diagnostics.mistakes()), ElementsAre("b:3: early", "b:7: late", "a:1: other file"));
  EXPECT_THROW(diagnostics.throw_if_any(), InputError);
}

TEST(Diagnostics, CountsWhatRepeatsTooOften) {
  Diagnostics diagnostics;
  for (int line = 1; line <= 10000; ++line) diagnostics.add({"big", line}, "not a number", "number");
  diagnostics.add({"big", 20000}, "another kind", "radius");
  diagnostics.add({"other", 5}, "not a number", "number");
  const std::vector<std::string> all = texts_of(diagnostics.mistakes());
  ASSERT_EQ(all.size(), 23U);
  EXPECT_EQ(all[19], "big:20: not a number");
  EXPECT_EQ(all[20], "big: and 9,980 more like it");
  EXPECT_EQ(all[21], "big:20000: another kind");
  EXPECT_EQ(all[22], "other:5: not a number");
  EXPECT_EQ(diagnostics.count(), 10002);
}

}  // namespace
}  // namespace eigengrain::io
